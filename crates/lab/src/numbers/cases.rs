//! Each formula with its hard cases: how they are drawn, its three forms, the truth, and what an error counts.

use super::naive;
use super::random::Random;
use super::real::{Arguments, vector};
use super::truth;
use glam::Vec3;
use luc_core::kernels::{self, Ray};
use luc_core::math::lanes::{self, F, V3, splat};
use luc_core::math::lanes_f64::D;
use luc_core::math::{lanes_fn, sampling};
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
    Ray { origin: v3(x, 0), direction: v3(x, 3) }
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
fn about_axis(random: &mut Random, across: f32, height: f32) -> (f32, Vec3, Vec3, [Vec3; 2]) {
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

/// All formulas, in the order of the report.
pub const KERNELS: &[Kernel] = &[
    kernel!(
        "sphere",
        sphere,
        Measure::Score(|x| distance(x, 0, 6) + f64::from(x[9])),
        |random| {
            let radius = random.size(-13, 10);
            let centre = random.vector(-6, 10);
            let normal = random.direction();
            let [o, d] = random.ray(centre + normal * radius, normal, normal, radius);
            list([&o.to_array(), &d.to_array(), &centre.to_array(), &[radius]])
        },
        truth::sphere,
        |x| some(kernels::sphere(&ray(x), v3(x, 6), x[9]).map(|c| c.first())),
        |x| {
            let s = shape(x);
            let ball = Sphere { centre: v3(&s, 6), radius: s[9], material: 0, blend: 0.0 };
            trace::sphere(&rays(x), &ball).first().0
        }
    ),
    kernel!(
        "plane",
        plane,
        Measure::Score(|x| distance(x, 0, 6)),
        |random| {
            let (point, normal) = (random.vector(-6, 20), random.direction());
            let across = normal.any_orthonormal_vector();
            let target = point + across * random.size(-8, 8);
            let size = random.size(-8, 8);
            let [o, d] = random.ray(target, normal, across, size);
            list([&o.to_array(), &d.to_array(), &point.to_array(), &normal.to_array()])
        },
        truth::plane,
        |x| some(kernels::plane(&ray(x), v3(x, 6), v3(x, 9))),
        |x| {
            let s = shape(x);
            let plane = Plane { point: v3(&s, 6), normal: v3(&s, 9), reach: f32::INFINITY, material: 0 };
            trace::plane(&rays(x), &plane).first().0
        }
    ),
    kernel!(
        "cylinder",
        cylinder,
        Measure::Score(|x| 2.0 * distance(x, 0, 6) + f64::from(x[12])),
        |random| {
            let height = random.signed(-4, 6);
            let (r, place, axis, [o, d]) = about_axis(random, 1.0, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[r]])
        },
        truth::cylinder,
        |x| some(kernels::cylinder(&ray(x), v3(x, 6), v3(x, 9), x[12]).map(|c| c.first())),
        |x| trace::cylinder(&rays(x), &bar(&shape(x), f32::INFINITY)).first().0
    ),
    kernel!(
        "capped cylinder",
        capped_cylinder,
        Measure::Score(|x| 2.0 * distance(x, 0, 6) + f64::from(x[12] + x[13])),
        |random| {
            let (across, height) = if random.one_in(2) {
                (1.0, random.range(0.0, 2.0))
            } else {
                (random.range(0.0, 1.0), if random.one_in(2) { 0.0 } else { 2.0 })
            };
            let (r, place, axis, [o, d]) = about_axis(random, across, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[r, 2.0 * r]])
        },
        truth::capped_cylinder,
        |x| some(kernels::capped_cylinder(&ray(x), v3(x, 6), v3(x, 9), x[12], x[13]).map(|c| c.first())),
        |x| {
            let s = shape(x);
            trace::cylinder(&rays(x), &bar(&s, s[13])).first().0
        }
    ),
    kernel!(
        "cone",
        cone,
        Measure::Score(|x| 2.0 * distance(x, 0, 6)),
        |random| {
            let (slope, height) = (random.size(-7, 3), random.size(-6, 6));
            let (_, place, axis, [o, d]) = about_axis(random, slope * height, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[slope]])
        },
        truth::cone,
        |x| some(kernels::cone(&ray(x), v3(x, 6), v3(x, 9), x[12]).map(|c| c.first())),
        |x| {
            let s = shape(x);
            let (apex, axis, range) = (v3(&s, 6), v3(&s, 9), [0.0, f32::INFINITY]);
            let cone = Cone { apex, axis, slope: s[12], range, caps: [false; 2], material: 0 };
            trace::cone(&rays(x), &cone).first().0
        }
    ),
    kernel!(
        "triangle",
        triangle,
        Measure::Score(|x| distance(x, 0, 6).max(distance(x, 0, 9)).max(distance(x, 0, 12))),
        |random| {
            let size = random.size(-12, 12);
            let at = random.vector(-6, 8) * size;
            let e = [random.direction() * size, random.direction() * (size * random.size(-8, 1))];
            let n = e[0].cross(e[1]).normalize_or(Vec3::Y);
            let (mut a, mut b) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
            match random.bits() % 4 {
                0 => a = random.signed(-20, 0),
                1 => b = 1.0 - a + random.signed(-20, 0),
                _ => {}
            }
            let [o, d] = random.ray(at + e[0] * a + e[1] * b, n, e[0].normalize_or(n), size);
            let corners = [at, at + e[0], at + e[1]].map(|p| p.to_array());
            list([&o.to_array(), &d.to_array(), &corners[0], &corners[1], &corners[2]])
        },
        truth::triangle,
        |x| some(kernels::triangle(&ray(x), [v3(x, 6), v3(x, 9), v3(x, 12)]).map(|h| h.t)),
        |x| {
            let s = shape(x);
            let triangle = Triangle { corners: [v3(&s, 6), v3(&s, 9), v3(&s, 12)], material: 0 };
            trace::triangle(&rays(x), &triangle).first().0
        }
    ),
    kernel!(
        "box slab",
        slab,
        Measure::Score(|x| distance(x, 0, 6).max(distance(x, 0, 9))),
        |random| {
            let size = random.size(-8, 8);
            let lo = random.vector(-6, 8) * size;
            let mut side = Vec3::from_array([0; 3].map(|_| size * random.range(0.1, 1.0)));
            if random.one_in(8) {
                side[random.bits() as usize % 3] = 0.0;
            }
            let hi = lo + side;
            // At a face, an edge or a corner, or along one.
            let mut target = lo + side * Vec3::from_array([0; 3].map(|_| random.range(0.0, 1.0)));
            for axis in 0..3 {
                match random.bits() % 4 {
                    0 => target[axis] = lo[axis],
                    1 => target[axis] = hi[axis],
                    _ => {}
                }
            }
            let axis = Vec3::AXES[random.bits() as usize % 3];
            let normal = Vec3::AXES[random.bits() as usize % 3];
            let [o, d] = random.ray(target, normal, axis, size);
            list([&o.to_array(), &d.to_array(), &lo.to_array(), &hi.to_array()])
        },
        truth::slab,
        |x| some(kernels::slab(&ray(x), v3(x, 6), v3(x, 9)).map(|t| t[0])),
        |x| {
            let s = shape(x);
            rays(x).in_box(v3(&s, 6), v3(&s, 9), lanes::INFINITY).0
        }
    ),
    kernel!(
        "quadratic",
        quadratic,
        Measure::Ulp,
        |random| {
            let (a, b, c) = (random.signed(-20, 20), random.signed(-20, 20), random.signed(-20, 20));
            // Nearly double roots too.
            let c = if random.one_in(3) && a != 0.0 { b * b / (4.0 * a) } else { c };
            list([&[a, b, c]])
        },
        |x, _| {
            let [a, b, c] = vector(x, 0).map(f64::from);
            let square = b * b - 4.0 * a * c;
            if a == 0.0 {
                return if b == 0.0 { f64::NAN } else { -c / b };
            }
            let q = -0.5 * (b + square.sqrt().copysign(b));
            if square < 0.0 {
                f64::NAN
            } else if q == 0.0 {
                0.0
            } else {
                (q / a).max(c / q)
            }
        },
        |x| some(kernels::quadratic(x[0], x[1], x[2]).map(|r| r[1])),
        |x| {
            let [a, b, c] = [x[0], x[1], x[2]].map(|x| x.to_array());
            F::new(std::array::from_fn(|i| some(kernels::quadratic(a[i], b[i], c[i]).map(|r| r[1]))))
        }
    ),
    kernel!(
        "ab - cd",
        products,
        Measure::Ulp,
        |random| {
            let [a, b, c] =
                [0; 3].map(|_| random.range(1e4, 5e4) * if random.one_in(2) { 1.0 } else { -1.0 });
            let d = a * b / c * (1.0 + random.signed(-23, -4));
            list([&[a, b, c, d]])
        },
        |x, _| {
            let [a, b, c, d] = [x[0], x[1], x[2], x[3]].map(f64::from);
            a * b - c * d
        },
        |x| scalar(lanes::difference_of_products(splat(x[0]), splat(x[1]), splat(x[2]), splat(x[3]))),
        |x| lanes::difference_of_products(x[0], x[1], x[2], x[3])
    ),
    kernel!(
        "GGX D of n·h",
        ggx,
        Measure::Ulp,
        |random| {
            let alpha = random.size(-13, 0);
            list([&[random.cosine(), alpha]])
        },
        |x, _| ggx_truth((1.0 - f64::from(x[0])) * (1.0 + f64::from(x[0])), x[0].into(), x[1].into()),
        |x| kernels::ggx_of_cosine(x[0], x[1]),
        |x| {
            let sine2 = (F::ONE - x[0]) * (F::ONE + x[0]);
            shade::distribution(sine2, x[0], x[1]) * splat(std::f32::consts::FRAC_1_PI)
        }
    ),
    kernel!(
        "GGX D of n and h",
        ggx_vectors,
        // Of the rounding of the vectors themselves.
        Measure::Unit(|x, d| d * 4.0 / f64::from(x[6])),
        |random| {
            let alpha = random.size(-10, 0);
            let n = random.direction();
            let h = (n + random.direction() * (alpha * random.size(-6, 3))).normalize();
            list([&n.to_array(), &h.to_array(), &[alpha]])
        },
        |x, _| {
            let (n, h) = (v3(x, 0).as_dvec3(), v3(x, 3).as_dvec3());
            ggx_truth(n.cross(h).length_squared(), n.dot(h), x[6].into())
        },
        |x| kernels::ggx(v3(x, 0), v3(x, 3), x[6]),
        |x| {
            let (n, h) = (packet(x, 0), packet(x, 3));
            let across = n.cross(h);
            shade::distribution(across.dot(across), n.dot(h), x[6]) * splat(std::f32::consts::FRAC_1_PI)
        }
    ),
    kernel!(
        "Smith G1",
        smith_g1,
        Measure::Ulp,
        |random| {
            let cos = random.cosine();
            list([&[cos, random.size(-13, 0)]])
        },
        |x, _| {
            let (c, a) = (f64::from(x[0]), f64::from(x[1]));
            2.0 * c / (c + (a * a * (1.0 - c) * (1.0 + c) + c * c).sqrt())
        },
        |x| kernels::smith_g1(x[0], x[1]),
        |x| shade::masking(x[0], x[1])
    ),
    kernel!(
        "Smith G2",
        smith_g2,
        Measure::Ulp,
        |random| {
            let (l, v) = (random.cosine(), random.cosine());
            list([&[l, v, random.size(-13, 0)]])
        },
        |x, _| {
            let [l, v, a] = vector(x, 0).map(f64::from);
            let smith = |c: f64| (a * a * (1.0 - c) * (1.0 + c) + c * c).sqrt();
            2.0 * l * v / (l * smith(v) + v * smith(l))
        },
        |x| kernels::smith_g2(x[0], x[1], x[2]),
        |x| (shade::visibility(x[0], x[1], x[2]) * (x[0] + x[0])) * (x[1] + x[1])
    ),
    kernel!(
        "Beckmann D",
        beckmann,
        // The exponent's rounding.
        Measure::Unit(|x, d| d * (4.0 + 4.0 * exponent(x[0].into(), x[1].into()))),
        |random| loop {
            let (cos, m) = (random.cosine(), random.size(-9, 1));
            if exponent(cos.into(), m.into()) < 60.0 {
                return list([&[cos, m]]);
            }
        },
        |x, _| {
            let (c, m) = (f64::from(x[0]), f64::from(x[1]));
            exact_exp(-exponent(c, m)) / (PI * m * m * c * c * c * c)
        },
        |x| kernels::beckmann_of_cosine(x[0], x[1]),
        |x| {
            let sine2 = (F::ONE - x[0]) * (F::ONE + x[0]);
            shade::beckmann(sine2, x[0], x[1]) * splat(std::f32::consts::FRAC_1_PI)
        }
    ),
    kernel!(
        "Schlick",
        schlick,
        Measure::Ulp,
        |random| {
            let f0 = random.range(0.0, 1.0);
            list([&[f0, random.cosine()]])
        },
        |x, _| {
            let (f0, m) = (f64::from(x[0]), 1.0 - f64::from(x[1]));
            f0 + (1.0 - f0) * m * m * m * m * m
        },
        |x| kernels::schlick(x[0], x[1]),
        |x| shade::schlick(V3::new(x[0], x[0], x[0]), F::ONE, x[1]).x
    ),
    kernel!(
        "Fresnel",
        fresnel,
        Measure::Ulp,
        |random| {
            let n_i = if random.one_in(2) { 1.0 } else { random.range(1.0, 3.0) };
            let n_t = if random.one_in(8) { n_i + random.signed(-20, -4) } else { random.range(1.0, 3.0) };
            list([&[near_critical(random, n_i, n_t), n_i, n_t]])
        },
        |x, _| {
            let [c, i, t] = vector(x, 0).map(f64::from);
            let g2 = (t - i) * (t + i) + (i * c) * (i * c);
            if g2 < 0.0 {
                return 1.0;
            }
            let g = g2.sqrt();
            let s = (i - t) * (i + t) / ((i * c + g) * (i * c + g));
            let p = (t * t * c - i * g) / (t * t * c + i * g);
            if i == t && c == 0.0 { 0.0 } else { 0.5 * (s * s + p * p) }
        },
        |x| kernels::fresnel(x[0], x[1], x[2]),
        |x| dielectric::reflectance(x[0], x[1], x[2])
    ),
    kernel!(
        "refraction",
        refract,
        Measure::Unit(|x, cos| {
            let eta = f64::from(x[6]);
            (1.0 + eta * eta) * (1.0 + 1.0 / cos.abs().max(1e-3))
        }),
        |random| {
            let n = random.direction();
            let eta = if random.one_in(2) { random.range(1.0, 2.5) } else { random.range(0.4, 1.0) };
            let any = random.direction();
            let cos = near_critical(random, eta, 1.0).max(1e-6);
            let across = (any - n * any.dot(n)).normalize_or(n.any_orthonormal_vector());
            let d = (across * ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt() - n * cos).normalize();
            list([&d.to_array(), &n.to_array(), &[eta]])
        },
        |x, _| {
            let (d, n, eta) = (v3(x, 0).as_dvec3(), v3(x, 3).as_dvec3(), f64::from(x[6]));
            let sine: f64 = eta * n.cross(d).length();
            // Within the rounding of n and d either is right.
            if (sine - 1.0).abs() < 8.0 * U { f64::INFINITY } else { -((1.0 - sine) * (1.0 + sine)).sqrt() }
        },
        |x| some(kernels::refract(v3(x, 0), v3(x, 3), x[6]).map(|t| t.dot(v3(x, 3)))),
        |x| {
            let (d, n) = (packet(x, 0), packet(x, 3));
            shade::refract(n, d, -d.dot(n), x[6]).direction.x
        }
    ),
    kernel!(
        "Henyey-Greenstein",
        phase,
        Measure::Ulp,
        |random| {
            let g = if random.one_in(2) { 1.0 - random.size(-13, 0) } else { random.range(-0.999, 0.999) };
            let cos = random.cosine();
            list([&[if random.one_in(4) { -cos } else { cos }, g.min(phase::STEEPEST)]])
        },
        |x, _| {
            let (c, g) = (f64::from(x[0]), f64::from(x[1]));
            let (c, g) = if g < 0.0 { (-c, -g) } else { (c, g) };
            let d = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - c);
            (1.0 - g) * (1.0 + g) / (4.0 * PI * d * d.sqrt())
        },
        |x| kernels::henyey_greenstein(x[0], x[1]),
        |x| phase::phase(scalar(x[1]), x[0])
    ),
    kernel!(
        "HG, drawn cosine",
        turn,
        Measure::Unit(|_, _| 1.0),
        |random| {
            let g = match random.bits() % 3 {
                0 => random.size(-30, -1),
                1 => 1.0 - random.size(-13, 0),
                _ => random.range(-0.999, 0.999),
            };
            let u = random.range(0.0, 1.0);
            list([&[u, if g == 0.0 { 0.5 } else { g.min(phase::STEEPEST) }]])
        },
        |x, _| {
            let (u, g) = (f64::from(x[0]), f64::from(x[1]));
            let (u, sign, g) = if g < 0.0 { (1.0 - u, -1.0, -g) } else { (u, 1.0, g) };
            let e = (1.0 - g) / (1.0 - g + 2.0 * g * u);
            sign * (1.0 - 2.0 * e * e * (1.0 - u) * (1.0 + g * u))
        },
        |x| kernels::sample_henyey_greenstein(x[0], x[1])[0],
        |x| phase::turn(scalar(x[1]), x[0]).cos
    ),
    kernel!(
        "extinction, 1024 steps",
        extinction,
        Measure::Ulp,
        |random| list([&[random.size(-34, -4)]]),
        |x, _| -exact_exp_m1(-1024.0 * f64::from(x[0])),
        |x| {
            let mut sum = kernels::Extinction::default();
            (0..1024).for_each(|_| sum.add(x[0]));
            sum.lost()
        },
        |x| {
            let mut sum = extinction::Depth::default();
            (0..1024).for_each(|_| sum.add(x[0]));
            sum.lost()
        }
    ),
    kernel!(
        "smooth minimum",
        smooth_min,
        Measure::Unit(|x, _| f64::from(x[0].abs().max(x[1].abs()).max(x[2]))),
        |random| {
            let (a, k) = (random.signed(-10, 10), random.size(-10, 4));
            let b = if random.one_in(2) { a + k * random.range(-1.5, 1.5) } else { random.signed(-10, 10) };
            list([&[a, b, if random.one_in(16) { 0.0 } else { k }]])
        },
        |x, _| {
            let [a, b, k] = vector(x, 0).map(f64::from);
            let h = (k - (a - b).abs()).max(0.0);
            a.min(b) - if h > 0.0 { h * h / (4.0 * k) } else { 0.0 }
        },
        |x| kernels::smooth_union(x[0], x[1], x[2]),
        |x| trace::smooth_min(x[0], x[1], scalar(x[2])).0
    ),
    kernel!(
        "repetition",
        repeat,
        Measure::Unit(|x, _| f64::from(x[0].abs() + x[1])),
        |random| loop {
            let (x, side) = (random.signed(-4, 17), random.size(-4, 4));
            let cell = f64::from(x) / f64::from(side) + 0.5;
            // Next to a border either cell is right.
            if (cell - cell.round()).abs() > 4.0 * U * cell.abs() {
                return list([&[x, side]]);
            }
        },
        |x, _| {
            let (x, side) = (f64::from(x[0]), f64::from(x[1]));
            x - side * (x / side + 0.5).floor()
        },
        |x| kernels::repeat(x[0], x[1], f32::INFINITY),
        |x| trace::repeated(x[0], scalar(x[1]), f32::INFINITY).1
    ),
    kernel!(
        "distance from a box",
        sdf_box,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + v3(x, 3).length())),
        |random| {
            let half = Vec3::from_array([0; 3].map(|_| random.range(0.1, 1.0)));
            let p = random.vector(-6, 10);
            list([&p.to_array(), &half.to_array()])
        },
        |x, _| {
            let q = v3(x, 0).as_dvec3().abs() - v3(x, 3).as_dvec3();
            q.max(glam::DVec3::ZERO).length() + q.max_element().min(0.0)
        },
        |x| kernels::sdf(&Node::cuboid(Vec3::ZERO, v3(x, 3), 0.0), v3(x, 0)),
        |x| trace::form(&Node::cuboid(Vec3::ZERO, v3(&shape(x), 3), 0.0), packet(x, 0))
    ),
    kernel!(
        "distance from a ring",
        sdf_torus,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + x[3] + x[4])),
        |random| {
            let (radius, thick) = (random.range(0.5, 2.0), random.range(0.01, 0.5));
            let p = if random.one_in(2) { random.vector(-6, 10) } else { random.direction() * radius };
            list([&p.to_array(), &[radius, thick]])
        },
        |x, _| {
            let p = v3(x, 0).as_dvec3();
            let out = (p.x * p.x + p.z * p.z).sqrt() - f64::from(x[3]);
            (out * out + p.y * p.y).sqrt() - f64::from(x[4])
        },
        |x| kernels::sdf(&Node::torus(Vec3::ZERO, x[3], x[4]), v3(x, 0)),
        |x| {
            let s = shape(x);
            trace::form(&Node::torus(Vec3::ZERO, s[3], s[4]), packet(x, 0))
        }
    ),
    kernel!(
        "basis of a normal",
        basis,
        // Three products, each of two rounded numbers.
        Measure::Unit(|_, _| 3.0),
        |random| {
            let tilt = Vec3::new(random.signed(-40, 0), random.signed(-40, 0), -1.0);
            let n = if random.one_in(2) { random.direction() } else { tilt.normalize() };
            list([&n.to_array()])
        },
        |_, _| 0.0,
        |x| {
            let (u, v) = kernels::basis(v3(x, 0));
            let wide = |v: Vec3| v.as_dvec3().to_array();
            naive::unlike(wide(u), wide(v), wide(v3(x, 0))) as f32
        },
        |x| {
            let (u, v) = sampling::basis(packet(x, 0));
            u.x + v.x
        }
    ),
    kernel!(
        "exp",
        exp,
        Measure::Ulp,
        |random| list([&[
            random.range(-87.0, 88.0) * if random.one_in(2) { 1.0 } else { random.size(-20, 0) }
        ]]),
        |x, _| exact_exp(x[0].into()),
        |x| kernels::scalar::exp(x[0]),
        |x| lanes_fn::exp(x[0])
    ),
];

fn ggx_truth(sine2: f64, cos: f64, alpha: f64) -> f64 {
    let q = alpha / (sine2 + alpha * cos * alpha * cos);
    q * q / PI
}

/// tan² / m².
fn exponent(cos: f64, m: f64) -> f64 {
    (1.0 - cos) * (1.0 + cos) / (cos * cos * m * m)
}

#[allow(clippy::disallowed_methods, reason = "the oracle's own arithmetic")]
fn exact_exp(x: f64) -> f64 {
    x.exp()
}

#[allow(clippy::disallowed_methods, reason = "the oracle's own arithmetic")]
fn exact_exp_m1(x: f64) -> f64 {
    x.exp_m1()
}
