//! Errors against the standard library in f64, special values, and the bits themselves.

#![allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]

use super::*;
use crate::math::check::{Fingerprint, Worst, bits_spread, every_1009th};

/// Largest error of `f` against `reference` over every 1009th float that `domain` accepts.
fn worst(name: &str, domain: fn(f32) -> bool, f: fn(f32) -> f32, reference: fn(f64) -> f64) -> f64 {
    let mut worst = Worst::new(name);
    every_1009th().filter(|&x| domain(x)).for_each(|x| worst.add(x, f(x), reference(x.into())));
    worst.ulp()
}

#[test]
fn one_argument_functions_are_within_0_51_ulp_over_the_whole_range() {
    let all = |x: f32| !x.is_nan();
    assert!(worst("exp", all, exp, f64::exp) <= 0.51);
    assert!(worst("exp2", all, exp2, f64::exp2) <= 0.51);
    assert!(worst("ln", all, ln, f64::ln) <= 0.51);
    assert!(worst("log2", all, log2, f64::log2) <= 0.51);
    assert!(worst("acos", all, acos, f64::acos) <= 0.51);
    let reducible = |x: f32| x.abs() <= 1.6e6;
    assert!(worst("sin", reducible, sin, f64::sin) <= 0.51);
    assert!(worst("cos", reducible, cos, f64::cos) <= 0.51);
}

#[test]
fn small_steps_around_the_interesting_points_are_within_0_51_ulp() {
    let near =
        |centre: f32| (-4000i32..4000).map(move |i| f32::from_bits(centre.to_bits().wrapping_add_signed(i)));
    let mut worst = Worst::new("dense neighbourhoods");
    for x in near(1.0).chain(near(0.5)).chain(near(0.70710677)).chain(near(2.0)) {
        worst.add(x, ln(x), f64::from(x).ln());
        worst.add(x, log2(x), f64::from(x).log2());
        worst.add(x, acos(x), f64::from(x).acos());
        worst.add(-x, acos(-x), f64::from(-x).acos());
        worst.add(x, exp(x), f64::from(x).exp());
    }
    for n in 1..2000 {
        for x in [n as f32 * core::f32::consts::FRAC_PI_2, n as f32 * 700.0 * core::f32::consts::FRAC_PI_2] {
            for x in [x.next_down(), x, x.next_up()] {
                worst.add(x, sin(x), f64::from(x).sin());
                worst.add(x, cos(x), f64::from(x).cos());
            }
        }
    }
    assert!(worst.ulp() <= 0.51);
}

#[test]
fn huge_angles_lose_accuracy_in_proportion_and_stay_in_range() {
    for x in every_1009th().filter(|x| x.is_finite() && x.abs() > 1.6e6) {
        let (s, c) = sin_cos(x);
        assert!(s.abs() <= 1.0 && c.abs() <= 1.0, "{x}");
        if f64::from(x).abs() < 2f64.powi(50) {
            let allowed = f64::from(x).abs() * 2f64.powi(-52) + 6e-8;
            assert!((f64::from(s) - f64::from(x).sin()).abs() <= allowed, "{x}");
            assert!((f64::from(c) - f64::from(x).cos()).abs() <= allowed, "{x}");
        }
    }
}

#[test]
fn pow_is_within_0_51_ulp() {
    let mut worst = Worst::new("pow");
    for i in 0..2_000_000 {
        let x = f32::from_bits(bits_spread(i, 1) & 0x7fff_ffff);
        // Half of the exponents aim at results inside the f32 range.
        let y = f32::from_bits(bits_spread(i, 2));
        let y = if i % 2 == 0 { (y.abs().min(1e30) as f64 % 260.0 - 130.0) as f32 / log2(x) } else { y };
        if !x.is_nan() && !y.is_nan() {
            worst.add(x, pow(x, y), f64::from(x).powf(y.into()));
        }
    }
    assert!(worst.ulp() <= 0.51);
}

#[test]
fn atan2_is_within_0_51_ulp() {
    let mut worst = Worst::new("atan2");
    for i in 0..2_000_000 {
        let x = f32::from_bits(bits_spread(i, 3));
        let y = f32::from_bits(bits_spread(i, 4));
        // Half of the points have comparable coordinates.
        let y = if i % 2 == 0 { x * (y.abs().min(1e30) as f64 % 4.0 - 2.0) as f32 } else { y };
        if !x.is_nan() && !y.is_nan() {
            worst.add(y, atan2(y, x), f64::from(y).atan2(x.into()));
        }
    }
    for y in [0.0, -0.0, 1.0, -1.0, 1e-45, f32::MAX, f32::INFINITY, f32::NEG_INFINITY] {
        for x in [0.0, -0.0, 1.0, -1.0, 1e-45, -1e-45, f32::MAX, f32::INFINITY, f32::NEG_INFINITY] {
            worst.add(y, atan2(y, x), f64::from(y).atan2(x.into()));
            assert_eq!(atan2(y, x).is_sign_negative(), y.is_sign_negative(), "{y} {x}");
        }
    }
    assert!(worst.ulp() <= 0.51);
}

#[test]
fn srgb_is_within_0_51_ulp_and_its_own_inverse_on_all_bytes() {
    let unit = |x: f32| (0.0..=1.0).contains(&x);
    let encode =
        |v: f64| if v <= f64::from(0.0031308f32) { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    let decode = |v: f64| if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
    assert!(worst("srgb_encode", unit, srgb_encode, encode) <= 0.51);
    assert!(worst("srgb_decode", unit, srgb_decode, decode) <= 0.51);
    for byte in 0..=255 {
        let display = byte as f32 / 255.0;
        assert_eq!((srgb_encode(srgb_decode(display)) * 255.0 + 0.5) as i32, byte);
    }
    assert_eq!((srgb_encode(-1.0), srgb_encode(9.0)), (0.0, 1.0));
    assert_eq!((srgb_decode(-1.0), srgb_decode(9.0)), (0.0, 1.0));
}

#[test]
fn nan_in_gives_nan_out() {
    for f in [sin, cos, exp, exp2, ln, log2, acos, srgb_encode, srgb_decode] {
        assert!(f(f32::NAN).is_nan());
    }
    for f in [pow, atan2] {
        for x in [0.0, 1.0, -1.0, f32::INFINITY] {
            assert!(f(f32::NAN, x).is_nan() && f(x, f32::NAN).is_nan());
        }
    }
}

#[test]
fn special_values_are_as_documented() {
    let inf = f32::INFINITY;
    assert_eq!(
        (exp(0.0), exp(-0.0), exp(inf), exp(-inf), exp(88.73), exp(-104.0)),
        (1.0, 1.0, inf, 0.0, inf, 0.0)
    );
    assert_eq!((exp2(128.0), exp2(-149.0), exp2(-150.0)), (inf, f32::from_bits(1), 0.0));
    for n in -149..128 {
        let power =
            if n < -126 { f32::from_bits(1 << (n + 149)) } else { f32::from_bits(((n + 127) as u32) << 23) };
        assert_eq!(exp2(n as f32), power);
        assert_eq!(log2(power), n as f32);
    }
    assert_eq!((ln(1.0).to_bits(), ln(0.0), ln(-0.0), ln(inf)), (0, -inf, -inf, inf));
    assert!(ln(-1.0).is_nan() && log2(-1e-45).is_nan() && ln(-inf).is_nan());
    assert_eq!((pow(0.0, 0.5), pow(0.0, -0.5), pow(-0.0, 3.0), pow(0.0, 0.0)), (0.0, inf, 0.0, 1.0));
    assert_eq!((pow(inf, 0.0), pow(1.0, inf), pow(inf, -1.0), pow(0.5, inf)), (1.0, 1.0, 0.0, 0.0));
    assert_eq!((pow(3.0, 4.0), pow(1e30, 2.0), pow(1e-30, 2.0)), (81.0, inf, 0.0));
    assert!(pow(-2.0, 2.0).is_nan() && pow(-2.0, 0.0).is_nan());
    assert_eq!((sin(0.0).to_bits(), sin(-0.0).to_bits(), cos(0.0)), (0, 1 << 31, 1.0));
    assert!(sin(inf).is_nan() && cos(-inf).is_nan());
    assert_eq!(
        (acos(1.0), acos(-1.0), acos(0.0)),
        (0.0, core::f32::consts::PI, core::f32::consts::FRAC_PI_2)
    );
    assert!(acos(1.0f32.next_up()).is_nan() && acos(-2.0).is_nan());
}

#[test]
fn bits_are_the_same_in_every_build() {
    let one = |f: fn(f32) -> f32| {
        let mut hash = Fingerprint::new();
        (0..100_000u32).for_each(|i| hash.add(f(f32::from_bits(i.wrapping_mul(42_949)))));
        hash.value()
    };
    let two = |f: fn(f32, f32) -> f32| {
        let mut hash = Fingerprint::new();
        let value = |i, k| f32::from_bits(0x2000_0000 + (bits_spread(i, k) >> 2));
        (0..100_000u32).for_each(|i| hash.add(f(value(i, 5), value(i, 6))));
        hash.value()
    };
    let got = [
        one(sin),
        one(cos),
        one(exp),
        one(exp2),
        one(ln),
        one(log2),
        one(acos),
        one(srgb_encode),
        one(srgb_decode),
        two(pow),
        two(atan2),
    ];
    assert_eq!(
        got,
        [
            0xaa21044108f99af4,
            0x4787b75207d560aa,
            0x6a3110abc35d89f6,
            0xfbb0e1e1467c121c,
            0x73c6ac092021312e,
            0x174673f1c492a271,
            0x7530481501b66996,
            0x1e0a23c09ca2e652,
            0x8f2468e11090ba02,
            0x5d829da8cf8e1257,
            0x720ca01f76fb5770
        ],
        "{got:#x?}"
    );
}
