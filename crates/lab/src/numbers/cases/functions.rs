//! Elementary functions: one number at a time, in f64 and rounded, and eight at a time in f32.
#![allow(
    clippy::disallowed_methods,
    reason = "the naive forms are those of the platform, and so is the truth"
)]

use super::*;
use crate::numbers::real::{Function, Real};
use luc_core::math::lanes_fn as packets;
use luc_core::math::scalar as one;

/// Name, arguments, the platform's form in f32 and in f64, and the engine's: of one number, or of eight.
macro_rules! function {
    ($name:literal, $draw:expr, $narrow:expr, $wide:expr, $one:expr) => {
        function!($name, $draw, $narrow, $wide, $one, |x, y| {
            let (x, y) = (x.to_array(), y.to_array());
            F::new(std::array::from_fn(|i| ($one)(x[i], y[i])))
        })
    };
    ($name:literal, $draw:expr, $narrow:expr, $wide:expr, $one:expr, $eight:expr) => {{
        const FORM: Function = Function { narrow: $narrow, wide: $wide };
        const EIGHT: fn(F, F) -> F = $eight;
        Kernel {
            name: $name,
            measure: Measure::Ulp,
            draw: $draw,
            naive: |x| (FORM.narrow)(x[0], x[1]),
            wide: |x| (FORM.wide)(x[0], x[1]),
            naive_packet: |x| F::each(&FORM, x[0], x[1]),
            wide_packet: |x| D::each(&FORM, x[0], x[1]),
            ours: |x| ($one)(x[0], x[1]),
            ours_packet: |x| EIGHT(x[0], x[1]),
            truth: |x, _| (FORM.wide)(x[0].into(), x[1].into()),
        }
    }};
}

/// The same of eight, whose first lane is judged.
macro_rules! of_eight {
    ($name:literal, $draw:expr, $narrow:expr, $wide:expr, $eight:expr) => {
        function!($name, $draw, $narrow, $wide, |x, y| scalar(($eight)(splat(x), splat(y))), $eight)
    };
}

pub const KERNELS: &[Kernel] = &[
    function!("sin", |random| angle(random, 20), |x, _| x.sin(), |x, _| x.sin(), |x, _| one::sin(x)),
    function!("cos", |random| angle(random, 20), |x, _| x.cos(), |x, _| x.cos(), |x, _| one::cos(x)),
    function!("exp", |random| power(random, 87.0), |x, _| x.exp(), |x, _| x.exp(), |x, _| one::exp(x)),
    function!("exp2", |random| power(random, 126.0), |x, _| x.exp2(), |x, _| x.exp2(), |x, _| one::exp2(x)),
    function!("ln", positive, |x, _| x.ln(), |x, _| x.ln(), |x, _| one::ln(x)),
    function!("log2", positive, |x, _| x.log2(), |x, _| x.log2(), |x, _| one::log2(x)),
    function!("pow", |random| powers(random, 8.0), |x, y| x.powf(y), |x, y| x.powf(y), one::pow),
    function!("acos", any_cosine, |x, _| x.acos(), |x, _| x.acos(), |x, _| one::acos(x)),
    function!("atan2", point, |y, x| y.atan2(x), |y, x| y.atan2(x), one::atan2),
    function!("sRGB of light", share, |x, _| srgb(x), |x, _| srgb_wide(x), |x, _| one::srgb_encode(x)),
    function!("light of sRGB", share, |x, _| light(x), |x, _| light_wide(x), |x, _| one::srgb_decode(x)),
    of_eight!("exp of eight", |random| power(random, 87.0), |x, _| x.exp(), |x, _| x.exp(), |x, _| {
        packets::exp(x)
    }),
    of_eight!("exp2 of eight", |random| power(random, 126.0), |x, _| x.exp2(), |x, _| x.exp2(), |x, _| {
        packets::exp2(x)
    }),
    of_eight!(
        "exp - 1 of eight",
        |random| power(random, 80.0),
        |x, _| x.exp() - 1.0,
        |x, _| x.exp_m1(),
        |x, _| packets::exp_m1(x)
    ),
    of_eight!("log2 of eight", positive, |x, _| x.log2(), |x, _| x.log2(), |x, _| packets::log2(x)),
    of_eight!("pow of eight", |random| powers(random, 1.0), |x, y| x.powf(y), |x, y| x.powf(y), packets::pow),
    of_eight!("sin of eight", quadrants, |x, _| x.sin(), |x, _| x.sin(), |x, _| packets::sin_cos(x).0),
];

/// An angle up to 2^`most`.
fn angle(random: &mut Random, most: i32) -> Arguments<f32> {
    list([&[if random.one_in(2) { random.range(-10.0, 10.0) } else { random.signed(-30, most) }]])
}

/// Angles of which f32 keeps the sine to 2⁻²⁰: none next to a multiple of π but 0.
fn quadrants(random: &mut Random) -> Arguments<f32> {
    loop {
        let x = angle(random, 10);
        if x[0].abs() < 1.0 || f64::from(x[0]).sin().abs() > 1e-3 {
            return x;
        }
    }
}

/// An exponent up to `most`, either way.
fn power(random: &mut Random, most: f32) -> Arguments<f32> {
    list([&[if random.one_in(2) { random.range(-most, most) } else { random.signed(-30, 0) }]])
}

/// Any normal number over 0, often close to 1.
fn positive(random: &mut Random) -> Arguments<f32> {
    list([&[if random.one_in(2) { random.size(-126, 127) } else { 1.0 + random.signed(-23, -1) }]])
}

/// A base and an exponent up to `most` either way, whose power is a normal number.
fn powers(random: &mut Random, most: f32) -> Arguments<f32> {
    loop {
        let x = if random.one_in(2) { random.size(-14, 0) } else { 1.0 + random.signed(-20, 3).abs() };
        let y = random.range(-most, most);
        if (1e-37..1e38).contains(&f64::from(x).powf(y.into())) {
            return list([&[x, y]]);
        }
    }
}

fn any_cosine(random: &mut Random) -> Arguments<f32> {
    let cos = random.cosine();
    list([&[if random.one_in(2) { cos } else { -cos }]])
}

fn point(random: &mut Random) -> Arguments<f32> {
    list([&[random.signed(-20, 20), random.signed(-20, 20)]])
}

fn share(random: &mut Random) -> Arguments<f32> {
    list([&[random.cosine()]])
}

fn srgb(x: f32) -> f32 {
    if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

fn srgb_wide(x: f64) -> f64 {
    if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

fn light(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn light_wide(x: f64) -> f64 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}
