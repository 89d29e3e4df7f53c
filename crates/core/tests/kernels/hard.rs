//! Cases between the ranges of f32: directions of any length, angles of any size, media without end.

use super::draw::*;
use dashu_ratio::RBig;
use glam::Vec3;
use luc_core::kernels::{self, Crossing, Extinction, Ray};
use proptest::prelude::*;
use std::f64::consts::FRAC_1_PI;

/// 2^k.
fn two_to(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// Distances of every shape that the ray meets, at most infinite: of sphere, plane, cylinders, cones, triangle, box.
fn distances(ray: &Ray, at: Vec3, axis: Vec3, size: f32) -> [[Option<f32>; 2]; 8] {
    let far = |c: Option<Crossing>| [c.map(|c| c.enter), c.map(|c| c.exit)];
    let corners = [at, at + Vec3::new(size, 0.0, 0.0), at + axis * size];
    let slab = kernels::slab(ray, at, at + size);
    [
        far(kernels::sphere(ray, at, size)),
        [kernels::plane(ray, at, axis), None],
        far(kernels::cylinder(ray, at, axis, size)),
        far(kernels::capped_cylinder(ray, at, axis, size, 2.0 * size)),
        far(kernels::cone(ray, at, axis, 0.5)),
        far(kernels::capped_cone(ray, at, axis, 0.5, [size, 3.0 * size])),
        [kernels::triangle(ray, corners).map(|h| h.t), None],
        [slab.map(|t| t[0]), slab.map(|t| t[1])],
    ]
}

/// Distance to `x` in ulp of the exact result.
fn ulp(x: f32, exact: f64) -> f64 {
    let near = (exact.abs() as f32).clamp(f32::MIN_POSITIVE, 1e38);
    (f64::from(x) - exact).abs() / f64::from(near.next_up() - near)
}

/// Squared sine and cosine of the angle between two vectors.
fn angle(a: Vec3, b: Vec3) -> [f64; 2] {
    let (a, b) = (exact3(a), exact3(b));
    let (ab, square) = (dot(&a, &b), dot(&a, &a) * dot(&b, &b));
    [near(&((&square - &ab * &ab) / &square)), near(&ab) / near(&square).sqrt()]
}

proptest! {
    #![proptest_config(config(20_000))]

    /// Down to the least subnormal numbers: distances are those along the direction times 2^k, over 2^k.
    #[test]
    fn how_long_a_direction_is_only_changes_the_unit(
        target in vector(-3, 1),
        way in direction(),
        back in size(-4, 8),
        at in vector(-4, 2),
        axis in direction(),
        size in size(-6, 4),
        k in -149..120,
    ) {
        let origin = at + target * size - way * back;
        let stretched = way.to_array().map(|d| (f64::from(d) * two_to(k)) as f32);
        // What subnormal numbers leave of it, at its old length.
        let way = Vec3::from_array(stretched.map(|d| (f64::from(d) * two_to(-k)) as f32));
        let plain = distances(&Ray { origin, direction: way }, at, axis, size);
        let other = distances(&Ray { origin, direction: Vec3::from_array(stretched) }, at, axis, size);
        for (i, (plain, other)) in plain.into_iter().zip(other).enumerate() {
            let want = plain.map(|t| t.map(|t| (f64::from(t) * two_to(-k)) as f32));
            // Where one of the two is beyond the range of f32 the other may be the first or none.
            let held = |plain: f32, t: f32| plain.is_infinite() || (t.abs() > 1e-37 && t.abs() < 1e37);
            let within = (0..2).all(|i| plain[i].zip(want[i]).is_none_or(|(plain, t)| held(plain, t)));
            prop_assert!(!within || other == want, "{i}: {want:?} {other:?}: {origin:?} {way:?} {k} {at:?} {axis:?} {size:?}");
        }
    }

    /// Without a direction a box is met from within only, and none at infinity.
    #[test]
    fn no_box_is_entered_at_infinity(
        origin in vector(-10, 10),
        lo in vector(-10, 10),
        side in [size(-10, 10), size(-10, 10), size(-10, 10)],
        zeros in [any::<bool>(), any::<bool>(), any::<bool>()],
    ) {
        let hi = lo + Vec3::from_array(side);
        let direction = Vec3::from_array(zeros.map(|minus| if minus { -0.0 } else { 0.0 }));
        let within = origin.cmpge(lo).all() && origin.cmple(hi).all();
        let found = kernels::slab(&Ray { origin, direction }, lo, hi);
        prop_assert_eq!(found.is_some(), within, "{:?} {:?} {:?} {:?}", origin, direction, lo, hi);
    }

    #[test]
    fn microfacets_of_two_vectors_are_within_an_ulp(
        n in direction(),
        tilt in direction(),
        lean in size(-20, 1),
        alpha in size(-13, 0),
    ) {
        let h = (n + tilt * (alpha * lean)).normalize();
        let [sine2, cos] = angle(n, h);
        let alpha_wide = f64::from(alpha);
        let q = alpha_wide / (sine2 + (alpha_wide * cos) * (alpha_wide * cos));
        let ggx = kernels::ggx(n, h, alpha);
        prop_assert!(ulp(ggx, q * q * FRAC_1_PI) <= 0.51, "{ggx}: {n:?} {h:?} {alpha:?}");
        if cos > 0.0 {
            #[allow(clippy::disallowed_methods, reason = "the truth")]
            let e = (-sine2 / (cos * cos * alpha_wide * alpha_wide)).exp();
            let want = e * FRAC_1_PI / (alpha_wide * alpha_wide * cos * cos * cos * cos);
            let beckmann = kernels::beckmann(n, h, alpha);
            prop_assert!(ulp(beckmann, want) <= 0.51, "{beckmann} {want}: {n:?} {h:?} {alpha:?}");
        }
    }

    /// Snell's law: sin beyond is eta sin before, in the same plane, and there is nothing beyond 90°.
    #[test]
    fn refraction_is_within_an_ulp_and_total_where_the_sine_says(n in direction(), way in direction(), eta in range(0.4, 2.5)) {
        let d = if way.dot(n) > 0.0 { -way } else { way };
        let (exact_d, exact_n, e) = (exact3(d), exact3(n), exact(eta));
        let (dd, nn, dn) = (dot(&exact_d, &exact_d), dot(&exact_n, &exact_n), dot(&exact_d, &exact_n));
        // Squares of the sines, times |d|² |n|².
        let beyond = &dd * &nn - &e * &e * (&dd * &nn - &dn * &dn);
        let found = kernels::refract(d, n, eta);
        let left = near(&beyond) / near(&(&dd * &nn));
        if left.abs() > 1e-14 {
            prop_assert_eq!(found.is_none(), beyond < RBig::ZERO, "{:?} {:?} {:?}", d, n, eta);
        }
        let Some(on) = found.filter(|_| left > 1e-9) else { return Ok(()) };
        let (long_d, long_n) = (near(&dd).sqrt(), near(&nn).sqrt());
        for axis in 0..3 {
            // η (d - n (n·d) / n²) / |d| - n cos / |n|
            let across = near(&(&e * (&exact_d[axis] - &exact_n[axis] * &dn / &nn))) / long_d;
            let want = across - f64::from(n[axis]) * left.sqrt() / long_n;
            let off = (f64::from(on[axis]) - want).abs();
            prop_assert!(ulp(on[axis], want) <= 0.51 || off <= 1e-15 / left.sqrt(), "{on:?} {want}: {d:?} {n:?} {eta:?}");
        }
    }

    /// Where the turn is upright, 1 - cos and 1 + cos cancel.
    #[test]
    fn drawn_cosines_keep_their_digits_at_right_angles(g in size(-40, -1), minus in any::<bool>(), off in signed(-20, 1)) {
        let g = if minus { -g } else { g };
        // cos = 0 is at u = 1/2 - 3 g / 4, nearly.
        let u = (0.5 - 0.75 * g * (1.0 + off)).clamp(0.0, 1.0);
        let (exact_g, s) = (exact(g), exact(u) * RBig::from(2) - RBig::ONE);
        let k = RBig::ONE + &exact_g * &s;
        let square = RBig::ONE - &exact_g * &exact_g;
        let turn = &square / &k;
        let want = near(&((RBig::ONE + &exact_g * &exact_g - &turn * &turn) / (RBig::from(2) * &exact_g)));
        let [cos, ..] = kernels::sample_henyey_greenstein(u, g);
        prop_assert!(ulp(cos, want) <= 0.51 || (f64::from(cos) - want).abs() <= 1e-15, "{cos} {want}: {u:?} {g:?}");
        if g.abs() < 1e-3 {
            prop_assert!(ulp(cos, want) <= 0.51 || want.abs() < 1e-7 * f64::from(g.abs()), "{cos} {want}: {u:?} {g:?}");
        }
    }
}

#[test]
fn an_endless_medium_lets_nothing_through() {
    let mut sum = Extinction::default();
    sum.add(1.0);
    sum.add(f32::INFINITY);
    sum.add(1.0);
    assert_eq!((sum.depth(), sum.through(), sum.lost()), (f32::INFINITY, 0.0, 1.0));
}

/// 0.0031308 as f32 is greater than 0.0031308: it lies on the curve, which is 2.7e-8 lower there than the line.
#[test]
fn srgb_is_a_curve_from_the_first_number_beyond_its_border() {
    let (line, curve) = (0.0031308_f32.next_down(), 0.0031308_f32);
    assert!(f64::from(line) < 0.0031308 && f64::from(curve) > 0.0031308);
    assert_eq!(kernels::scalar::srgb_encode(line), (12.92 * f64::from(line)) as f32);
    assert_eq!(kernels::scalar::srgb_encode(curve), 0.040_449_91);
}
