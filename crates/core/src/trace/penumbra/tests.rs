//! Shadows by the field against those of a shining square that is drawn by very many rays.

use super::*;
use crate::math::Vec3;
use crate::render::{Stage, Tables};
use crate::scene::{Emitter, Join, Material, Node, Scene};
use crate::shade::{MAX_LAMPS, Visibility, direct};
use crate::trace::Suspects;
use crate::trace::check::{self, Random};
use std::f32::consts::PI;

const HIGH: Quality = Quality::PRESETS[Quality::DEFAULT].1;

/// Bodies over a floor at 0, under a lamp at 6.
fn bodies() -> Vec<(&'static str, Vec<Node>)> {
    let up = |y: f32| Vec3::Y * y;
    vec![
        ("ball", vec![Node::sphere(up(1.6), 0.7)]),
        ("box", vec![Node::cuboid(up(1.2), Vec3::new(0.8, 0.3, 0.5), 0.0)]),
        ("rounded box", vec![Node::cuboid(up(2.0), Vec3::new(0.6, 0.6, 0.6), 0.2)]),
        ("cylinder", vec![Node::cylinder(up(1.0), 0.6, 0.7)]),
        ("ring", vec![Node::torus(up(1.5), 0.9, 0.4)]),
        (
            "two that are one",
            vec![
                Node::sphere(Vec3::new(-0.5, 1.5, 0.0), 0.5),
                Node::sphere(Vec3::new(0.5, 1.7, 0.2), 0.6).joined(Join::Union, 0.5),
            ],
        ),
        ("rough ball", vec![Node::sphere(up(1.6), 0.7), Node::swell(0.03, 9.0)]),
    ]
}

/// The field in the light of a square whose area is that of a disc with this radius.
fn scene(nodes: Vec<Node>, radius: f32) -> Scene {
    let side = radius * PI.sqrt();
    let mut field = Field::new(nodes);
    // Room for the swell.
    (field.lo, field.hi) = (field.lo - 0.1, field.hi + 0.1);
    Scene {
        fields: vec![field],
        emitters: vec![Emitter::facing(
            Vec3::new(0.7, 6.0, 0.3),
            Vec3::new(0.7, 0.0, 0.3),
            side,
            side,
            Vec3::ONE,
        )],
        materials: vec![Material::default()],
        ..Scene::default()
    }
}

/// Share of the lamp's light that comes to places of the floor along x.
fn shares(scene: &Scene, quality: &Quality) -> Vec<f32> {
    let lit = |scene: &Scene| -> Vec<f32> {
        let tables = &mut Tables::default();
        let stage = Stage::new(scene, quality, [8, 8], tables);
        let up = V3::splat(Vec3::Y);
        let place = |k: usize| Vec3::new((k as f32 - 120.0) * 0.025, 0.0, 0.1);
        let eight = |k: usize| {
            let point = V3::from_fn(|lane| place(8 * k + lane));
            let matt = check::surface(Material::default(), up, up, F::ZERO);
            let matt = crate::trace::Surface { point, clearance: splat(1e-3), ..matt };
            let (mut codes, mut counters) = ([F::ZERO; MAX_LAMPS], Counters::default());
            let all = Visibility::Trace(&[u64::MAX; MAX_LAMPS].map(Suspects::new));
            direct(&stage, &matt, up, TRUE, all, &mut codes, &mut counters).irradiance.x.to_array()
        };
        (0..30).flat_map(eight).collect()
    };
    let bare = lit(&Scene { fields: vec![], ..scene.clone() });
    lit(scene).iter().zip(bare).map(|(a, b)| a / b).collect()
}

fn errors(a: &[f32], b: &[f32]) -> (f32, f32) {
    let off = || a.iter().zip(b).map(|(a, b)| (a - b).abs());
    (off().sum::<f32>() / a.len() as f32, off().fold(0.0, f32::max))
}

#[test]
fn the_fields_penumbra_is_about_that_of_a_sampled_lamp() {
    for (name, nodes) in bodies() {
        for radius in [0.1, 0.3, 0.6] {
            let bare = scene(nodes.clone(), radius);
            let many = Quality { shadow_samples: 1024, ..HIGH };
            let truth = shares(&Scene { soft: true, ..bare.clone() }, &many);
            let found = shares(&Scene { penumbra: radius, ..bare.clone() }, &HIGH);
            let hard = shares(&bare, &HIGH);
            let ((mean, most), (mean_hard, _)) = (errors(&found, &truth), errors(&hard, &truth));
            let told = format!("{name}, radius {radius}: mean {mean}, most {most}, hard {mean_hard}");
            assert!(mean < 0.015 && mean < 0.65 * mean_hard && most < 0.3, "{told}");
        }
    }
}

#[test]
fn the_shadow_of_a_point_is_hard_and_softens_with_the_radius() {
    for (name, nodes) in bodies() {
        let hard = shares(&scene(nodes.clone(), 0.1), &HIGH);
        let mut soft = Vec::new();
        for radius in [1e-3, 0.1, 0.3, 0.6] {
            let found = shares(&Scene { penumbra: radius, ..scene(nodes.clone(), 0.1) }, &HIGH);
            assert!(found.iter().all(|share| (0.0..=1.0).contains(share)), "{name}, radius {radius}");
            soft.push(found.iter().filter(|share| (0.02..0.98).contains(*share)).count());
            let off = found.iter().zip(&hard).filter(|(a, b)| (*a - *b).abs() > 0.02).count();
            assert!(radius > 1e-3 || off <= 4, "{name}: {off} places differ from a hard shadow");
        }
        assert!(soft.is_sorted() && soft[3] > 3 * soft[1].min(9), "{name}: places in the penumbra: {soft:?}");
    }
}

#[test]
fn a_lane_is_as_alone_and_odd_rays_give_shares() {
    let mut random = Random::new(731);
    for case in 0..300 {
        let (_, nodes) = bodies().swap_remove(case % 7);
        let field = Field::new(nodes);
        let radius = random.size(-6, 1);
        let eight: [(Vec3, Vec3); 8] = std::array::from_fn(|i| {
            let o = random.vector(-3, 2);
            match i {
                6 => (o, Vec3::new(0.0, -0.0, random.range(-9.0, 9.0))),
                7 => (Vec3::Y * 1.5, random.vector(-9, 30)),
                _ => (o, random.vector(-1, 4)),
            }
        });
        let rays = Rays8 { origin: V3::from_fn(|i| eight[i].0), direction: V3::from_fn(|i| eight[i].1) };
        let share = |rays: &Rays8| penumbra(rays, &field, radius, &HIGH, TRUE, &mut Counters::default());
        let all = share(&rays);
        for (lane, ray) in eight.iter().enumerate() {
            let one = share(&rays.alone(1 << lane));
            let (a, b) = (all.to_array()[lane], one.to_array()[0]);
            assert!(a == b && (0.0..=1.0).contains(&a), "case {case} lane {lane}: {a} {b} {ray:?}");
        }
    }
}
