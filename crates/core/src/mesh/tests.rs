//! A search through the trees finds just what testing every triangle does, bit for bit.

use super::*;
use crate::counters::Counters;
use crate::math::Mat3;
use crate::math::lanes::{F, LANES, TRUE, V3, from_bits, splat};
use crate::math::scalar::sin_cos;
use crate::quality::Quality;
use crate::scene::{Material, Scene, Sphere, Triangle};
use crate::trace::check::{Random, packet, poisoned};
use crate::trace::{Aim, BLOCKED, Crossing, Hits, Rays8, Suspects, nearest, occlusion, surface};
use std::sync::Arc;

const HIGH: &Quality = &Quality::PRESETS[Quality::DEFAULT].1;

/// Triangles of one of several kinds.
fn soup(random: &mut Random, kind: u32) -> Vec<[Vec3; 3]> {
    let mut list = Vec::new();
    match kind % 5 {
        // Loose ones of all sizes.
        0 => {
            for _ in 0..150 {
                let a = random.vector(-3, 3);
                list.push([a, a + random.vector(-6, 2), a + random.vector(-6, 2)]);
            }
        }
        // A level sheet, whose boxes are flat and whose edges rays meet.
        1 => {
            let at = |x: i32, y: i32| Vec3::new(x as f32 * 0.5, 1.0, y as f32 * 0.5);
            for (x, y) in (0..144).map(|i| (i % 12 - 6, i / 12 - 6)) {
                list.push([at(x, y), at(x + 1, y), at(x, y + 1)]);
                list.push([at(x + 1, y + 1), at(x, y + 1), at(x + 1, y)]);
            }
        }
        // Crystals.
        2 => {
            for _ in 0..12 {
                let (a, b) = (random.vector(-2, 3), random.vector(-2, 3));
                let radius = (random.size(-4, 0), if random.one_in(2) { 0.0 } else { 0.3 });
                lathe(&mut list, &[(a, radius.0), (b, radius.1)], 3 + random.bits() as usize % 5, 0.1);
            }
        }
        // The same triangles over and over: ties.
        3 => {
            for i in 0..60 {
                list.push([Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * (1.0 + (i % 3) as f32)));
            }
        }
        // Broken ones among sound ones.
        _ => {
            for i in 0..80 {
                let mut t = [0; 3].map(|_| random.vector(-2, 2));
                match i % 4 {
                    0 => t[2] = t[0],
                    1 => t[2] = t[0] + (t[1] - t[0]) * 0.5,
                    2 => t[i % 3].y = [f32::NAN, f32::INFINITY, 1e9][i % 7 % 3],
                    _ => {}
                }
                list.push(t);
            }
        }
    }
    list
}

/// A rotation, uneven scale and shear.
fn affine(random: &mut Random) -> Mat3 {
    let x = random.direction();
    let (y, z) = x.any_orthonormal_pair();
    let scale = Mat3::from_diagonal([0; 3].map(|_| random.range(0.3, 2.0)).into());
    let mirror = if random.one_in(3) { -x } else { x };
    Mat3::from_cols(mirror, y, z + x * random.range(-0.5, 0.5)) * scale
}

/// Instances of some meshes; the first stands where it was made.
fn scene(random: &mut Random, case: u32) -> Scene {
    let mut instances = Vec::new();
    for i in 0..3 {
        let mesh = Arc::new(Mesh::flat(soup(random, case + i)));
        mesh.validate().unwrap();
        let (m, origin) =
            if i == 0 { (Mat3::IDENTITY, Vec3::ZERO) } else { (affine(random), random.vector(-2, 3)) };
        instances.push(Instance::new(&mesh, m, origin, i as usize % 2));
    }
    let mut scene = Scene { materials: vec![Material::default(); 2], ..Scene::default() };
    // Other shapes before and behind them, or none.
    for _ in 0..case % 3 {
        let (centre, radius) = (random.vector(-2, 3), random.size(-2, 1));
        scene.spheres.push(Sphere { centre, radius, material: 0, blend: 0.0 });
    }
    scene.meshes = Assembly::new(instances);
    scene
}

/// Rays at the middles, edges and corners of triangles and past them, from anywhere; many axis-parallel.
fn rays(random: &mut Random, scene: &Scene) -> Rays8 {
    let instances = scene.meshes.instances();
    let bundle = random.one_in(2);
    let mut last: Option<(Vec3, Vec3)> = None;
    packet(|| {
        if let (true, Some((o, d))) = (bundle, last) {
            let d = d + random.vector(-12, -3);
            return (o + if random.one_in(2) { Vec3::ZERO } else { random.vector(-8, -3) }, d);
        }
        let instance = &instances[random.bits() as usize % instances.len()];
        let list = instance.mesh().triangles();
        let [a, b, c] = list[random.bits() as usize % list.len()];
        let p = match random.bits() % 4 {
            0 => a,
            1 => a + (b - a) * random.range(0.0, 1.0),
            2 => a * 0.5 + b * 0.25 + c * 0.25,
            _ => a + random.vector(-6, 3),
        };
        let p = if p.is_finite() { instance.to_world(p) } else { Vec3::ZERO };
        let d = random.direction();
        let ray = (p - d * if random.one_in(8) { 0.0 } else { random.size(-3, 6) }, d);
        last = Some(ray);
        ray
    })
}

/// What testing every triangle finds.
fn brute_force(scene: &Scene, rays: &Rays8) -> Hits {
    let others = Scene { meshes: Assembly::default(), ..scene.clone() };
    let mut best = nearest(&others, HIGH, rays, u64::MAX, &mut Counters::default());
    let mut id = 4.0 * scene.shape_count() as f32;
    for instance in scene.meshes.instances() {
        let aim = Aim::new(&instance.local(rays));
        for triangle in instance.mesh().triangles() {
            let crossing = aim.cross(&triangle.map(V3::splat)).unwrap_or(Crossing::NONE);
            let closer = crossing.hit & crossing.t.simd_gt(F::ZERO) & crossing.t.simd_lt(best.t);
            best.t = closer.select(crossing.t, best.t);
            best.id = closer.select(splat(id), best.id);
            id += 4.0;
        }
    }
    best
}

#[test]
fn the_trees_find_what_testing_everything_does() {
    let mut random = Random::new(310);
    let (mut hits, mut hidden) = (0, 0);
    for case in 0..250 {
        let scene = scene(&mut random, case);
        // What hid a lamp before is asked first; the answer is the same.
        let suspects = Suspects::new(u64::MAX);
        for _ in 0..500 {
            let rays = rays(&mut random, &scene);
            let want = brute_force(&scene, &rays);
            let mut counters = Counters::default();
            let got = nearest(&scene, HIGH, &rays, u64::MAX, &mut counters);
            // Shadow rays that end somewhere about the hit.
            let ends = Rays8 { direction: rays.direction * splat(random.size(-2, 4)), ..rays };
            let wanted = from_bits(random.bits() as u8);
            let shadow = occlusion(
                &scene,
                HIGH,
                &[0.0; 2][..scene.spheres.len()],
                &ends,
                (wanted, 0.0),
                &suspects,
                &mut counters,
            );
            let truth = brute_force(&scene, &ends).t.simd_lt(splat(1.0 - 4.0 / 16_777_216.0));
            for lane in 0..LANES {
                let (o, d) = (rays.origin.lane(lane), rays.direction.lane(lane));
                let at = |v: F| v.to_array()[lane];
                let replay = || format!("case {case} origin {o:?} direction {d:?}");
                assert_eq!(at(got.t).to_bits(), at(want.t).to_bits(), "{}", replay());
                assert_eq!(at(got.id), at(want.id), "t {} {}", at(want.t), replay());
                hits += u32::from(at(got.id) >= 0.0);
                if at(wanted).to_bits() != 0 {
                    let blocked = at(shadow) == BLOCKED;
                    assert_eq!(
                        blocked,
                        at(truth).to_bits() != 0,
                        "shadow to {:?} {}",
                        ends.direction.lane(lane),
                        replay()
                    );
                    hidden += u32::from(blocked);
                }
            }
        }
    }
    assert!(hits > 300_000 && hidden > 100_000, "{hits} hits, {hidden} hidden");
}

#[test]
fn a_mesh_where_it_was_made_equals_single_triangles() {
    let mut random = Random::new(311);
    for case in 0..40 {
        let mesh = Arc::new(Mesh::flat(soup(&mut random, case)));
        let instance = Instance::new(&mesh, Mat3::IDENTITY, Vec3::ZERO, 0);
        let placed = Scene { meshes: Assembly::new(vec![instance]), ..Scene::default() };
        let triangles = mesh.triangles().iter().map(|&corners| Triangle { corners, material: 0 }).collect();
        let single = Scene { triangles, ..Scene::default() };
        for _ in 0..500 {
            let rays = rays(&mut random, &placed);
            let hits =
                [&placed, &single].map(|s| nearest(s, HIGH, &rays, u64::MAX, &mut Counters::default()));
            assert_eq!((hits[0].t, hits[0].id), (hits[1].t, hits[1].id), "case {case}: {:?}", rays.origin);
        }
    }
}

#[test]
fn a_poisoned_ray_hits_nothing_at_nan_and_leaves_its_neighbours_alone() {
    // In the second two facets are as near as each other, seen from far away.
    for stream in [312, 22_020_408] {
        poisons_rays(&mut Random::new(stream));
    }
}

fn poisons_rays(random: &mut Random) {
    let poison = poisoned();
    for case in 0..40 {
        let scene = scene(random, case);
        for _ in 0..200 {
            let clean = rays(random, &scene);
            let (lane, ray) = (random.bits() as usize % 8, poison[random.bits() as usize % poison.len()]);
            let mut rays = clean;
            rays.origin.set_lane(lane, ray.0);
            rays.direction.set_lane(lane, ray.1);
            let found = |rays: &Rays8| nearest(&scene, HIGH, rays, u64::MAX, &mut Counters::default());
            let (alone, together) = (found(&clean), found(&rays));
            let (t, id) = (together.t.to_array(), together.id.to_array());
            assert!(t[lane] > 0.0 && (t[lane] < f32::INFINITY) == (id[lane] >= 0.0), "{ray:?}");
            for i in (0..8).filter(|&i| i != lane) {
                let (want, id_want) = (alone.t.to_array()[i], alone.id.to_array()[i]);
                assert_eq!((t[i], id[i]), (want, id_want), "case {case}, poisoned by {ray:?} in {lane}");
            }
            occlusion(&scene, HIGH, &[], &rays, (TRUE, 0.0), &Suspects::new(0), &mut Counters::default());
        }
    }
}

#[test]
fn what_lies_in_a_pyramid_is_found() {
    // In all but the first an apex lies on a triangle's edge.
    for stream in [313, 12_601, 41_273] {
        asks_about_pyramids(&mut Random::new(stream));
    }
}

fn asks_about_pyramids(random: &mut Random) {
    let (mut cases, mut empty) = (0, 0);
    for case in 0..400 {
        let scene = scene(random, case);
        let meshes_only = Scene { spheres: vec![], ..scene.clone() };
        let one = rays(random, &scene);
        for lane in 0..LANES {
            let (apex, d) = (one.origin.lane(lane), crate::math::normalize(one.direction.lane(lane)));
            let (u, v) = d.any_orthonormal_pair();
            let half = random.size(-9, -1);
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y): (f32, f32)| d + (u * x + v * y) * half);
            // A plane that ends it, tilted.
            let far = random.size(-2, 7);
            let (a, b) = (random.range(-0.4, 0.4) / half, random.range(-0.4, 0.4) / half);
            let inverse = |c: Vec3| (1.0 + a * u.dot(c) + b * v.dot(c)) / far;
            let ends = corners.map(|c| 1.0 / inverse(c));
            let found = scene.meshes.may_lie_between(apex, corners, ends, &mut Counters::default());
            let mut hit = false;
            for _ in 0..8 {
                let inside = packet(|| {
                    let (x, y) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
                    (apex, d + (u * x + v * y) * half)
                });
                let t = brute_force(&meshes_only, &inside).t;
                hit |= (0..LANES).any(|i| t.to_array()[i] * inverse(inside.direction.lane(i)) < 0.999);
            }
            let replay = format!("case {case} apex {apex:?} corners {corners:?} ends {ends:?}");
            assert!(found || !hit, "a facet is overlooked: {replay}");
            cases += u32::from(hit);
            empty += u32::from(!found);
        }
    }
    assert!(cases > 800 && empty > 200, "{cases} with facets, {empty} found empty");
}

/// A ball of triangles of radius 1, with its true normals at the corners if it is to look round.
fn ball(smooth: bool) -> Arc<Mesh> {
    let ring = |i: usize| {
        let (sin, cos) = sin_cos(i as f32 / 12.0 * std::f32::consts::PI);
        (Vec3::Y * -cos, if i.is_multiple_of(12) { 0.0 } else { sin })
    };
    let mut triangles = Vec::new();
    lathe(&mut triangles, &std::array::from_fn::<_, 13, _>(ring), 24, 0.0);
    let normals = if smooth { triangles.clone() } else { Vec::new() };
    Arc::new(Mesh::smooth(triangles, normals))
}

#[test]
fn facets_know_their_points_normals_and_corners() {
    let mut random = Random::new(315);
    let mut hits = 0;
    for case in 0..200 {
        let (mesh, m, origin) = (ball(case % 2 == 1), affine(&mut random), random.vector(-2, 4));
        let instance = Instance::new(&mesh, m, origin, 0);
        let scene = Scene {
            meshes: Assembly::new(vec![instance.clone()]),
            materials: vec![Material::default()],
            ..Scene::default()
        };
        let rays = packet(|| {
            let d = random.direction();
            (origin + random.vector(-4, 0) - d * random.size(2, 6), d)
        });
        let hits_here = nearest(&scene, HIGH, &rays, u64::MAX, &mut Counters::default());
        let solid = hits_here.id.simd_ge(F::ZERO);
        let (t, id) = (hits_here.t & solid, hits_here.id);
        let s = surface(&scene, HIGH, &rays, t, id, F::ZERO);
        for lane in (0..LANES).filter(|&lane| solid.to_bitmask() >> lane & 1 == 1) {
            hits += 1;
            let at = |v: F| v.to_array()[lane];
            let [a, b, c] = mesh.triangles()[at(id) as usize >> 2];
            let (u, v) = (at(s.uv[0]), at(s.uv[1]));
            let p = a * (1.0 - u - v) + b * u + c * v;
            let point = s.point.lane(lane);
            let o = rays.origin.lane(lane);
            let reach = o.abs().max_element() + origin.abs().max_element() + 8.0;
            let replay = || format!("case {case} {instance:?} ray {o:?} {:?}", rays.direction.lane(lane));
            assert!((instance.to_world(p) - point).length() < 1e-5 * reach, "weights: {}", replay());
            let on_ray = o + rays.direction.lane(lane) * at(t);
            assert!((on_ray - point).length() < 1e-4 * reach, "off the ray: {}", replay());
            // Outwards, across the facet; from outside all of a ball is seen from its front.
            let n = s.outward().lane(lane);
            let [a, b, c] = [a, b, c].map(|p| instance.to_world(p));
            let longest = (b - a).length().max((c - a).length());
            let across = n.dot(b - a).abs().max(n.dot(c - a).abs());
            assert!(across < 1e-3 * longest && (n.length() - 1.0).abs() < 1e-5, "normal: {}", replay());
            assert!(n.dot(point - origin) > 0.0, "inwards: {}", replay());
            if mesh.is_smooth() {
                // A unit ball's normals, by the inverse transposed.
                let want = crate::math::normalize(m.inverse().transpose() * p);
                assert!(s.normal.lane(lane).dot(want) > 0.9999, "not round: {}", replay());
                assert_eq!(at(id).to_bits() ^ at(s.part).to_bits(), 0, "a facet shows: {}", replay());
            } else {
                assert_eq!((s.normal.lane(lane), at(s.part)), (n, 0.0), "not flat: {}", replay());
            }
        }
    }
    assert!(hits > 1_000, "{hits}");
}

#[test]
fn a_mesh_of_glass_is_a_named_warning() {
    let instance = Instance::new(&ball(false), Mat3::IDENTITY, Vec3::ZERO, 0);
    let scene = Scene {
        meshes: Assembly::new(vec![instance]),
        materials: vec![Material { transparency: 1.0, ..Material::default() }],
        ..Scene::default()
    };
    assert_eq!(crate::plan::warnings(&scene, HIGH), ["meshes of glass cast no shadow"]);
}

#[test]
fn a_lathed_body_is_closed_and_faces_outwards() {
    let mut random = Random::new(314);
    for _ in 0..300 {
        let (a, b) = (random.vector(-2, 3), random.vector(-2, 3));
        let sides = 3 + random.bits() as usize % 6;
        let (foot, top) = (random.size(-3, 1), random.size(-3, 1));
        let rings = [(a, 0.0), (a, foot), (b, top), (b + (b - a) * 0.2, 0.0)];
        let mut list = Vec::new();
        lathe(&mut list, &rings, sides, random.range(0.0, 1.0));
        assert_eq!(list.len(), 4 * sides);
        let middle = (a + b) * 0.5;
        let mut edges = std::collections::BTreeMap::new();
        for [p, q, r] in list {
            assert!(crate::math::cross(q - p, r - p).dot(p - middle) > 0.0, "inside out: {a:?} {b:?}");
            for (from, to) in [(p, q), (q, r), (r, p)] {
                let edge = [from, to].map(|p| (p + Vec3::ZERO).to_array().map(f32::to_bits));
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        // Each edge is there once in either direction.
        assert!(
            edges.iter().all(|([from, to], n)| *n == 1 && edges.get(&[*to, *from]) == Some(&1)),
            "{a} {b}"
        );
    }
}
