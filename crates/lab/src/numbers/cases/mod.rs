//! Each formula with its hard cases: how they are drawn, its three forms, the truth, and what an error counts.

use super::naive;
use super::real::{Arguments, vector};
use super::truth;
use luc_core::kernels::{self, Ray};
use luc_core::math::Vec3;
use luc_core::math::lanes::{self, F, V3, splat};
use luc_core::math::lanes_f64::D;
use luc_core::math::random::Random;
use luc_core::math::sampling;
use luc_core::scene::{Cone, Cylinder, Node, Plane, Sphere, Triangle};
use luc_core::shade::{self, dielectric, extinction, phase};
use luc_core::trace::{self, Rays8};
use std::f64::consts::PI;

/// Half an ulp of 1 in f32.
pub const U: f64 = 1.0 / 16_777_216.0;

/// What an error is counted in.
pub enum Measure {
    /// How far the exact crossing moves with the shape's surface, by u times this and |t d|.
    Score(fn(&Arguments<f32>) -> f64),
    /// Ulp of the exact result.
    Ulp,
    /// u times this, a function of arguments and result, or half an ulp where that is more.
    Unit(fn(&Arguments<f32>, f64) -> f64),
}

/// A formula.
pub struct Kernel {
    pub name: &'static str,
    pub measure: Measure,
    /// Draws arguments.
    pub draw: fn(&mut Random) -> Arguments<f32>,
    /// The textbook's form in f32 and f64, for one and for packets.
    pub naive: fn(&Arguments<f32>) -> f32,
    pub wide: fn(&Arguments<f64>) -> f64,
    pub naive_packet: fn(&Arguments<F>) -> F,
    pub wide_packet: fn(&Arguments<D>) -> D,
    /// The engine's, for one and for a packet.
    pub ours: fn(&Arguments<f32>) -> f32,
    pub ours_packet: fn(&Arguments<F>) -> F,
    /// The exact result, for the shape grown by a skin; NaN for a miss.
    pub truth: fn(&Arguments<f32>, f64) -> f64,
}

macro_rules! kernel {
    ($name:literal, $naive:ident, $measure:expr, $draw:expr, $truth:expr, $ours:expr, $packet:expr) => {
        Kernel {
            name: $name,
            measure: $measure,
            draw: $draw,
            naive: naive::$naive::<f32>,
            wide: naive::$naive::<f64>,
            naive_packet: naive::$naive::<F>,
            wide_packet: naive::$naive::<D>,
            ours: $ours,
            ours_packet: $packet,
            truth: $truth,
        }
    };
}

mod fields;
mod forms;
mod functions;
mod light;
mod shapes;

/// All formulas, in the order of the report.
pub fn all() -> impl Iterator<Item = &'static Kernel> {
    [shapes::KERNELS, light::KERNELS, fields::KERNELS, forms::KERNELS, functions::KERNELS]
        .into_iter()
        .flatten()
}

fn v3(x: &Arguments<f32>, at: usize) -> Vec3 {
    vector(x, at).into()
}

fn packet(x: &Arguments<F>, at: usize) -> V3 {
    V3::new(x[at], x[at + 1], x[at + 2])
}

fn rays(x: &Arguments<F>) -> Rays8 {
    Rays8 { origin: packet(x, 0), direction: packet(x, 3) }
}

fn ray(x: &Arguments<f32>) -> Ray {
    Ray { origin: v3(x, 0).into(), direction: v3(x, 3).into() }
}

/// Arguments from vectors and numbers, one after another.
fn list<const N: usize>(parts: [&[f32]; N]) -> Arguments<f32> {
    let mut all = [0.0; 16];
    for (to, from) in all.iter_mut().zip(parts.into_iter().flatten()) {
        *to = *from;
    }
    all
}

fn some(t: Option<f32>) -> f32 {
    t.unwrap_or(f32::NAN)
}

fn distance(x: &Arguments<f32>, a: usize, b: usize) -> f64 {
    (v3(x, a).as_dvec3() - v3(x, b).as_dvec3()).length()
}

/// A shape's size, place, axis and a ray at it whose target is at `height` sizes along the axis and `across`
/// sizes off it.
fn about_axis(random: &mut Random, across: f32, height: f32) -> (f32, Vec3, Vec3, (Vec3, Vec3)) {
    let size = random.size(-12, 8);
    let (place, axis) = (random.vector(-6, 10) * size.min(1.0), random.direction());
    let side = axis.any_orthonormal_vector();
    let target = place + (side * across + axis * height) * size;
    let ray = random.ray(target, side, axis, size);
    (size, place, axis, ray)
}

fn bar(x: &Arguments<f32>, length: f32) -> Cylinder {
    Cylinder { base: v3(x, 6), axis: v3(x, 9), radius: x[12], length, material: 0 }
}

fn scalar(x: F) -> f32 {
    x.as_array()[0]
}

/// The shape that all lanes share.
fn shape(x: &Arguments<F>) -> Arguments<f32> {
    x.map(scalar)
}

fn near_critical(random: &mut Random, n_i: f32, n_t: f32) -> f32 {
    let critical = (1.0 - n_t / n_i * (n_t / n_i)).max(0.0).sqrt();
    if random.one_in(3) { (critical + random.signed(-20, -2)).clamp(0.0, 1.0) } else { random.cosine() }
}

fn ggx_truth(sine2: f64, cos: f64, alpha: f64) -> f64 {
    let q = alpha / (sine2 + alpha * cos * alpha * cos);
    q * q / PI
}

/// tan² / m².
fn exponent(cos: f64, m: f64) -> f64 {
    (1.0 - cos) * (1.0 + cos) / (cos * cos * m * m)
}

fn exact_exp(x: f64) -> f64 {
    x.exp()
}

fn exact_exp_m1(x: f64) -> f64 {
    x.exp_m1()
}
