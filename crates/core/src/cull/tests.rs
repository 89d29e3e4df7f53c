//! Culling never loses what counts: a shape is in its bound wherever a ray hits it, and among the
//! candidates wherever it casts a shadow.
//!
//! Truth is the tracing kernels themselves, on single shapes. A failure prints shape, view and ray.

use super::dop::nearest_in_cone;
use super::*;
use crate::counters::Counters;
use crate::math::Vec3;
use crate::math::lanes::{F, V3};
use crate::quality::Quality;
use crate::scene::{
    Cone, Cylinder, Field, Join, Light, LightKind, Material, Node, Plane, Scene, Sphere, Triangle,
};
use crate::shade::lamps;
use crate::trace::check::{Random, packet};
use crate::trace::{Rays8, nearest, surface};
use glam::Vec2;

const KINDS: [&str; 8] =
    ["sphere", "plane", "cylinder", "infinite cylinder", "cone", "infinite cone", "triangle", "field"];

/// A scene with one shape of a kind within a few units of the origin.
fn one(random: &mut Random, kind: usize) -> Scene {
    let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
    let (at, axis) = (random.vector(-3, 3), random.direction());
    match kind {
        0 => scene.spheres.push(Sphere { centre: at, radius: random.size(-6, 2), material: 0, blend: 0.0 }),
        1 => scene.planes.push(Plane { point: at, normal: axis, reach: random.size(0, 6), material: 0 }),
        2 | 3 => {
            let length = if kind == 3 { f32::INFINITY } else { random.size(-4, 4) };
            scene.cylinders.push(Cylinder {
                base: at,
                axis,
                radius: random.size(-7, 1),
                length,
                material: 0,
            });
        }
        4 | 5 => {
            let to = random.size(-3, 3);
            let from = if random.one_in(2) { 0.0 } else { to * random.range(0.0, 0.9) };
            let range = [from, if kind == 5 { f32::INFINITY } else { to }];
            let caps = [random.one_in(2), random.one_in(2)];
            scene.cones.push(Cone { apex: at, axis, slope: random.size(-5, 2), range, caps, material: 0 });
        }
        7 => {
            let size = random.size(-4, 1);
            let beside = at + axis * size;
            scene.fields.push(Field::new(vec![
                Node::sphere(at, size),
                Node::cuboid(beside, Vec3::splat(size), 0.2 * size).joined(Join::Union, 0.5 * size),
            ]));
        }
        _ => {
            let corners = [at, at + random.vector(-4, 2), at + random.vector(-4, 2)];
            scene.triangles.push(Triangle { corners, material: 0 });
        }
    }
    scene
}

/// A point on or just beside the shape.
fn point(random: &mut Random, scene: &Scene) -> Vec3 {
    let about = |random: &mut Random, base: Vec3, axis: Vec3, length: f32, radius: &dyn Fn(f32) -> f32| {
        let any = random.direction();
        let out = (any - axis * any.dot(axis)).normalize_or(axis.any_orthogonal_vector());
        let height = if random.one_in(3) { length } else { length * random.range(0.0, 1.0) };
        base + axis * height + out * (radius(height) * (1.0 - random.size(-20, 0)))
    };
    if let Some(s) = scene.spheres.first() {
        return s.centre + random.direction() * (s.radius * (1.0 - random.size(-20, 0)));
    }
    if let Some(s) = scene.planes.first() {
        let any = random.direction();
        return s.point + (any - s.normal * any.dot(s.normal)) * s.reach;
    }
    if let Some(s) = scene.cylinders.first() {
        let length = if s.length < f32::INFINITY { s.length } else { random.signed(-4, 10) };
        return about(random, s.base, s.axis, length, &|_| s.radius);
    }
    if let Some(s) = scene.cones.first() {
        let [from, to] = s.range;
        let end = if to < f32::INFINITY { to } else { from + random.size(-4, 8) };
        return about(random, s.apex + s.axis * from, s.axis, end - from, &|h| s.slope * (h + from));
    }
    if let Some(s) = scene.fields.first() {
        return s.nodes[0].centre + random.direction() * s.nodes[0].rounding * random.range(0.9, 1.3);
    }
    let [a, b, c] = scene.triangles[0].corners;
    let (mut x, mut y) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
    if x + y > 1.0 {
        (x, y) = (1.0 - x, 1.0 - y);
    }
    let x = if random.one_in(4) { random.size(-20, 0) } else { x };
    a + (b - a) * x + (c - a) * y.min(1.0 - x)
}

fn hits(scene: &Scene, rays: &Rays8) -> (F, F) {
    let hits = nearest(scene, &Quality::PRESETS[3].1, rays, u64::MAX, &mut Counters::default());
    (hits.t, hits.id)
}

/// Rays of a picture up to 53° off its middle.
const WIDEST: f32 = 1.333;

#[test]
fn rays_that_hit_a_shape_are_in_its_bound() {
    for (kind, name) in KINDS.into_iter().enumerate() {
        let mut random = Random::new(700 + kind as u32);
        let (mut seen, mut culled, mut bounds) = (0, 0, vec![]);
        for _ in 0..40_000 {
            let scene = one(&mut random, kind);
            let eye = random.vector(-2, 5);
            let target = point(&mut random, &scene) + random.direction() * random.range(0.0, 3.0);
            let view = View::towards(eye, target);
            dops(&scene, &view, &mut bounds);
            let dop = bounds[0];
            let rays = packet(|| {
                let to = point(&mut random, &scene);
                (eye, (to - eye).normalize_or(Vec3::X))
            });
            let (t, id) = hits(&scene, &rays);
            for lane in 0..8 {
                let d = rays.direction.lane(lane);
                let p = view.world_from_view.transpose() * d;
                let on_screen = p.truncate() / p.z;
                if id.to_array()[lane] < 0.0 || p.z <= 0.0 || on_screen.length() > WIDEST {
                    continue;
                }
                seen += 1;
                let t = t.to_array()[lane];
                let replay =
                    || format!("{name}: {scene:?} {view:?} {dop:?} direction {d:?} at {on_screen} t {t:?}");
                // A pixel of a picture 8192 wide.
                assert!(dop.meets_rectangle(on_screen, Vec2::splat(1e-4)), "lost {}", replay());
                assert!(dop.near <= t * p.z * 1.000_01 + 1e-6 * eye.length(), "nearer {}", replay());
                let aside = Vec2::new(random.range(-2.0, 2.0), random.range(-2.0, 2.0));
                culled += u32::from(!dop.meets_rectangle(aside, Vec2::splat(1e-3)));
            }
        }
        println!("bounds, {name}: {seen} rays hit, {culled} places culled");
        assert!(seen >= 100_000, "{name}: {seen}");
        assert!(culled > seen / 10 || [1, 5].contains(&kind), "{name}: culls {culled} of {seen}");
    }
}

#[test]
fn shapes_that_cast_a_shadow_are_among_the_candidates() {
    for (kind, name) in KINDS.into_iter().enumerate() {
        let mut random = Random::new(800 + kind as u32);
        let (mut shadowed, mut culled) = (0, 0);
        let (mut sources, mut shaft) = (vec![], vec![]);
        for case in 0..60_000 {
            let mut scene = one(&mut random, kind);
            let position = random.vector(-2, 5);
            scene.lights.push(Light { position, colour: Vec3::ONE, kind: LightKind::Point });
            lamps(&scene, &mut sources);
            shafts(&scene, &sources[..1], &mut shaft);
            // Points behind the shape, in a small region: a patch or a ball.
            let behind = point(&mut random, &scene);
            let hub = position + (behind - position) * (1.0 + random.size(-10, 4));
            let size = random.size(-10, 1);
            let corners = [0; 4].map(|_| hub + random.direction() * size);
            let weights = [0; 8].map(|_| {
                let w = [0; 4].map(|_| random.range(0.0, 1.0));
                w.map(|x| x / w.iter().sum::<f32>())
            });
            let mut lane = 0;
            let rays = packet(|| {
                let p = (0..4).fold(Vec3::ZERO, |p, k| p + corners[k] * weights[lane][k]);
                lane += 1;
                (p, position - p)
            });
            let (t, id) = hits(&scene, &rays);
            let slack = 4e-6 * (hub.length() + size + position.length());
            let region =
                if case & 1 == 0 { Region::patch(&corners, slack) } else { Region::ball(hub, size + slack) };
            let kept = occluders(&scene, &shaft, 1, None, &region) & 1 == 1;
            culled += u32::from(!kept);
            for lane in 0..8 {
                let t = t.to_array()[lane];
                if id.to_array()[lane] < 0.0 || t >= 1.0 - 1e-6 {
                    continue;
                }
                shadowed += 1;
                let replay =
                    || format!("{name}: {scene:?} {corners:?} hub {hub:?} size {size:?} ball {}", case & 1);
                assert!(kept, "lost at {t:?} from {:?}: {}", rays.origin.lane(lane), replay());
            }
        }
        println!("shafts, {name}: {shadowed} points in shadow, {culled} of 60000 regions culled");
        assert!(shadowed >= 100_000, "{name}: {shadowed}");
    }
}

/// A convex shape may be left out of the candidates of its own points: none on its lit side is in
/// its shadow.
#[test]
fn lit_points_are_not_in_the_shadow_of_their_own_ball() {
    let mut random = Random::new(900);
    for _ in 0..20_000 {
        let scene = one(&mut random, 0);
        let lamp = random.vector(-2, 5);
        let rays = packet(|| {
            let o = random.vector(-1, 6);
            (o, (point(&mut random, &scene) - o).normalize_or(Vec3::X))
        });
        let (t, id) = hits(&scene, &rays);
        let solid = id.simd_ge(F::ZERO);
        let s = surface(&scene, &Quality::PRESETS[3].1, &rays, solid.select(t, F::ZERO), id, F::ZERO);
        let start = s.point + s.outward() * s.clearance;
        let to_lamp = V3::splat(lamp) - start;
        let lit = solid & !s.inside & s.outward().dot(to_lamp.normalize()).simd_gt(F::splat(1e-6));
        let (t, id) = hits(&scene, &Rays8 { origin: start, direction: to_lamp });
        let wrong = lit & id.simd_ge(F::ZERO) & t.simd_lt(F::ONE);
        assert!(!wrong.any(), "{scene:?} lamp {lamp:?} {:?} {:?}", rays.origin, rays.direction);
    }
}

#[test]
fn the_nearest_distance_in_a_cone_is_a_lower_bound() {
    let mut random = Random::new(901);
    let mut hit = 0;
    for _ in 0..80_000 {
        let (c, r) = (random.vector(-3, 6), random.size(-5, 3));
        let e = random.direction();
        let reach = random.size(-12, 0);
        let scene = Scene {
            spheres: vec![Sphere { centre: c, radius: r, material: 0, blend: 0.0 }],
            materials: vec![Material::default()],
            ..Scene::default()
        };
        if c.length() <= r {
            continue;
        }
        let e = if random.one_in(4) {
            e
        } else {
            crate::math::normalize(crate::math::normalize(c) + e * (reach + r / c.length()))
        };
        let least = nearest_in_cone(c, r, e, reach);
        let rays = packet(|| {
            let any = random.direction();
            let side = (any - e * any.dot(e)).normalize_or(e.any_orthogonal_vector());
            let sine = reach.min(1.0) * random.range(0.0, 1.0);
            (Vec3::ZERO, crate::math::normalize(e * ((1.0 - sine) * (1.0 + sine)).sqrt() + side * sine))
        });
        let (t, id) = hits(&scene, &rays);
        for lane in 0..8 {
            if id.to_array()[lane] >= 0.0 {
                hit += 1;
                let t = t.to_array()[lane];
                let replay = (scene.spheres[0], e, reach, rays.direction.lane(lane));
                let rounding = 4e-6 * (c.length() + r);
                assert!(least <= t + rounding, "{least} over {t}: {replay:?}");
            }
        }
    }
    assert!(hit > 100_000, "{hit}");
}
