//! Against sums and exponentials in f64; parts of a way against the whole.

use super::*;
use crate::math::check::{Worst, ulp_error};
use crate::trace::check::Random;

#[allow(clippy::disallowed_methods, reason = "the oracle's own arithmetic")]
fn exp_m1_f64(x: f64) -> f64 {
    x.exp_m1()
}

#[allow(clippy::disallowed_methods, reason = "the oracle's own arithmetic")]
fn exp_f64(x: f64) -> f64 {
    x.exp()
}

#[test]
fn a_thousand_small_steps_are_as_exact_as_one() {
    let mut random = Random::new(670);
    let (mut depth, mut through, mut lost) = (Worst::new("depth"), Worst::new("through"), Worst::new("lost"));
    for _ in 0..3_000 {
        let size = random.size(-30, 2);
        let (mut sum, mut exact) = (Depth::default(), 0.0_f64);
        for _ in 0..1 + random.bits() % 2000 {
            let step = if random.one_in(2) { size } else { size * random.size(-20, 1) };
            if exact + f64::from(step) > 87.0 {
                break;
            }
            sum.add(splat(step));
            exact += f64::from(step);
        }
        depth.add(size, sum.depth().as_array()[0], exact);
        through.add(size, sum.through().as_array()[0], exp_f64(-exact));
        lost.add(size, sum.lost().as_array()[0], -exp_m1_f64(-exact));
    }
    assert!(depth.ulp() <= 1.0 && through.ulp() <= 3.0 && lost.ulp() <= 3.0);
}

/// 1024 steps of 3e-8, of which naive products keep nothing: exp(-τ) is 0.99996928.
#[test]
fn thin_media_do_not_vanish() {
    let mut sum = Depth::default();
    for _ in 0..1024 {
        sum.add(splat(3e-8));
    }
    assert_eq!(sum.through().as_array()[0], 0.999_969_3);
    assert!(ulp_error(sum.lost().as_array()[0], -exp_m1_f64(-1024.0 * f64::from(3e-8_f32))) <= 2.5);
}

/// Depths of parts of a way add up to the whole, wherever it is cut: the light that comes through is the product.
#[test]
fn depth_is_additive() {
    let mut random = Random::new(671);
    for case in 0..20_000 {
        let (a, b) = (random.size(-30, 5), random.size(-30, 5));
        let (mut whole, mut one, mut other) = (Depth::default(), Depth::default(), Depth::default());
        one.add(splat(a));
        other.add(splat(b));
        whole.add(splat(a));
        whole.add(splat(b));
        let product = one.through() * other.through();
        let off = ulp_error(product.as_array()[0], whole.through().as_array()[0].into());
        assert!(off <= 6.0, "case {case}: {a:e} {b:e}: {off} ulp");
        let (mut there, mut back) = (whole, Depth::default());
        back.add(splat(b));
        back.add(splat(a));
        assert_eq!(there.depth(), back.depth(), "the order of two steps: {a:e} {b:e}");
        there.add(F::ZERO);
        assert_eq!(there.depth(), whole.depth());
    }
}

#[test]
fn a_homogeneous_way_has_its_series_for_no_extinction() {
    let mut random = Random::new(672);
    let mut worst = Worst::new("reach");
    for _ in 0..200_000 {
        let (sigma, length) = (random.size(-40, 10), random.size(-20, 12));
        let (s, t) = (f64::from(sigma), f64::from(length));
        let exact = -exp_m1_f64(-s * t) / s;
        worst.add(sigma, reach(splat(sigma), splat(length)).as_array()[0], exact);
    }
    assert!(worst.ulp() <= 4.0);
    assert_eq!(reach(F::ZERO, splat(3.0)), splat(3.0));
    assert_eq!(reach(splat(1e-30), splat(1e-30)), splat(1e-30));
}

#[test]
fn nothing_odd_is_nan() {
    for odd in [0.0, 1e-45, 1e-30, 1e38, f32::INFINITY, f32::NAN] {
        let mut sum = Depth::default();
        sum.add(splat(odd));
        sum.add(splat(1.0));
        assert!((0.0..=1.0).contains(&sum.through().as_array()[0]), "{odd}");
        assert!((0.0..=1.0).contains(&sum.lost().as_array()[0]), "{odd}");
    }
}
