//! Errors against the standard library in f64, edge values, lane independence, and the bits themselves.

#![allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]

use super::*;
use crate::math::check::{Fingerprint, Worst, bits_spread, every_1009th, ulp_error};
use crate::math::lanes::LANES;

/// The value of `f` in lane 3 of a packet whose other lanes hold unrelated numbers.
fn at(f: impl Fn(F) -> F, x: f32) -> f32 {
    let mut lanes = [f32::NAN, 1.0, -3.0, x, f32::INFINITY, 0.0, 1e-40, 2e9];
    lanes[3] = x;
    f(F::new(lanes)).as_array()[3]
}

/// Largest error of `f` over every 1009th float that `domain` accepts.
fn worst(name: &str, domain: impl Fn(f32) -> bool, f: fn(F) -> F, reference: fn(f64) -> f64) -> f64 {
    let mut worst = Worst::new(name);
    every_1009th().filter(|&x| domain(x)).for_each(|x| worst.add(x, at(f, x), reference(x.into())));
    worst.ulp()
}

#[test]
fn exponentials_and_logarithm_are_as_exact_as_stated() {
    assert!(worst("lanes exp2", |x| (-126.0..129.0).contains(&x), exp2, f64::exp2) <= 1.2);
    assert!(worst("lanes exp", |x| (-87.33..89.0).contains(&x), exp, f64::exp) <= 1.4);
    assert!(worst("lanes exp_m1", |x| (-200.0..89.0).contains(&x), exp_m1, f64::exp_m1) <= 2.5);
    assert!(worst("lanes log2", |x| (f32::MIN_POSITIVE..=f32::MAX).contains(&x), log2, f64::log2) <= 3.0);
    let mut near_one = Worst::new("lanes log2 near 1");
    for i in -20_000..20_000 {
        let x = f32::from_bits(1.0f32.to_bits().wrapping_add_signed(i));
        near_one.add(x, at(log2, x), f64::from(x).log2());
    }
    assert!(near_one.ulp() <= 3.0);
}

#[test]
fn sin_cos_is_as_exact_as_stated() {
    let mut ulps = Worst::new("lanes sin, cos");
    let mut near_zero = 0.0f64;
    let mut add = |x: f32| {
        for (got, exact) in
            [(at(|x| sin_cos(x).0, x), f64::from(x).sin()), (at(|x| sin_cos(x).1, x), f64::from(x).cos())]
        {
            let error = (f64::from(got) - exact).abs();
            if exact.abs() < 2f64.powi(-20) {
                near_zero = near_zero.max(error);
            } else {
                ulps.add(x, got, exact);
            }
        }
    };
    every_1009th().filter(|x| x.abs() <= 1600.0).for_each(&mut add);
    for n in 1..1018 {
        let zero = (n as f64 * core::f64::consts::FRAC_PI_2) as f32;
        [zero.next_down(), zero, zero.next_up()].into_iter().for_each(&mut add);
    }
    println!("{:24} max 2^{:.2} for results below 2^-20", "", near_zero.log2());
    assert!(near_zero <= 2f64.powi(-42));
    assert!(ulps.ulp() <= 2.5);
}

#[test]
fn pow_is_as_exact_as_stated() {
    let mut ulps = [Worst::new("lanes pow, |y| ≤ 1"), Worst::new("lanes pow, |y| ≤ 1000")];
    for i in 0..2_000_000 {
        let x = f32::from_bits(bits_spread(i, 1) & 0x7fff_ffff);
        let unit = (bits_spread(i, 2) >> 8) as f32 / 8_388_608.0 - 1.0;
        // Exponents up to 1, 10, 100, 1000; bases far from 1 and near it.
        let y = unit * [1.0, 10.0, 100.0, 1000.0][i as usize & 3];
        let x = if i & 4 == 0 { x } else { 0.9 + 0.2 * unit * unit };
        let t = f64::from(x).log2() * f64::from(y);
        if x >= f32::MIN_POSITIVE && x.is_finite() && t.abs() < 126.0 {
            let (got, exact) = (pow(splat(x), splat(y)).as_array()[0], f64::from(x).powf(y.into()));
            let allowed = 2.0 + 2.5 * t.abs().min(f64::from(y).abs());
            assert!(ulp_error(got, exact) <= allowed, "{x:e}^{y} = {exact:e}, not {got:e}");
            ulps[usize::from(y.abs() > 1.0)].add(x, got, exact);
        }
    }
    assert!(ulps[0].ulp() <= 2.0);
    ulps[1].ulp();
}

#[test]
fn sines_of_turns_are_as_exact_as_stated() {
    let mut worst = 0.0f64;
    for i in -200_000..=200_000 {
        let x = i as f32 / 200_000.0 * 0.5;
        let (got, exact) = (at(sin_turns, x), (f64::from(x) * core::f64::consts::TAU).sin());
        let error = (f64::from(got) - exact).abs();
        // At half a turn the exact value is 0, and x itself is rounded.
        worst = worst.max(error / exact.abs().max(0.05));
        assert_eq!(got, -at(sin_turns, -x), "odd at {x}");
        assert!(got.abs() <= 1.0 + 1e-6);
    }
    assert!(worst <= 1.2e-6, "{worst:e}");
    for (x, turn) in [(0.25, 1.0), (-0.25, -1.0), (1.25, 1.0), (1000.75, -1.0), (-3.25, -1.0)] {
        assert!((at(sin_turns, x) - turn).abs() < 2e-6, "{x}");
    }
    for (x, place) in [(0.3, 0.3), (0.7, 0.7f32 - 1.0), (-0.7, 1.0f32 - 0.7), (5.25, 0.25), (-8.0, 0.0)] {
        assert_eq!(at(wrap, x), place, "{x}");
    }
}

#[test]
fn edge_values_are_as_documented() {
    let (inf, nan) = (f32::INFINITY, f32::NAN);
    for n in -126i32..128 {
        let power = f32::from_bits(((n + 127) as u32) << 23);
        assert_eq!((at(exp2, n as f32), at(log2, power)), (power, n as f32));
    }
    for (x, y) in [(128.0, inf), (inf, inf), (-126.001, 0.0), (-1e30, 0.0), (-inf, 0.0), (nan, 0.0)] {
        assert_eq!(at(exp2, x), y, "exp2({x})");
    }
    for (x, y) in [(0.0, 1.0), (-0.0, 1.0), (88.73, inf), (inf, inf), (-87.34, 0.0), (-inf, 0.0), (nan, 0.0)]
    {
        assert_eq!(at(exp, x), y, "exp({x})");
    }
    for (x, y) in
        [(0.0, 0.0), (1e-45, 1e-45), (1e-20, 1e-20), (88.73, inf), (-30.0, -1.0), (-inf, -1.0), (nan, -1.0)]
    {
        assert_eq!(at(exp_m1, x), y, "exp_m1({x})");
    }
    assert!(at(exp, 88.72283).is_finite() && at(exp2, 127.99999).is_finite() && at(exp, -87.33) > 0.0);
    for (x, y) in [(0.0, -inf), (-0.0, -inf), (1e-40, -inf), (-1.0, -inf), (nan, -inf), (inf, 128.0)] {
        assert_eq!(at(log2, x), y, "log2({x})");
    }
    for (x, y, power) in [
        (0.0, 2.0, 0.0),
        (0.0, 1e-3, 0.0),
        (0.0, -0.5, inf),
        (0.0, 0.0, 1.0),
        (-0.0, 1.0, 0.0),
        (-2.0, 2.0, 0.0),
        (nan, 1.0, 0.0),
        (3.0, 0.0, 1.0),
        (nan, 0.0, 1.0),
        (1.0, 1e30, 1.0),
        (1.0, -7.5, 1.0),
        (2.0, 10.0, 1024.0),
        (0.5, 1e30, 0.0),
        (1e30, 5.0, inf),
        (1e-30, 5.0, 0.0),
        (1e-30, -5.0, inf),
        (4.0, 0.5, 2.0),
    ] {
        assert_eq!(at(|v| pow(v, splat(y)), x), power, "pow({x}, {y})");
    }
    for x in every_1009th() {
        let (s, c) = (at(|x| sin_cos(x).0, x), at(|x| sin_cos(x).1, x));
        assert!(
            if x.is_finite() { s.abs() <= 1.0 && c.abs() <= 1.0 } else { s.is_nan() && c.is_nan() },
            "{x}"
        );
    }
    assert_eq!((at(|x| sin_cos(x).0, 0.0), at(|x| sin_cos(x).1, 0.0)), (0.0, 1.0));
}

/// The functions under test with one argument.
const FUNCTIONS: [fn(F) -> F; 8] = [
    exp2,
    exp,
    log2,
    |x| sin_cos(x).0,
    |x| sin_cos(x).1,
    |x| pow(x, splat(0.41)),
    |x| pow(splat(1.7), x),
    exp_m1,
];

#[test]
fn a_lane_does_not_depend_on_the_others() {
    let bits = |v: f32| if v.is_nan() { f32::NAN.to_bits() } else { v.to_bits() };
    for i in 0..20_000 {
        let x = F::new(core::array::from_fn(|lane| f32::from_bits(bits_spread(i, 10 + lane as u32))));
        for f in FUNCTIONS {
            let packet = f(x).to_array();
            for (x, expected) in x.to_array().into_iter().zip(packet) {
                let alone = f(splat(x)).to_array();
                assert!(alone.iter().all(|&v| bits(v) == bits(expected)), "{x} in a packet gives {expected}");
            }
        }
    }
}

#[test]
fn bits_are_the_same_in_every_build() {
    let got = FUNCTIONS.map(|f| {
        let mut hash = Fingerprint::new();
        for i in 0..100_000 / LANES as u32 {
            let x = |lane: usize| f32::from_bits((i * 8 + lane as u32).wrapping_mul(42_949));
            f(F::new(core::array::from_fn(x))).to_array().into_iter().for_each(|v| hash.add(v));
        }
        hash.value()
    });
    assert_eq!(
        got,
        [
            0x65c6b88d11618f0d,
            0x7f1bf8049e9312f5,
            0x20a8801ebc13f953,
            0x31fdf656f9ad4544,
            0x23c06292863dad7b,
            0x3cbb5cc5963c10aa,
            0x190a58f99422bd94,
            0x86897210dd9f2818,
        ],
        "{got:#x?}"
    );
}
