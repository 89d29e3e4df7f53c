//! Culling small lights leaves out only what adds nothing.

use super::*;
use crate::math::lanes::{FALSE, TRUE};
use crate::trace::check::Random;

const SIZE: [u32; 2] = [320, 180];

/// A view, a pixel's width in it, and lights around what it shows.
fn setting(random: &mut Random, count: usize) -> (View, f32, Vec<PointLight>) {
    let eye = random.vector(-2, 4);
    let view = View::towards(eye, eye + random.direction());
    let pixel = 2.0 * random.range(0.2, 1.5) / SIZE[0] as f32;
    let lights = (0..count)
        .map(|_| PointLight {
            position: eye + random.direction() * random.size(-3, 6),
            radius: random.size(-4, 4),
            colour: Vec3::ONE,
        })
        .collect();
    (view, pixel, lights)
}

#[test]
fn every_light_that_reaches_a_point_is_near_it() {
    let mut random = Random::new(900);
    let (mut reached, mut called, mut asked) = (0, 0, 0);
    for round in 0..3000 {
        let count = 1 + random.bits() as usize % MAX_POINTS;
        let (view, pixel, lights) = setting(&mut random, count);
        let side = [1, 4, 16, 64, 1000][round % 5];
        let mut points = Points::default();
        points.set(&lights, view, SIZE, pixel, side);
        // Points in and just at the edge of some light's ball, which may lie close together.
        let spread = random.size(-8, 3);
        let light = lights[random.bits() as usize % count];
        let middle = light.position + random.direction() * light.radius * random.range(0.0, 1.1);
        let eight = V3::from_fn(|_| middle + random.direction() * spread);
        let active = crate::math::lanes::from_bits(random.bits() as u8);
        let mut near = Vec::new();
        points.near(eight, active, true, |i| near.push(i));
        assert!(near.windows(2).all(|pair| pair[0] < pair[1]), "round {round}: not ascending");
        let mut all = Vec::new();
        points.near(eight, active, false, |i| all.push(i));
        for (i, light) in lights.iter().enumerate() {
            let to = V3::splat(light.position) - eight;
            let reaches = active & to.dot(to).simd_lt(splat(light.radius * light.radius));
            assert!(!reaches.any() || near.contains(&i), "round {round}: light {i} of {count} is missing");
            assert!(!active.any() || all.contains(&i), "round {round}: light {i} left out without culling");
            reached += usize::from(reaches.any());
        }
        called += near.len();
        asked += count;
    }
    assert!(reached > 10_000 && called < 4 * reached && called < asked / 4, "{reached} {called} {asked}");
}

#[test]
fn no_lane_no_light() {
    let mut random = Random::new(901);
    let (view, pixel, lights) = setting(&mut random, 100);
    let mut points = Points::default();
    points.set(&lights, view, SIZE, pixel, 16);
    points.near(V3::ZERO, FALSE, true, |i| panic!("light {i} for no point"));
    // Points that are no numbers get whatever lights, but do no harm.
    points.near(V3::splat(Vec3::NAN), TRUE, true, |_| ());
}

#[test]
fn a_tile_counts_the_lights_that_reach_into_it() {
    let mut random = Random::new(902);
    for _ in 0..200 {
        let (view, pixel, lights) = setting(&mut random, 60);
        let mut points = Points::default();
        points.set(&lights, view, SIZE, pixel, 16);
        for _ in 0..20 {
            let (x, y) = (random.range(0.0, 320.0), random.range(0.0, 180.0));
            let (x, y) = ((x - 160.0) * pixel, (y - 90.0) * pixel);
            let mask = points.tile(x, y).expect("inside the picture");
            for (i, light) in lights.iter().enumerate() {
                // A light that the ray through this point meets reaches into its tile.
                let d = view.world_from_view * crate::math::normalize(Vec3::new(x, -y, 1.0));
                let v = light.position - view.origin;
                let meets = v.dot(d) > 0.0 && (v - d * v.dot(d)).length() < light.radius * 0.999;
                assert!(!meets || mask[i / 64] >> (i % 64) & 1 == 1, "light {i} at ({x}, {y})");
            }
        }
        let out = 0.51 * SIZE[0] as f32 * pixel;
        assert!(points.tile(-out, 0.0).is_none() && points.tile(0.0, -out).is_none());
    }
}
