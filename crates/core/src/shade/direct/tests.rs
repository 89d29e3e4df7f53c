//! Light of each kind of lamp by its formula, in shadow and through glass. Highlights: finite everywhere,
//! the same both ways, and no more light out than in.

use super::*;
use crate::math::lanes::{FALSE, TRUE, splat};
use crate::quality::Quality;
use crate::render::Tables;
use crate::scene::{Background, Disc, Emitter, Light, LightKind, Material, Sphere};
use crate::trace::check::{self, Random, tilted};
use std::f32::consts::PI;

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

/// What falls on a matt surface at `point` that faces up.
fn irradiance(scene: &Scene, point: Vec3) -> Vec3 {
    let tables = &mut Tables::default();
    let stage = Stage::new(scene, &Quality::PRESETS[Quality::DEFAULT].1, [8, 8], tables);
    let up = V3::splat(Vec3::Y);
    let matt = Surface { point: V3::splat(point), ..check::surface(Material::default(), up, up, FALSE) };
    let (mut codes, mut counters) = ([F::ZERO; MAX_LAMPS], Counters::default());
    let all = Visibility::Trace(&[u64::MAX; MAX_LAMPS].map(Suspects::new));
    direct(&stage, &matt, up, TRUE, all, &mut codes, &mut counters).irradiance.lane(0)
}

/// A scene of one lamp.
fn lamp(position: Vec3, colour: Vec3, kind: LightKind) -> Scene {
    Scene { lights: vec![Light { position, colour, kind }], ..Scene::default() }
}

#[test]
fn a_lamps_light_falls_with_the_cosine_and_the_square_of_the_distance() {
    let mut random = Random::new(602);
    let colour = Vec3::new(3.0, 2.0, 0.5);
    for _ in 0..20_000 {
        let (point, position) = (random.vector(-3, 4), random.vector(-3, 6));
        let (d, n) = ((position - point).as_dvec3(), Vec3::Y.as_dvec3());
        let expected = d.dot(n).max(0.0) / (d.length() * d.length_squared()) * colour.as_dvec3();
        if d.length_squared() < 1e-6 {
            continue;
        }
        for kind in [LightKind::Point, LightKind::Fill] {
            let found = irradiance(&lamp(position, colour, kind), point).as_dvec3();
            let off = (found - expected).length();
            // The way there is rounded once, by half an ulp of what it is a difference of.
            let rounding = 1e-6 * (1.0 + f64::from(point.length() + position.length()) / d.length());
            assert!(
                off <= rounding * colour.as_dvec3().length() / d.length_squared(),
                "{off}: {position} {point}"
            );
        }
    }
}

#[test]
fn a_spot_is_full_within_dark_without_and_falls_softly_between() {
    let (position, direction) = (Vec3::new(0.0, 2.0, 0.0), Vec3::NEG_Y);
    let (inner, outer) = (0.9_f32, 0.6_f32);
    let kind = LightKind::Spot { direction, inner, outer };
    let mut before = 1.0;
    for i in 0..=1000 {
        let point = Vec3::X * (i as f32 * 0.004);
        let share = irradiance(&lamp(position, Vec3::ONE, kind), point).x
            / irradiance(&lamp(position, Vec3::ONE, LightKind::Point), point).x;
        let cos = crate::math::normalize(point - position).dot(direction);
        let x = ((cos - outer) / (inner - outer)).clamp(0.0, 1.0);
        assert!((share - x * x * (3.0 - 2.0 * x)).abs() < 2e-6, "{share} at a cosine of {cos}");
        assert!(share <= before + 2e-6, "{share} after {before}");
        before = share;
    }
    assert_eq!(before, 0.0);
}

#[test]
fn a_shining_rectangle_lights_as_a_lamp_in_its_middle_to_its_bright_side_only() {
    let radiance = Vec3::new(5.0, 4.0, 3.0);
    let centre = Vec3::new(0.5, 3.0, -1.0);
    let down = Emitter::facing(centre, Vec3::new(0.5, 0.0, -1.0), 2.0, 0.5, radiance);
    let up = Emitter::facing(centre, Vec3::new(0.5, 9.0, -1.0), 2.0, 0.5, radiance);
    for x in 0..20 {
        let point = Vec3::new(x as f32, 0.0, 0.25 * x as f32);
        let d = centre - point;
        let cos = crate::math::normalize(d).y;
        let expected = radiance * (2.0 * 0.5 / PI * cos * cos / d.length_squared());
        let light = |emitter| irradiance(&Scene { emitters: vec![emitter], ..Scene::default() }, point);
        assert!((light(down) - expected).abs().max_element() <= 2e-6 * expected.x, "{point}");
        assert_eq!(light(up), Vec3::ZERO, "behind it, at {point}");
    }
}

#[test]
fn shadows_are_hard_glass_colours_light_and_what_is_behind_everything_casts_none() {
    let ball = |height: f32, material| Sphere { centre: Vec3::Y * height, radius: 0.5, material, blend: 0.0 };
    let amber = Vec3::new(1.0, 0.5, 0.125);
    let scene = |spheres| Scene {
        spheres,
        materials: vec![
            Material::default(),
            Material { transparency: 0.9, shadow: amber, ..Material::default() },
        ],
        ..lamp(Vec3::Y * 8.0, Vec3::splat(64.0), LightKind::Point)
    };
    let under = |spheres| irradiance(&scene(spheres), Vec3::ZERO);
    assert_eq!(under(vec![]), Vec3::ONE);
    assert_eq!(under(vec![ball(2.0, 0)]), Vec3::ZERO, "opaque");
    assert_eq!(under(vec![ball(2.0, 1)]), amber, "glass");
    assert_eq!(under(vec![ball(2.0, 1), ball(4.0, 1)]), amber * amber, "two of glass");
    assert_eq!(under(vec![ball(2.0, 1), ball(4.0, 0)]), Vec3::ZERO, "glass before an opaque one");
    assert_eq!(under(vec![ball(9.0, 0)]), Vec3::ONE, "above the lamp");
    let fill = Scene {
        lights: lamp(Vec3::Y * 8.0, Vec3::splat(64.0), LightKind::Fill).lights,
        ..scene(vec![ball(2.0, 0)])
    };
    assert_eq!(irradiance(&fill, Vec3::ZERO), Vec3::ONE, "nothing hides a fill light");

    // From lit to dark in no more than rounding, where the ray to the lamp touches the ball.
    let opaque = scene(vec![ball(2.0, 0)]);
    let is_dark = |x: f32| irradiance(&opaque, Vec3::X * x) == Vec3::ZERO;
    let edge = 8.0 * 0.5 / (6.0_f32 * 6.0 - 0.5 * 0.5).sqrt();
    assert!(is_dark(edge * (1.0 - 1e-5)) && !is_dark(edge * (1.0 + 1e-5)));

    let disc = Disc { centre: Vec3::new(0.0, 4.0, 0.0), radius: 9.0, low: Vec3::ONE, high: Vec3::ONE };
    let before =
        Scene { background: Background { discs: vec![disc], ..Background::default() }, ..scene(vec![]) };
    assert_eq!(
        irradiance(&before, Vec3::new(0.0, 0.0, -1.0)),
        irradiance(&scene(vec![]), Vec3::new(0.0, 0.0, -1.0))
    );
}

/// (r·v)^n in f64, with r the light's mirrored direction; the power magnifies rounding n times.
#[test]
fn phongs_highlight_is_its_formula() {
    let mut random = Random::new(603);
    let mut seen = 0;
    for _ in 0..50_000 {
        let exponent = random.size(0, 10);
        let s = surface(0.0, exponent);
        let l = tilted(random.range(0.01, 1.0), random.range(0.0, 6.3));
        // About the mirrored direction, where there is something to see.
        let r = Vec3::new(-l.x, l.y, -l.z);
        let v = crate::math::normalize(r + random.direction() * random.size(-8, 1));
        let cos = 2.0 * f64::from(l.y) * v.as_dvec3().y - l.as_dvec3().dot(v.as_dvec3());
        #[allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]
        let expected = cos.max(0.0).powf(exponent.into());
        let found = f64::from(phong(&s, V3::splat(l), V3::splat(v), splat(l.y)).lane(0).x);
        let allowed = 4e-7 * (1.0 + f64::from(exponent) / cos.max(1e-6)) * expected + 1e-30;
        assert!((found - expected).abs() <= allowed, "{found} for {expected}: {exponent} l {l:?} v {v:?}");
        seen += u32::from(expected > 1e-3);
    }
    assert!(seen > 10_000, "{seen}");
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
