//! A ray's result doesn't depend on its packet; poisoned rays neither panic nor hit at NaN; what
//! shadow rays meet.

use crate::counters::Counters;
use crate::math::Vec3;
use crate::math::lanes::{F, TRUE, splat as all};
use crate::quality::Quality;
use crate::render::{Stage, Tables};
use crate::scene::{
    Cone, Cylinder, Field, Join, Light, LightKind, Material, Node, Pattern, Plane, Scene, Shading, Sphere,
    Texture, Triangle,
};
use crate::shade::{Visibility, direct, split as split_light};
use crate::trace::check::{Random, packet, poisoned, splat};
use crate::trace::{BLOCKED, NONE, Rays8, Suspects, nearest, occlusion, surface};

const PATTERNS: [Pattern; 4] = [Pattern::Noise, Pattern::Cells, Pattern::Brick, Pattern::Scratches];

/// Some shapes of each kind about the origin, part of them of glass.
fn mixed(random: &mut Random) -> Scene {
    let materials = (0..4)
        .map(|i| Material {
            colour: Vec3::splat(0.5),
            specular: Vec3::splat(0.5),
            exponent: 20.0,
            f0: Vec3::splat(0.04),
            roughness: 0.2,
            transparency: if i & 1 == 0 { 0.0 } else { 0.9 },
            ior: 1.5,
            shadow: Vec3::new(0.9, 0.5, 0.1),
            texture: Texture { pattern: PATTERNS[i], grain: 0.2, bump: 0.02, ..Texture::NONE },
            ..Material::default()
        })
        .collect();
    let mut scene = Scene { materials, ..Scene::default() };
    for material in 0..4 {
        let blend = if material > 1 { 0.3 } else { 0.0 };
        scene.spheres.push(Sphere {
            centre: random.vector(-2, 3),
            radius: random.size(-3, 1),
            material,
            blend,
        });
        let length = if material == 0 { f32::INFINITY } else { random.size(-2, 3) };
        let (base, axis, radius) = (random.vector(-2, 3), random.direction(), random.size(-4, 0));
        scene.cylinders.push(Cylinder { base, axis, radius, length, material });
        let range = [random.range(0.0, 1.0) * (material & 1) as f32, random.range(1.0, 3.0)];
        let caps = [random.one_in(2), random.one_in(2)];
        let (apex, axis, slope) = (random.vector(-2, 3), random.direction(), random.size(-3, 1));
        scene.cones.push(Cone { apex, axis, slope, range, caps, material });
        let corners = [0; 3].map(|_| random.vector(-2, 3));
        scene.triangles.push(Triangle { corners, material });
        let nodes = (0..3).map(|k| {
            let node = if k == 1 {
                Node::cuboid(random.vector(-2, 2), Vec3::new(0.3, 0.5, 0.4), 0.1)
            } else {
                Node::sphere(random.vector(-2, 2), random.size(-3, 0))
            };
            Node { material: (material + k) % 4, ..node.joined(Join::Union, 0.3 * k as f32) }
        });
        scene.fields.push(Field::new(nodes.collect()));
    }
    scene.planes.push(Plane { point: Vec3::NEG_Y * 3.0, normal: Vec3::Y, reach: 20.0, material: 0 });
    scene.lights.push(Light {
        position: Vec3::new(3.0, 5.0, -2.0),
        colour: Vec3::splat(30.0),
        kind: LightKind::Point,
    });
    let direction = Vec3::new(0.6, -0.8, 0.0);
    let kind = LightKind::Spot { direction, inner: 0.9, outer: 0.5 };
    scene.lights.push(Light { position: Vec3::new(-4.0, 5.0, 0.0), colour: Vec3::splat(20.0), kind });
    scene
}

/// Everything found for a packet, as bits per lane.
fn found(stage: &Stage, rays: &Rays8) -> Vec<[u32; 8]> {
    let scene = stage.scene;
    let counters = &mut Counters::default();
    let hits = nearest(scene, &Quality::PRESETS[3].1, rays, u64::MAX, counters);
    let solid = hits.id.simd_ge(F::ZERO);
    let quality = &Quality::PRESETS[3].1;
    let suspects = &Suspects::new(u64::MAX);
    let shadow = occlusion(scene, quality, stage.bits, rays, (TRUE, 0.0), suspects, counters);
    let s = surface(
        scene,
        &Quality::PRESETS[3].1,
        rays,
        solid.select(hits.t, F::ZERO),
        solid.select(hits.id, all(NONE)),
        all(0.01),
    );
    let view = -rays.direction;
    let mut codes = [F::ZERO; 8];
    let trace = Visibility::Trace(&[u64::MAX; 8].map(Suspects::new));
    let lit = direct(stage, &s, view, solid, trace, &mut codes, counters);
    let light = split_light(scene.shading, &s, rays.direction);
    let mut values = vec![hits.t, hits.id, shadow];
    let vectors = [
        s.point,
        s.normal,
        s.outward(),
        light.reflectance,
        light.mirrored,
        light.refracted,
        lit.irradiance,
        lit.highlight,
    ];
    let of_surface = vectors.into_iter().flat_map(|v| [v.x, v.y, v.z]).chain(s.material).chain(codes);
    values.extend(of_surface.chain([s.clearance, s.inside, s.node, s.part, light.total]).map(|v| v & solid));
    let bits = |v: f32| if v.is_nan() { u32::MAX } else { v.to_bits() };
    values.into_iter().map(|v| v.to_array().map(bits)).collect()
}

#[test]
fn a_lane_equals_the_same_ray_in_all_lanes() {
    let mut random = Random::new(200);
    let quality = Quality::named("high").unwrap();
    let (mut hits, poison) = (0, poisoned());
    for case in 0..1_500 {
        let mut scene = mixed(&mut random);
        scene.shading = [Shading::Phong, Shading::CookTorrance, Shading::Ggx][case as usize % 3];
        let tables = &mut Tables::default();
        let stage = Stage::new(&scene, &quality, [64, 36], tables);
        let rays = packet(|| {
            if random.one_in(16) {
                return poison[random.bits() as usize % poison.len()];
            }
            let target = random.vector(-3, 3);
            let d = random.direction();
            (target - d * random.size(-2, 5), d)
        });
        let together = found(&stage, &rays);
        for lane in 0..8 {
            let alone = found(&stage, &splat(&rays, lane));
            hits += u32::from(alone[1][0] >> 31 == 0);
            // Overflow in a poisoned ray may differ, but must not reach its neighbours.
            let (o, d) = (rays.origin.lane(lane), rays.direction.lane(lane));
            if !((1e-30..1e30).contains(&d.length_squared()) && o.length_squared() < 1e30) {
                continue;
            }
            for (i, (a, b)) in together.iter().zip(&alone).enumerate() {
                assert_eq!(a[lane], b[0], "value {i} of lane {lane}: {scene:?} origin {o:?} direction {d:?}");
            }
        }
    }
    assert!(hits > 5_000, "{hits}");
}

#[test]
fn poisoned_rays_neither_panic_nor_hit_at_nan() {
    let mut random = Random::new(201);
    for _ in 0..50 {
        let scene = mixed(&mut random);
        let tables = &mut Tables::default();
        let stage = Stage::new(&scene, &Quality::named("high").unwrap(), [64, 36], tables);
        for eight in poisoned().chunks_exact(8) {
            let mut next = eight.iter();
            let rays = packet(|| *next.next().unwrap());
            let hits = nearest(&scene, &Quality::PRESETS[3].1, &rays, u64::MAX, &mut Counters::default());
            for (lane, ray) in eight.iter().enumerate() {
                let (t, id) = (hits.t.to_array()[lane], hits.id.to_array()[lane]);
                let replay = || format!("{scene:?} {ray:?}");
                assert!(t > 0.0 && (t < f32::INFINITY) == (id >= 0.0), "{t} {id} {}", replay());
            }
            let code = shadow(&stage, &rays);
            assert!(code.simd_ge(all(BLOCKED)).all(), "{code:?} {eight:?}");
            found(&stage, &rays);
        }
    }
}

/// Visibility codes of a lamp at the rays' ends, with hard shadows.
fn shadow(stage: &Stage, rays: &Rays8) -> F {
    let mut counters = Counters::default();
    let suspects = Suspects::new(u64::MAX);
    occlusion(stage.scene, &stage.quality, stage.bits, rays, (TRUE, 0.0), &suspects, &mut counters)
}

/// A row of balls along z at 2, 4, 6, …, of glass where asked, and the lamp at `lamp`.
fn row(glass: &[bool], lamp: f32) -> f32 {
    let ball = |i: usize| {
        let centre = Vec3::Z * (2.0 * i as f32 + 2.0);
        Sphere { centre, radius: 0.5, material: usize::from(glass[i]), blend: 0.0 }
    };
    let clear = Material { transparency: 1.0, ..Material::default() };
    let scene = Scene {
        spheres: (0..glass.len()).map(ball).collect(),
        materials: vec![Material::default(), clear],
        ..Scene::default()
    };
    let tables = &mut Tables::default();
    let stage = Stage::new(&scene, &Quality::named("high").unwrap(), [8, 8], tables);
    let rays = packet(|| (Vec3::ZERO, Vec3::Z * lamp));
    shadow(&stage, &rays).to_array()[3]
}

#[test]
fn glass_colours_and_opaque_blocks_in_any_order() {
    assert_eq!(row(&[], 10.0), 0.0);
    assert_eq!(row(&[true, true], 10.0), 3.0);
    assert_eq!(row(&[true, true], 3.0), 1.0, "the second lies behind the lamp");
    assert_eq!(row(&[true, true], 4.0), 3.0, "the lamp is in the second");
    for glass in [[false, true, true], [true, false, true], [true, true, false]] {
        assert_eq!(row(&glass, 10.0), BLOCKED);
    }
    assert_eq!(row(&[true, false], 3.0), 1.0, "the opaque one lies behind the lamp");
    assert_eq!(row(&[false], 2.0), BLOCKED, "the lamp is inside");
    assert_eq!(row(&[false], 1.4), 0.0);
}

#[test]
fn what_the_lamp_sits_on_does_not_hide_it() {
    let mut random = Random::new(202);
    for _ in 0..20_000 {
        let (n, lamp) = (random.direction(), random.vector(-4, 8));
        let wall = Plane { point: lamp, normal: n, reach: f32::INFINITY, material: 0 };
        let scene = Scene { planes: vec![wall], materials: vec![Material::default()], ..Scene::default() };
        let rays = packet(|| {
            let up = random.direction();
            let up = if up.dot(n) < 0.0 { -up } else { up };
            let o = lamp + (up + n * 0.5) * random.size(-4, 8);
            (o, lamp - o)
        });
        let code = occlusion(
            &scene,
            &Quality::PRESETS[3].1,
            &[0.0],
            &rays,
            (TRUE, 0.0),
            &Suspects::new(u64::MAX),
            &mut Counters::default(),
        );
        assert_eq!(code, F::ZERO, "{scene:?} {:?} {:?}", rays.origin, rays.direction);
    }
}
