//! Shapes by exact arithmetic: no hit lost or invented beyond four skins u (|o - c| + r + |t d|), and each crossing
//! within four of the surface.

use super::draw::*;
use dashu_ratio::RBig;
use glam::Vec3;
use luc_core::kernels::{self, Ray};
use proptest::prelude::*;

/// A ray at a target: from some distance, or from the target itself; direction of any length.
fn ray(target: Vec3, direction: Vec3, back: f32, length: f32) -> Ray {
    Ray { origin: target - direction * back, direction: direction * length }
}

fn lengths() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![3 => Just(1.0_f32), 1 => size(-8, 8)]
}

/// (d·d) r² - |d × f|², of one sign with the discriminant.
fn discriminant(ray: &Ray, centre: Vec3, r: &RBig) -> RBig {
    let (f, d) = (minus(&exact3(ray.origin), &exact3(centre)), exact3(ray.direction));
    let (fd, dd) = (dot(&f, &d), dot(&d, &d));
    &dd * r * r - (&dd * dot(&f, &f) - &fd * &fd)
}

proptest! {
    #![proptest_config(config(20_000))]

    #[test]
    fn a_sphere_is_hit_where_it_is(
        centre in vector(-6, 20),
        radius in size(-13, 12),
        normal in direction(),
        way in direction(),
        // Grazing, to any degree, or not.
        graze in prop_oneof![Just(1.0_f32), signed(-26, -1)],
        back in signed(-8, 14),
        length in lengths(),
    ) {
        let across = (way - normal * way.dot(normal)).normalize_or(normal.any_orthonormal_vector());
        let way = (across + normal * graze).normalize();
        let ray = ray(centre + normal * radius, way, radius * back, length);
        let reach = f64::from((ray.origin - centre).length()) + f64::from(radius);
        let skin = 4.0 * U * reach;
        let grown = |by: f64| (wide(f64::from(radius) + by)).max(RBig::ZERO);
        match kernels::sphere(&ray, centre, radius) {
            None => {
                // Missed, or all of it lies behind: then so does the ball smaller by a skin.
                let (f, d) = (minus(&exact3(ray.origin), &exact3(centre)), exact3(ray.direction));
                let small = grown(-2.0 * skin);
                let inside = dot(&f, &f) < &small * &small;
                let ahead = inside || dot(&f, &d) < RBig::ZERO;
                let hit = small > RBig::ZERO && discriminant(&ray, centre, &small) > RBig::ZERO;
                prop_assert!(!(hit && ahead), "lost: {ray:?} {centre:?} {radius:?}");
            }
            Some(found) => {
                prop_assert!(found.enter <= found.exit);
                prop_assert!(
                    discriminant(&ray, centre, &grown(2.0 * skin)) >= RBig::ZERO,
                    "invented: {ray:?} {centre:?} {radius:?}"
                );
                for t in [found.enter, found.exit] {
                    let far = f64::from(t.abs()) * f64::from(ray.direction.length());
                    let skin = 4.0 * U * (reach + far);
                    let (o, d, t) = (exact3(ray.origin), exact3(ray.direction), exact(t));
                    let p: [RBig; 3] = std::array::from_fn(|i| &o[i] + &d[i] * &t);
                    let off = minus(&p, &exact3(centre));
                    let (least, most) = (grown(-skin), grown(skin));
                    let square = dot(&off, &off);
                    // A tangent's two roots lie within the chord that a skin makes.
                    let chord = discriminant(&ray, centre, &grown(-skin)) < RBig::ZERO;
                    prop_assert!(square <= &most * &most, "off the surface: {ray:?} {centre:?} {radius:?} {t}");
                    prop_assert!(chord || square >= &least * &least, "inside: {ray:?} {centre:?} {radius:?} {t}");
                }
            }
        }
    }

    #[test]
    fn a_plane_is_hit_where_it_is(
        point in vector(-6, 20),
        normal in direction(),
        origin in vector(-6, 20),
        way in direction(),
        length in lengths(),
    ) {
        let ray = Ray { origin, direction: way * length };
        let (n, d) = (exact3(normal), exact3(ray.direction));
        let (along, height) = (dot(&n, &d), dot(&n, &minus(&exact3(point), &exact3(origin))));
        let speed = f64::from(ray.direction.length());
        // n·d and n·(p - o) are each rounded in their three terms.
        let room = 8.0 * U * f64::from((point - origin).length());
        let parallel = near(&along).abs() <= 8.0 * U * speed;
        match kernels::plane(&ray, point, normal) {
            None => prop_assert!(
                parallel || near(&height).abs() <= room || (along > RBig::ZERO) != (height > RBig::ZERO),
                "lost: {ray:?} {point:?} {normal:?}"
            ),
            Some(t) => {
                prop_assert!(t > 0.0 && t.is_finite());
                let miss = near(&(exact(t) * &along - &height)).abs();
                let bound = 2.0 * room + 8.0 * U * f64::from(t) * speed;
                prop_assert!(miss <= bound, "{miss} off: {ray:?} {point:?} {normal:?} {t}");
            }
        }
    }

    /// Closed: rays in faces, along edges and into corners hit; flat boxes are hit, empty ones never.
    #[test]
    fn no_ray_that_meets_a_box_is_lost(
        corner in vector(-6, 12),
        sides in [prop_oneof![1 => Just(0.0_f32), 5 => size(-10, 10)], prop_oneof![1 => Just(0.0_f32), 5 => size(-10, 10)], prop_oneof![1 => Just(0.0_f32), 5 => size(-10, 10)]],
        at in [share(), share(), share()],
        way in direction(),
        back in signed(-8, 14),
        length in lengths(),
    ) {
        let (lo, hi) = (corner, corner + Vec3::from_array(sides));
        let target = (lo + Vec3::from_array(sides) * Vec3::from_array(at)).clamp(lo, hi);
        let ray = ray(target, way, back, length);
        let (o, d) = (exact3(ray.origin), exact3(ray.direction));
        let (l, h) = (exact3(lo), exact3(hi));
        let (mut enter, mut exit, mut outside) = (RBig::ZERO, None::<RBig>, false);
        for i in 0..3 {
            if d[i] == RBig::ZERO {
                outside |= o[i] < l[i] || o[i] > h[i];
                continue;
            }
            let (a, b) = ((&l[i] - &o[i]) / &d[i], (&h[i] - &o[i]) / &d[i]);
            let (first, last) = if a < b { (a, b) } else { (b, a) };
            enter = enter.max(first);
            exit = Some(exit.map_or(last.clone(), |e| e.min(last)));
        }
        let hit = !outside && exit.as_ref().is_none_or(|exit| &enter <= exit);
        let found = kernels::slab(&ray, lo, hi);
        if hit {
            let [t, _] = found.ok_or_else(|| TestCaseError::fail(format!("lost: {ray:?} {lo:?} {hi:?}")))?;
            let off = near(&(exact(t) - &enter)).abs();
            prop_assert!(off <= 4.0 * U * near(&enter) + 1e-40, "{off}: {ray:?} {lo:?} {hi:?} {t}");
        } else if let (Some(_), Some(exit)) = (found, &exit) {
            // Only within the room for rounding.
            let gap = near(&enter) - near(exit);
            prop_assert!(!outside && gap <= 16.0 * U * near(&enter), "invented: {ray:?} {lo:?} {hi:?}");
        }
        prop_assert_eq!(kernels::slab(&ray, hi + Vec3::ONE, lo), None, "an empty box");
    }

    #[test]
    fn a_triangle_is_hit_within_its_corners(
        corners in [vector(-3, 3), vector(-3, 3), vector(-3, 3)],
        weights in [range(0.0, 1.0), range(0.0, 1.0)],
        way in direction(),
        back in size(-6, 10),
        length in lengths(),
    ) {
        let [a, b, c] = corners;
        let [u, v] = if weights[0] + weights[1] < 1.0 { weights } else { weights.map(|w| 1.0 - w) };
        let target = a + (b - a) * u + (c - a) * v;
        let ray = ray(target, way, back, length);
        let [ea, eb, ec] = corners.map(exact3);
        let (e1, e2, d) = (minus(&eb, &ea), minus(&ec, &ea), exact3(ray.direction));
        let cross = |a: &[RBig; 3], b: &[RBig; 3]| -> [RBig; 3] {
            std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                &a[j] * &b[k] - &a[k] * &b[j]
            })
        };
        let p = cross(&d, &e2);
        let det = dot(&e1, &p);
        let Some(found) = kernels::triangle(&ray, corners) else {
            // Only what is hit a thousandth inside, and not nearly edge on, must be.
            let n = (b - a).cross(c - a);
            let steep = n.length() > 1e-3 * (b - a).length() * (c - a).length()
                && n.normalize_or_zero().dot(way).abs() > 0.01;
            let inside = u > 1e-3 && v > 1e-3 && u + v < 0.999;
            prop_assert!(!(steep && inside && back < 64.0), "lost: {ray:?} {corners:?} {det}");
            return Ok(());
        };
        let [x, y, z] = found.weights;
        prop_assert!(found.t > 0.0 && x >= 0.0 && y >= 0.0 && z >= 0.0, "{found:?}: {ray:?} {corners:?}");
        prop_assert!((x + y + z - 1.0).abs() <= 4e-7);
    }
}
