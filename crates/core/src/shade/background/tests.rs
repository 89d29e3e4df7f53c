//! The box filter shares out all light, at any distance; rays that never meet a disc or rectangle.

use super::*;
use crate::math::Vec3;
use crate::math::lanes::{TRUE, splat};
use crate::scene::{Disc, Glow};
use crate::trace::check::{Random, packet};

#[test]
fn neighbouring_boxes_share_the_filter_without_rest() {
    let mut random = Random::new(500);
    for _ in 0..100_000 {
        let half = random.size(-6, 6);
        let width = if random.one_in(8) { 0.0 } else { half * random.size(-12, 4) };
        let x = half * random.range(-8.0, 8.0);
        let sum: f32 = (-24..=24)
            .map(|k| covered(splat(x - 2.0 * half * k as f32), splat(half), splat(width)).to_array()[0])
            .sum();
        let rounding = 4e-6 * (x.abs() + half) / width.max(1e-30);
        // Without a width, a point on the very edge is half in.
        assert!(
            (sum - 1.0).abs() < (2e-6 + rounding).min(1.01),
            "{sum}: x {x:?} half {half:?} width {width:?}"
        );
    }
}

#[test]
fn the_filter_is_a_ramp_as_wide_as_itself() {
    let at = |x: f32, half: f32, w: f32| covered(splat(x), splat(half), splat(w)).to_array()[0];
    assert_eq!(
        (at(0.0, 1.0, 0.5), at(1.0, 1.0, 0.5), at(1.25, 1.0, 0.5), at(0.75, 1.0, 0.5)),
        (1.0, 0.5, 0.0, 1.0)
    );
    assert_eq!(at(0.0, 1.0, 8.0), 0.25, "a filter wider than the box");
    // A hard edge, near and far.
    assert_eq!((at(10.0, 20.0, 0.0), at(1e6, 2e6, 0.0), at(2e6, 1e6, 0.0)), (1.0, 1.0, 0.0));
    assert_eq!(
        (at(f32::NAN, 1.0, 0.0), at(f32::INFINITY, 1.0, 0.0), at(f32::NAN, 1.0, 1.0)),
        (0.0, 0.0, 0.0)
    );
}

#[test]
fn rays_along_a_disc_or_rectangle_do_not_see_it() {
    let disc = Disc { centre: Vec3::Z * 5.0, radius: 2.0, low: Vec3::ONE, high: Vec3::ONE };
    let sky = Background { discs: vec![disc], ..Background::default() };
    let square = Emitter::facing(Vec3::Z * 5.0, Vec3::ZERO, 2.0, 2.0, Vec3::ONE);
    for z in [0.0, 5.0, 9.0] {
        for d in [Vec3::X, Vec3::Y, Vec3::new(1.0, 0.0, -0.0), Vec3::NEG_Z] {
            let rays = packet(|| (Vec3::new(0.0, 0.0, z), d));
            for spread in [0.0, 1e-3] {
                if d.z < 0.0 && z > 5.0 {
                    continue;
                }
                let (colour, id) = background(&sky, &rays, splat(spread), F::ZERO, F::ZERO);
                assert_eq!((colour, id), (V3::ZERO, splat(NONE)), "disc from {z} along {d}");
                let (light, hidden, seen) = emitters(&[square], &rays, splat(spread), splat(f32::INFINITY));
                assert_eq!((light, hidden, seen), (V3::ZERO, F::ZERO, F::ZERO), "square from {z} along {d}");
            }
        }
    }
    let ahead = packet(|| (Vec3::ZERO, Vec3::Z));
    let seen = |blind| background(&sky, &ahead, F::ZERO, F::ZERO, blind);
    assert_eq!(seen(F::ZERO), (V3::splat(Vec3::ONE), splat(NONE - 1.0)));
    assert_eq!(seen(TRUE), (V3::ZERO, splat(NONE)), "who is blind to discs sees the sky");
    assert_eq!(emitters(&[square], &ahead, F::ZERO, splat(f32::INFINITY)).1, splat(1.0));
    assert_eq!(emitters(&[square], &ahead, F::ZERO, splat(4.0)).1, F::ZERO, "behind a shape");
}

/// A wide footprint spreads a glow and keeps its light: the integral of exp(k (c - 1)) over the
/// sphere is 2 pi (1 - exp(-2k)) / k. Midpoint rule over the height above the glow's middle.
#[test]
fn soft_glows_keep_their_light() {
    let glow = Glow { direction: Vec3::Y, colour: Vec3::ONE, sharpness: 60.0 };
    let sky = Background { glows: vec![glow], ..Background::default() };
    let light = |soft: f32| {
        let steps = 4096;
        let at = |i: usize| {
            let c = 1.0 - (i as f32 + 0.5) * 2.0 / steps as f32;
            Vec3::new(((1.0 - c) * (1.0 + c)).sqrt(), c, 0.0)
        };
        let sum: f64 = (0..steps)
            .step_by(8)
            .map(|i| {
                let rays = Rays8 { origin: V3::ZERO, direction: V3::from_fn(|k| at(i + k)) };
                let (colour, _) = background(&sky, &rays, F::ZERO, splat(soft), F::ZERO);
                colour.x.to_array().iter().map(|&x| f64::from(x)).sum::<f64>()
            })
            .sum();
        sum * 2.0 / steps as f64 * 60.0
    };
    for soft in [0.0, 0.001, 0.02, 0.1] {
        assert!((light(soft) - 1.0).abs() < 1e-3, "{} at {soft}", light(soft));
    }
}
