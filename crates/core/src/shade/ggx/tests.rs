//! Kernels in ulp of f64, reciprocity bit for bit, no more light out than in, finite everywhere.

use super::*;
use crate::math::Vec3;
use crate::math::check::Worst;
use crate::math::lanes::FALSE;
use crate::math::lanes::splat_u;
use crate::math::sampling::point;
use crate::scene::Material;
use crate::trace::check::{self, Random, tilted};

/// A surface that faces up.
fn surface(roughness: f32, f0: Vec3) -> Surface {
    let material = Material { roughness, specular: Vec3::ONE, f0, ..Material::default() };
    let up = V3::splat(Vec3::Y);
    check::surface(material, up, up, FALSE)
}

#[test]
fn distribution_and_visibility_are_within_4_ulp() {
    let mut random = Random::new(610);
    let (mut worst_d, mut worst_v) = (Worst::new("GGX D"), Worst::new("Smith V"));
    for _ in 0..200_000 {
        let alpha = random.size(-10, 0);
        let (sine2, cos) = (random.size(-30, 0), random.range(0.0, 1.0));
        let (a, s, c) = (f64::from(alpha), f64::from(sine2), f64::from(cos));
        let exact = a / (s + (a * c) * (a * c));
        let got = distribution(splat(sine2), splat(cos), splat(alpha)).as_array()[0];
        worst_d.add(alpha, got, exact * exact);

        let cosine =
            |random: &mut Random| if random.one_in(2) { random.range(0.0, 1.0) } else { random.size(-40, 0) };
        let (l, v) = (cosine(&mut random), cosine(&mut random));
        let smith = |x: f64| (a * a * ((1.0 - x) * (1.0 + x)) + x * x).sqrt();
        let (x, y) = (f64::from(l), f64::from(v));
        let got = visibility(splat(l), splat(v), splat(alpha)).as_array()[0];
        worst_v.add(l, got, 0.5 / (x * smith(y) + y * smith(x)));
    }
    assert!(worst_d.ulp() <= 4.0 && worst_v.ulp() <= 4.0);
}

#[test]
fn both_cosines_zero_show_nothing() {
    assert_eq!(visibility(F::ZERO, F::ZERO, splat(0.3)), F::ZERO);
}

#[test]
fn the_same_both_ways_bit_for_bit() {
    let mut random = Random::new(611);
    for case in 0..50_000 {
        let s = surface(random.range(0.0, 1.0), Vec3::new(0.9, 0.5, 0.04));
        let (l, v) =
            (tilted(random.range(0.0, 1.0), random.range(0.0, 6.3)), tilted(random.range(0.0, 1.0), 1.0));
        let there = ggx(&s, V3::splat(l), V3::splat(v)).lane(0);
        let back = ggx(&s, V3::splat(v), V3::splat(l)).lane(0);
        assert_eq!(
            there.to_array().map(f32::to_bits),
            back.to_array().map(f32::to_bits),
            "case {case}: l {l:?} v {v:?}"
        );
    }
}

#[test]
fn finite_and_not_negative_at_grazing_and_without_roughness() {
    let mut random = Random::new(612);
    for _ in 0..100_000 {
        let roughness = if random.one_in(4) { 0.0 } else { random.size(-14, 0) };
        let s = surface(roughness, Vec3::ONE);
        let cos = |random: &mut Random| if random.one_in(8) { 0.0 } else { random.size(-126, 0) };
        let l = tilted(cos(&mut random), random.range(0.0, 6.3));
        // Seen from behind a bent normal too, against the light, and where it is mirrored.
        let v = match random.bits() % 4 {
            0 => -l,
            1 => -tilted(cos(&mut random), 1.0),
            2 => Vec3::new(-l.x, l.y, -l.z),
            _ => tilted(cos(&mut random), random.range(0.0, 6.3)),
        };
        let found = (ggx(&s, V3::splat(l), V3::splat(v)) * splat(l.y)).lane(0);
        assert!(found.is_finite() && found.min_element() >= 0.0, "{found} l {l:?} v {v:?} {roughness:?}");
    }
}

/// The integral of D cos over the half space, in u = ln sin θ up to the horizon, where the lobe of
/// any roughness is as wide as any other. Tolerance: midpoint rule and f32.
#[test]
fn the_facets_cover_the_surface_once() {
    for roughness in [0.04_f32, 0.1, 0.3, 0.7, 1.0] {
        let alpha = roughness * roughness;
        let steps = 20_000;
        let lowest = -16.0_f64;
        let mut sum = 0.0;
        for i in 0..steps {
            #[allow(clippy::disallowed_methods, reason = "the oracle's own arithmetic")]
            let sine = (lowest * (f64::from(i) + 0.5) / f64::from(steps)).exp();
            let cos = ((1.0 - sine) * (1.0 + sine)).sqrt();
            let d = distribution(splat((sine * sine) as f32), splat(cos as f32), splat(alpha));
            // dω = 2π sin dθ, dθ = sin du / cos.
            sum += f64::from(d.as_array()[0]) * 2.0 * sine * sine;
        }
        sum *= -lowest / f64::from(steps);
        assert!((sum - 1.0).abs() < 1e-3, "{sum} at roughness {roughness}");
    }
}

/// Light that a white surface sends to an eye at this cosine, all around being white: the integral
/// of ggx cos / pi over the half space by the midpoint rule, in cosine and turn.
fn furnace(s: &Surface, cos: f32) -> f64 {
    let v = V3::splat(tilted(cos, 0.0));
    let (rings, turns) = (512, 512);
    let mut sum = 0.0;
    for i in 0..rings {
        let c = (i as f32 + 0.5) / rings as f32;
        for k in (0..turns).step_by(8) {
            let turn = |j: usize| (k as f32 + j as f32 + 0.5) * std::f32::consts::TAU / turns as f32;
            let l = V3::from_fn(|j| tilted(c, turn(j)));
            let light = (ggx(s, l, v).x * l.y).to_array();
            sum += light.iter().map(|&x| f64::from(x)).sum::<f64>();
        }
    }
    sum * 2.0 / f64::from(rings * turns)
}

/// Tolerance 0.2 %: the midpoint rule at roughness 0.25, where the lobe is some rings wide.
#[test]
fn no_more_light_out_than_in() {
    for roughness in [0.25, 0.4, 0.6, 0.8, 1.0] {
        for cos in [1.0, 0.9, 0.5, 0.2, 0.05] {
            let light = furnace(&surface(roughness, Vec3::ONE), cos);
            println!("roughness {roughness} cosine {cos}: {light:.4}");
            assert!(light <= 1.002, "{light} at roughness {roughness}, cosine {cos}");
            // What is missing would be reflected more than once.
            assert!(light > 0.3 && (roughness > 0.5 || light > 0.8), "{light} at {roughness}, {cos}");
        }
    }
    // Seen from above at roughness 1 the integral is 1 - ln 2.
    let light = furnace(&surface(1.0, Vec3::ONE), 1.0);
    assert!((light - 0.306_852_8).abs() < 1e-5, "{light}");
}

/// Drawn directions see all that the integral over the half space sees: in a white surrounding, and
/// in one that brightens to one side, which tells whether they go where the facets send them.
#[test]
fn drawn_directions_find_what_the_integral_finds() {
    for roughness in [0.25, 0.5, 1.0] {
        for cos in [1.0, 0.6, 0.2] {
            let s = surface(roughness, Vec3::new(1.0, 0.3, 0.04));
            let v = V3::splat(tilted(cos, 0.0));
            let around = |l: V3| V3::splat(Vec3::ONE) + V3::new(l.x, l.x, l.x);
            let (rings, turns) = (512, 512);
            let mut exact = glam::DVec3::ZERO;
            for i in 0..rings {
                // cos = 1 - x², denser where the lobe is narrow.
                let x = (i as f32 + 0.5) / rings as f32;
                let c = 1.0 - x * x;
                for k in (0..turns).step_by(8) {
                    let turn = |j: usize| (k as f32 + j as f32 + 0.5) * std::f32::consts::TAU / turns as f32;
                    let l = V3::from_fn(|j| tilted(c, turn(j)));
                    let light = ggx(&s, l, v) * (l.y * splat(2.0 * x)) * around(l);
                    exact += (0..8).map(|j| light.lane(j).as_dvec3()).sum::<glam::DVec3>();
                }
            }
            exact *= 2.0 / f64::from(rings * turns);
            let mut drawn = glam::DVec3::ZERO;
            let count = 1 << 15;
            for i in 0..count {
                let (l, weight) = sample(&s, v, point(splat_u(5), i));
                drawn += (weight * around(l)).lane(0).as_dvec3();
            }
            drawn /= f64::from(count);
            let off = (drawn - exact).abs().max_element();
            assert!(off < 2e-3, "{drawn} {exact} at roughness {roughness}, cosine {cos}");
        }
    }
}

#[test]
fn drawn_directions_are_unit_vectors_and_factors_at_most_1() {
    let mut random = Random::new(613);
    for case in 0..100_000 {
        let roughness = if random.one_in(4) { 0.0 } else { random.size(-14, 0) };
        let cos = if random.one_in(8) { -0.01 } else { random.size(-40, 0) };
        let at = (splat(random.range(0.0, 1.0)), splat(random.range(0.0, 1.0)));
        let (l, weight) = sample(&surface(roughness, Vec3::ONE), V3::splat(tilted(cos, 1.0)), at);
        let (l, weight) = (l.lane(0), weight.lane(0));
        assert!((l.length() - 1.0).abs() < 1e-5, "case {case}: {l}");
        assert!(weight.min_element() >= 0.0 && weight.max_element() <= 1.00001, "case {case}: {weight}");
    }
}
