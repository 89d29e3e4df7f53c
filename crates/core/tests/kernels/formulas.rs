//! Laws of optics, media and fields.

use super::draw::*;
use dashu_ratio::RBig;
use glam::Vec3;
use luc_core::kernels;
use luc_core::scene::{Field, Node};
use proptest::prelude::*;

fn node() -> impl Strategy<Value = Node> + Clone {
    let at = vector(-3, 3);
    let half = [range(0.1, 1.0), range(0.1, 1.0), range(0.1, 1.0)].prop_map(Vec3::from_array);
    (0..7_u32, at, half, direction()).prop_map(|(kind, at, half, normal)| match kind {
        0 => Node::sphere(at.into(), half.x),
        1 => Node::cuboid(at.into(), half.into(), 0.05),
        2 => Node::capsule(at.into(), half.y, half.x),
        3 => Node::cylinder(at.into(), half.y, half.x),
        4 => Node::torus(at.into(), half.y, half.x * 0.5),
        5 => Node::plane(at.into(), normal.into()),
        _ => Node::cross(half.x, 0.05),
    })
}

proptest! {
    #![proptest_config(config(20_000))]

    #[test]
    fn roots_are_real_exactly_where_they_are_and_within_an_ulp(
        a in signed(-20, 20),
        b in signed(-20, 20),
        c in prop_oneof![signed(-20, 20).prop_map(Some), Just(None)],
    ) {
        // None: as near to a double root as f32 comes.
        let c = c.unwrap_or(if a == 0.0 { 0.0 } else { b * (b / (4.0 * a)) });
        if !c.is_finite() {
            return Ok(());
        }
        let [x, y, z] = [a, b, c].map(exact);
        let square = &y * &y - RBig::from(4) * &x * &z;
        let Some(roots) = kernels::quadratic(a, b, c) else {
            prop_assert!(square < RBig::ZERO || (a == 0.0 && b == 0.0), "lost: {a:?} {b:?} {c:?}");
            return Ok(());
        };
        prop_assert!(square >= RBig::ZERO, "invented: {a:?} {b:?} {c:?}");
        prop_assert!(roots[0] <= roots[1]);
        let value = |t: f32| {
            let t = exact(t);
            (&x * &t + &y) * &t + &z
        };
        for t in roots.into_iter().filter(|t| t.is_finite()) {
            // The sign changes within an ulp, unless the two roots lie closer than that.
            let (below, above) = (value(t.next_down()), value(t.next_up()));
            let close = (roots[1] - roots[0]).abs() <= 2.0 * (t.next_up() - t.next_down());
            let changes = (below < RBig::ZERO) != (above < RBig::ZERO) || below == RBig::ZERO || above == RBig::ZERO;
            prop_assert!(changes || close, "{t:?} of {roots:?}: {a:?} {b:?} {c:?}");
        }
    }

    #[test]
    fn reflection_is_total_exactly_where_the_sine_says(
        cos in share(),
        n_i in range(1.0, 3.0),
        n_t in range(1.0, 3.0),
        // At the critical angle to the bit, or a few bits off.
        steps in prop_oneof![Just(None), (-4..5_i32).prop_map(Some)],
    ) {
        let critical = (1.0 - n_t / n_i * (n_t / n_i)).max(0.0).sqrt();
        let cos = steps.map_or(cos, |steps| f32::from_bits(critical.to_bits().saturating_add_signed(steps)).min(1.0));
        let [c, i, t] = [cos, n_i, n_t].map(exact);
        let beyond = &t * &t - &i * &i * (RBig::ONE - &c * &c);
        let total = beyond < RBig::ZERO;
        prop_assert_eq!(kernels::is_total(cos, n_i, n_t), total, "{:?} {:?} {:?}", cos, n_i, n_t);
        let share = kernels::fresnel(cos, n_i, n_t);
        prop_assert!((0.0..=1.0).contains(&share) && (!total || share == 1.0));
        let behind = kernels::cos_refracted(cos, n_i, n_t);
        if total {
            prop_assert_eq!(behind, 0.0);
        } else {
            let want = near(&beyond).sqrt() / f64::from(n_t);
            prop_assert!((f64::from(behind) - want).abs() <= 2.0 * U * want, "{behind} {want}");
        }
    }

    /// A refracted ray, turned round, comes back the way it came.
    #[test]
    fn refraction_is_reversible(n in direction(), way in direction(), eta in range(0.4, 2.5)) {
        let d = if way.dot(n) > 0.0 { -way } else { way };
        if let (true, Some(on)) = (d.dot(n) < -1e-3, kernels::refract(d, n, eta)) {
            let (cos, cos_out) = (-d.dot(n), -on.dot(n));
            prop_assert!((on.length() - 1.0).abs() <= 4e-7);
            if cos_out <= 1e-3 {
                return Ok(());
            }
            let back = kernels::refract(-on, -n, 1.0 / eta);
            let off = back.map_or(0.0, |back| (back + d).length());
            let room = 32.0 * U as f32 * (1.0 + 1.0 / (eta * eta)) * (1.0 + eta * eta) * (1.0 + 1.0 / cos + 1.0 / cos_out);
            prop_assert!(off <= room, "{off} over {room}: {d:?} {n:?} {eta:?}");
        }
    }

    #[test]
    fn facets_are_seen_the_same_both_ways_and_never_more_than_all(l in share(), v in share(), alpha in size(-13, 0)) {
        let (there, back) = (kernels::smith_g2(l, v, alpha), kernels::smith_g2(v, l, alpha));
        prop_assert_eq!(there.to_bits(), back.to_bits());
        let (one, other) = (kernels::smith_g1(l, alpha), kernels::smith_g1(v, alpha));
        prop_assert!((0.0..=1.000_001).contains(&there) && (0.0..=1.0).contains(&one));
        // Correlated heights show more than the product, and no more than either alone.
        prop_assert!(there <= one.min(other) * 1.000_001 && there >= one * other * 0.999_999, "{there} {one} {other}");
    }

    #[test]
    fn distributions_are_finite_and_from_vectors_as_from_the_cosine(cos in share(), alpha in size(-13, 0)) {
        let sine = ((1.0 - f64::from(cos)) * (1.0 + f64::from(cos))).sqrt() as f32;
        let (of_cosine, of_vectors) =
            (kernels::ggx_of_cosine(cos, alpha), kernels::ggx(Vec3::Z, Vec3::new(sine, 0.0, cos), alpha));
        prop_assert!(of_cosine.is_finite() && of_cosine > 0.0);
        // The sine is rounded, which counts twice, and squared again.
        prop_assert!((of_cosine - of_vectors).abs() <= 24.0 * U as f32 * of_cosine, "{of_cosine} {of_vectors}");
        let beckmann = kernels::beckmann_of_cosine(cos, alpha);
        prop_assert!(beckmann.is_finite() && beckmann >= 0.0);
    }

    #[test]
    fn schlick_lies_between_f0_and_all(f0 in range(0.0, 1.0), cos in share()) {
        let share = kernels::schlick(f0, cos);
        prop_assert!((f0..=1.0).contains(&share), "{share}");
        let m = 1.0 - f64::from(cos);
        let want = f64::from(f0) + (1.0 - f64::from(f0)) * m * m * m * m * m;
        prop_assert!((f64::from(share) - want).abs() <= 6.5 * U * want + 1e-45, "{share} {want}");
    }

    #[test]
    fn a_medium_takes_the_same_however_its_way_is_cut(parts in prop::collection::vec(size(-30, 0), 1..40)) {
        let mut sum = kernels::Extinction::default();
        let mut whole = RBig::ZERO;
        for &part in &parts {
            sum.add(part);
            whole += exact(part);
        }
        let want = near(&whole);
        prop_assert!((f64::from(sum.depth()) - want).abs() <= 1.01 * U * want);
        let (through, lost) = (f64::from(sum.through()), f64::from(sum.lost()));
        prop_assert!((through + lost - 1.0).abs() <= 4.0 * U, "{through} {lost}");
        prop_assert!(lost > 0.0 && lost <= want * (1.0 + 4.0 * U));
    }

    #[test]
    fn draws_are_unit_and_the_phase_positive(u in share(), g in range(-0.9999, 0.9999)) {
        let [cos, rest, sin] = kernels::sample_henyey_greenstein(u, g).map(f64::from);
        prop_assert!((cos + rest - 1.0).abs() <= 2.0 * U && (cos * cos + sin * sin - 1.0).abs() <= 4.0 * U);
        prop_assert!(kernels::henyey_greenstein(cos as f32, g) > 0.0);
    }

    /// No form's distance changes faster than space: |f(p) - f(q)| <= |p - q|.
    #[test]
    fn distances_change_no_faster_than_space(node in node(), p in vector(-6, 6), step in vector(-20, 2)) {
        let q = p + step;
        let (a, b) = (kernels::sdf(&node, p), kernels::sdf(&node, q));
        let apart = (p.as_dvec3() - q.as_dvec3()).length();
        let room = 6.0 * U * f64::from(4.0 + 2.0 * p.length() + q.length() + 2.0 * node.centre.length());
        prop_assert!((f64::from(a) - f64::from(b)).abs() <= apart + room, "{a} {b} {apart}: {node:?} {p:?} {q:?}");
        prop_assert_eq!(a, kernels::field_distance(&Field::new(vec![node]), p), "a field of one");
    }

    #[test]
    fn a_smooth_minimum_is_exact_outside_its_blend(a in signed(-10, 10), b in signed(-10, 10), k in prop_oneof![Just(0.0_f32), size(-20, 6)]) {
        let least = kernels::smooth_union(a, b, k);
        prop_assert_eq!(least, kernels::smooth_union(b, a, k), "symmetric");
        let [x, y, z] = [a, b, k].map(exact);
        let gap = if x > y { &x - &y } else { &y - &x };
        if gap >= z {
            prop_assert_eq!(least, a.min(b), "outside");
        } else {
            let h = &z - &gap;
            let want = near(&(x.min(y) - &h * &h / (RBig::from(4) * &z)));
            let room = 2.0 * U * f64::from(a.abs() + b.abs() + k);
            prop_assert!((f64::from(least) - want).abs() <= room, "{least} {want}: {a:?} {b:?} {k:?}");
        }
        // The other two are its mirrors.
        prop_assert_eq!(kernels::smooth_intersection(a, b, k), -kernels::smooth_union(-a, -b, k));
        prop_assert_eq!(kernels::smooth_subtraction(a, b, k), -kernels::smooth_union(-a, b, k));
    }

    /// Folding moves no two points apart, and what it gives lies in the cell, but for rounding.
    #[test]
    fn a_fold_moves_nothing_apart(x in signed(-4, 16), step in signed(-12, 4), side in size(-4, 4)) {
        let y = x + step;
        let (a, b) = (kernels::fold(x, side, f32::INFINITY), kernels::fold(y, side, f32::INFINITY));
        let room = 4.0 * U * f64::from(x.abs() + y.abs() + side);
        prop_assert!(f64::from(a - b).abs() <= f64::from((x - y).abs()) + room, "{a} {b}: {x:?} {y:?} {side:?}");
        prop_assert!(f64::from(a.abs()) <= 0.5 * f64::from(side) + room);
        let plain = kernels::repeat(x, side, f32::INFINITY);
        prop_assert_eq!(plain.abs(), a.abs());
        // A whole number of cells apart, exactly.
        let cells = (exact(x) - exact(plain)) / exact(side);
        let off = near(&cells) - near(&cells).round();
        prop_assert!(off.abs() * f64::from(side) <= room, "{off}: {x:?} {side:?}");
    }

    #[test]
    fn directions_are_drawn_about_the_normal(n in direction(), u in range(0.0, 1.0), v in range(0.0, 1.0)) {
        let (x, y) = kernels::basis(n);
        let faults = [x.dot(y), x.dot(n), y.dot(n), x.length() - 1.0, y.length() - 1.0];
        prop_assert!(faults.iter().all(|f| f.abs() <= 4e-7), "{faults:?} at {n:?}");
        let d = kernels::cosine_weighted(n, u, v);
        prop_assert!((d.length() - 1.0).abs() <= 1e-6);
        prop_assert!((d.dot(n) - (1.0 - u).sqrt()).abs() <= 1e-6 && d.dot(n) > 0.0);
    }
}
