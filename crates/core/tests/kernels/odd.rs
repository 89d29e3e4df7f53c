//! Arguments that make no sense: nothing panics, and no result is NaN where the exact one is a number.

use super::draw::*;
use glam::Vec3;
use luc_core::kernels::{self, Crossing, Extinction, Ray, scalar};
use proptest::prelude::*;

fn sound(crossing: Option<Crossing>) -> bool {
    crossing
        .is_none_or(|c| !c.enter.is_nan() && !c.exit.is_nan() && c.first() > 0.0 && c.first() < f32::INFINITY)
}

proptest! {
    #![proptest_config(config(50_000))]

    #[test]
    fn shapes_are_hit_at_a_number_or_not_at_all(
        origin in odd_vector(),
        direction in odd_vector(),
        a in odd_vector(),
        b in odd_vector(),
        c in odd_vector(),
        x in odd(),
        y in odd(),
    ) {
        let ray = Ray { origin, direction };
        let axis = b.normalize_or(Vec3::Y);
        prop_assert!(sound(kernels::sphere(&ray, a, x)));
        prop_assert!(sound(kernels::cylinder(&ray, a, axis, x)));
        prop_assert!(sound(kernels::capped_cylinder(&ray, a, axis, x, y)));
        prop_assert!(sound(kernels::cone(&ray, a, axis, x)));
        prop_assert!(sound(kernels::capped_cone(&ray, a, axis, x, [y, y + 1.0])));
        prop_assert!(kernels::plane(&ray, a, axis).is_none_or(|t| t > 0.0 && t < f32::INFINITY));
        prop_assert!(kernels::triangle(&ray, [a, b, c]).is_none_or(|h| h.t > 0.0 && h.t < f32::INFINITY));
        prop_assert!(kernels::slab(&ray, a, b).is_none_or(|t| !t[0].is_nan() && !t[1].is_nan()));
    }

    #[test]
    fn shares_are_shares(x in odd(), y in odd(), z in odd(), v in odd_vector()) {
        let n = v.normalize_or(Vec3::Y);
        prop_assert!((0.0..=1.0).contains(&kernels::schlick(0.04, x)), "schlick {x}");
        prop_assert!((0.0..=1.0).contains(&kernels::fresnel(x, 1.0, 1.5)), "fresnel {x}");
        prop_assert!((0.0..=1.0).contains(&kernels::cos_refracted(x, 1.5, 1.0)), "cos {x}");
        prop_assert!(kernels::henyey_greenstein(x, y).is_finite(), "phase {x} {y}");
        prop_assert!(kernels::sample_henyey_greenstein(x, y).iter().all(|v| v.is_finite()), "draw {x} {y}");
        kernels::refract(n, v, x);
        kernels::quadratic(x, y, z);
        kernels::ggx(n, v, x);
        kernels::ggx_of_cosine(x, y);
        kernels::smith_g1(x, y);
        kernels::smith_g2(x, y, z);
        kernels::beckmann(n, v, x);
        kernels::beckmann_of_cosine(x, y);
        kernels::smooth_union(x, y, z);
        kernels::smooth_subtraction(x, y, z);
        kernels::repeat(x, y, z);
        kernels::fold(x, y, z);
        kernels::homogeneous(x, y);
        kernels::basis(n);
        kernels::cosine_weighted(n, x, y);
        let mut sum = Extinction::default();
        sum.add(x.abs());
        sum.add(y.abs());
        if !x.is_nan() && !y.is_nan() {
            prop_assert!((0.0..=1.0).contains(&sum.through()) && (0.0..=1.0).contains(&sum.lost()), "{x} {y}");
        }
    }

    #[test]
    fn elementary_functions_are_numbers_where_they_have_one(x in odd(), y in odd()) {
        if x.is_finite() {
            prop_assert!((-1.0..=1.0).contains(&scalar::sin(x)) && (-1.0..=1.0).contains(&scalar::cos(x)));
        }
        if !x.is_nan() {
            prop_assert!(scalar::exp(x) >= 0.0 && scalar::exp2(x) >= 0.0);
            prop_assert!(x < 0.0 || !scalar::ln(x).is_nan());
            prop_assert!((0.0..=1.0).contains(&scalar::srgb_encode(x)));
            prop_assert!(y.is_nan() || !scalar::atan2(y, x).is_nan());
            prop_assert!(y.is_nan() || x < 0.0 || !scalar::pow(x, y).is_nan(), "pow {x} {y}");
        }
    }
}
