//! Highlights: finite everywhere, the same both ways, and no more light out than in.

use super::*;
use crate::math::lanes::{FALSE, splat};
use crate::scene::Material;
use crate::trace::check::{self, Random, tilted};

/// A surface that faces up.
fn surface(roughness: f32, exponent: f32) -> Surface {
    let material = Material {
        roughness,
        exponent,
        specular: Vec3::ONE,
        f0: Vec3::ONE,
        diffuse: 1.0,
        ..Material::default()
    };
    let up = V3::splat(Vec3::Y);
    check::surface(material, up, up, FALSE)
}

#[test]
fn highlights_are_finite_and_not_negative_at_grazing() {
    let mut random = Random::new(600);
    for _ in 0..50_000 {
        let s = surface(random.range(0.0, 1.0) * random.size(-14, 1).min(1.0), random.size(0, 12));
        let cos = |random: &mut Random| if random.one_in(8) { 0.0 } else { random.size(-30, 0) };
        let l = tilted(cos(&mut random), random.range(0.0, 6.3));
        // Seen from behind a blended normal too, and against the light.
        let v = match random.bits() % 4 {
            0 => -l,
            1 => -tilted(cos(&mut random), 1.0),
            _ => tilted(cos(&mut random), random.range(0.0, 6.3)),
        };
        for light in [cook_torrance, phong] {
            let found = light(&s, V3::splat(l), V3::splat(v), splat(l.y)).lane(0);
            let ok = found.is_finite() && found.min_element() >= 0.0;
            assert!(
                ok,
                "{found} l {l:?} v {v:?} {:?} {:?}",
                s.value(Channel::Roughness),
                s.value(Channel::Exponent)
            );
        }
    }
}

#[test]
fn microfacets_reflect_the_same_both_ways() {
    let mut random = Random::new(601);
    for _ in 0..50_000 {
        let s = surface(random.range(0.05, 0.8), 1.0);
        let l = tilted(random.range(0.01, 1.0), random.range(0.0, 6.3));
        let v = tilted(random.range(0.01, 1.0), random.range(0.0, 6.3));
        let there = cook_torrance(&s, V3::splat(l), V3::splat(v), splat(l.y)).lane(0).x / l.y;
        let back = cook_torrance(&s, V3::splat(v), V3::splat(l), splat(v.y)).lane(0).x / v.y;
        assert!((there - back).abs() <= 1e-6 * there.max(back), "{there} {back}: l {l:?} v {v:?}");
    }
}

/// Light that a white surface sends to an eye at this cosine, all around being white: the integral
/// of highlight / pi over the hemisphere by the midpoint rule, in cosine and turn.
fn furnace(s: &Surface, cos: f32) -> f64 {
    let v = V3::splat(tilted(cos, 0.0));
    let (rings, turns) = (512, 512);
    let mut sum = 0.0;
    for i in 0..rings {
        let c = (i as f32 + 0.5) / rings as f32;
        for k in (0..turns).step_by(8) {
            let l = V3::from_fn(|j| {
                tilted(c, (k as f32 + j as f32 + 0.5) * std::f32::consts::TAU / turns as f32)
            });
            let light = cook_torrance(s, l, v, l.y).x.to_array();
            sum += light.iter().map(|&x| f64::from(x)).sum::<f64>();
        }
    }
    // dω = dcos dturn, so each sample stands for 2 pi / count; divided by pi.
    sum * 2.0 / f64::from(rings * turns)
}

/// Tolerance 1 %: the midpoint rule at roughness 0.05, where the lobe is three rings wide.
#[test]
fn microfacets_send_out_no_more_than_comes_in() {
    for roughness in [0.05, 0.1, 0.2, 0.4, 0.8] {
        for cos in [1.0, 0.9, 0.5, 0.2, 0.05] {
            let light = furnace(&surface(roughness, 1.0), cos);
            println!("roughness {roughness} cosine {cos}: {light:.4}");
            assert!(light <= 1.01, "{light} at roughness {roughness}, cosine {cos}");
            if roughness <= 0.2 && cos >= 0.5 {
                assert!(light > 0.95, "{light} at roughness {roughness}, cosine {cos}");
            }
        }
    }
}
