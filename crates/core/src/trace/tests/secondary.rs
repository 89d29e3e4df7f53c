//! Rays that go on from a surface: put back onto it, none hits the convex shape it leaves, and
//! one that enters a body finds its way out.
//!
//! Left out are directions within 16 u of the surface, whose side f32 can't tell, and hits nearer
//! to a rim than the clearance, where two surfaces meet.

use crate::counters::Counters;
use crate::math::lanes::{F, V3, splat};
use crate::math::{Mat3, Vec3};
use crate::mesh::{Assembly, Instance, Mesh};
use crate::quality::Quality;
use crate::scene::Shading;
use crate::scene::{Channel, Cone, Cylinder, Material, Plane, Scene, Sphere, Triangle};
use crate::shade::split;
use crate::trace::check::{Random, U, packet};
use crate::trace::{NONE, Rays8, Surface, nearest, surface};
use glam::DVec3;
use std::sync::Arc;

/// Kinds of shapes under test; cones leave again only outwards.
const KINDS: [&str; 6] = ["sphere", "plane", "cylinder", "cone", "triangle", "facet"];

/// A scene with one shape of a kind, of glass, about as large as `r`, somewhere within `far`.
fn one(random: &mut Random, kind: usize, r: f32, far: f32) -> Scene {
    let at = random.direction() * random.range(0.0, far);
    let axis = random.direction();
    let glass = Material { transparency: 1.0, ior: random.range(1.05, 2.5), ..Material::default() };
    let mut scene = Scene { materials: vec![glass], ..Scene::default() };
    match kind {
        0 => scene.spheres.push(Sphere { centre: at, radius: r, material: 0, blend: 0.0 }),
        1 => scene.planes.push(Plane { point: at, normal: axis, reach: f32::INFINITY, material: 0 }),
        2 => {
            let length = r * random.size(-3, 6);
            scene.cylinders.push(Cylinder { base: at, axis, radius: r, length, material: 0 });
        }
        3 => {
            let slope = random.size(-3, 2);
            let range = [r * if random.one_in(2) { 0.0 } else { 0.5 }, r];
            scene.cones.push(Cone { apex: at, axis, slope, range, caps: [true; 2], material: 0 });
        }
        4 => {
            let corners = [at, at + random.direction() * r, at + random.direction() * r];
            scene.triangles.push(Triangle { corners, material: 0 });
        }
        _ => {
            // Made about the origin, stretched, turned and put somewhere else.
            let (u, v) = axis.any_orthonormal_pair();
            let [x, y, z] = [axis, u, v].map(|axis| axis * (r * random.size(-3, 1)));
            let mesh = Arc::new(Mesh::flat(vec![[0; 3].map(|_| random.direction())]));
            let instance = Instance::new(&mesh, Mat3::from_cols(x, y, z), at, 0);
            scene.meshes = Assembly::new(vec![instance]);
        }
    }
    scene
}

/// Corners of a scene's only triangle or facet, world.
fn corners(scene: &Scene) -> [Vec3; 3] {
    match scene.meshes.instances() {
        [] => scene.triangles[0].corners,
        [instance, ..] => instance.mesh().triangles()[0].map(|p| instance.to_world(p)),
    }
}

/// Rays at the shape from up to `far`, through points within it or on it.
fn aim(random: &mut Random, scene: &Scene, r: f32, far: f32) -> Rays8 {
    let (at, axis, length) = match scene {
        Scene { spheres, .. } if !spheres.is_empty() => (spheres[0].centre, Vec3::Y, 0.0),
        Scene { planes, .. } if !planes.is_empty() => (planes[0].point, Vec3::Y, 0.0),
        Scene { cylinders: c, .. } if !c.is_empty() => (c[0].base, c[0].axis, c[0].length),
        Scene { cones: c, .. } if !c.is_empty() => (c[0].apex, c[0].axis, r),
        _ => {
            let [a, b, c] = corners(scene);
            (a * 0.4 + b * 0.3 + c * 0.3, Vec3::Y, 0.0)
        }
    };
    packet(|| {
        let target =
            at + axis * (length * random.range(0.0, 1.0)) + random.direction() * (r * random.range(0.0, 1.0));
        let d = random.direction();
        let back = r * random.size(0, 13).min(far / r);
        (target - d * back, d)
    })
}

/// True outward normals of a scene's only shape at the points of a surface, part by part.
fn true_normal(scene: &Scene, s: &Surface, part: u32, lane: usize) -> DVec3 {
    let p = s.point.lane(lane).as_dvec3();
    let about = |reference: Vec3, axis: Vec3, k: f64| {
        let a = axis.as_dvec3().normalize();
        match part {
            1 => -a,
            2 => a,
            _ => {
                let f = p - reference.as_dvec3();
                ((f - a * f.dot(a)).normalize() - a * k).normalize()
            }
        }
    };
    match scene {
        Scene { spheres, .. } if !spheres.is_empty() => (p - spheres[0].centre.as_dvec3()).normalize(),
        Scene { planes, .. } if !planes.is_empty() => planes[0].normal.as_dvec3(),
        Scene { cylinders: c, .. } if !c.is_empty() => about(c[0].base, c[0].axis, 0.0),
        Scene { cones: c, .. } if !c.is_empty() => about(c[0].apex, c[0].axis, f64::from(c[0].slope)),
        _ => {
            let [a, b, c] = corners(scene).map(Vec3::as_dvec3);
            (b - a).cross(c - a).normalize()
        }
    }
}

/// The first hits, as shading finds them.
fn hit(scene: &Scene, rays: &Rays8) -> (F, F, Surface) {
    let hits = nearest(scene, &Quality::PRESETS[3].1, rays, u64::MAX, &mut Counters::default());
    let solid = hits.id.simd_ge(F::ZERO);
    let s = surface(
        scene,
        &Quality::PRESETS[3].1,
        rays,
        solid.select(hits.t, F::ZERO),
        solid.select(hits.id, splat(NONE)),
        F::ZERO,
    );
    (hits.t, hits.id, s)
}

/// Until so many rays have left: how many, how many of them hit the shape again, and how many that went in find no
/// way out.
fn run(kind: usize, radius: f32, cases: u32) -> (u32, u32, u32) {
    let mut random = Random::new(100 + kind as u32 + (radius.to_bits() >> 20));
    let (mut left, mut again, mut stuck) = (0, 0, 0);
    for _ in 0..cases {
        if left >= cases {
            break;
        }
        let far = radius * random.size(0, 13);
        let scene = one(&mut random, kind, radius, far);
        let rays = aim(&mut random, &scene, radius, far.max(radius * 4.0));
        let (_, id, s) = hit(&scene, &rays);
        let facing = s.facing;
        let away = V3::from_fn(|_| random.direction());
        // Any way out, and as flat as can be.
        let flat = away - facing * away.dot(facing);
        let flat = if random.one_in(2) { flat + facing * splat(random.size(-22, 0)) } else { away };
        let turn = flat.dot(facing).simd_lt(F::ZERO);
        let leaving = Rays8 {
            origin: s.point + facing * s.clearance,
            direction: V3::select(turn, -flat, flat).normalize(),
        };
        let (t2, id2, _) = hit(&scene, &leaving);
        let split = split(Shading::Phong, &s, rays.direction.normalize());
        let entering = Rays8 { origin: s.point - facing * s.clearance, direction: split.refracted };
        let (_, id3, _) = hit(&scene, &entering);
        for lane in 0..8 {
            let at = |v: F| v.to_array()[lane];
            if at(id) < 0.0 {
                continue;
            }
            let part = at(id) as u32 & 3;
            let n = true_normal(&scene, &s, part, lane) * if at(s.inside) == 0.0 { 1.0 } else { -1.0 };
            let up = n.dot(leaving.direction.lane(lane).as_dvec3());
            let outside = at(s.inside) == 0.0;
            let replay = || {
                let (o, d) = (rays.origin.lane(lane), rays.direction.lane(lane));
                let go = (leaving.origin.lane(lane), leaving.direction.lane(lane));
                let enter = (entering.origin.lane(lane), entering.direction.lane(lane));
                format!("{scene:?} origin {o:?} direction {d:?} leaving {go:?} entering {enter:?} up {up:e}")
            };
            // From inside, the far wall is hit, which is right.
            if up > 16.0 * U && (outside || kind == 1 || kind >= 4) {
                left += 1;
                if at(id2) >= 0.0 {
                    again += 1;
                    println!("hit again {} clearance {}: {}", at(t2), at(s.clearance), replay());
                }
            }
            let clear = near_rim(&scene, s.point.lane(lane), part, at(s.clearance));
            if kind != 1 && kind < 4 && outside && at(split.total) == 0.0 && clear && at(id3) < 0.0 {
                stuck += 1;
                println!("no way out, clearance {}: {}", at(s.clearance), replay());
            }
        }
    }
    (left, again, stuck)
}

/// Whether the shape is thick and the point far from its rims, as its clearance goes.
fn near_rim(scene: &Scene, p: Vec3, part: u32, clearance: f32) -> bool {
    let room = 4.0 * clearance;
    let inside = |height: f32, range: [f32; 2], radius: f32, off: f32| {
        let ends = (height - range[0]).min(range[1] - height) > room && radius > room;
        if part == 0 { ends } else { radius - off > room }
    };
    if let Some(c) = scene.cylinders.first() {
        let f = p - c.base;
        let h = f.dot(c.axis);
        return c.length > room && inside(h, [0.0, c.length], c.radius, (f - c.axis * h).length());
    }
    if let Some(c) = scene.cones.first() {
        let f = p - c.apex;
        let h = f.dot(c.axis);
        let k = c.slope.min(1.0);
        return (c.range[1] - c.range[0]) > room
            && inside(h * k, c.range.map(|x| x * k), h * k, (f - c.axis * h).length() * k / c.slope);
    }
    true
}

#[test]
fn rays_leave_and_find_their_way_out_at_any_scale() {
    for (kind, name) in KINDS.into_iter().enumerate() {
        for radius in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            let (left, again, stuck) = run(kind, radius, 40_000);
            println!("{name} of {radius:e}: {left} rays leave, {again} hit again, {stuck} find no way out");
            assert_eq!((again, stuck), (0, 0), "{name} of {radius:e}");
            assert!(left >= 40_000, "{name} of {radius:e}: {left}");
        }
    }
}

#[test]
fn normals_are_unit_vectors_also_at_a_tip() {
    let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
    scene.cones.push(Cone {
        apex: Vec3::ZERO,
        axis: Vec3::Y,
        slope: 2.0,
        range: [0.0, 3.0],
        caps: [true; 2],
        material: 0,
    });
    let rays = packet(|| (Vec3::new(0.0, -2.0, 0.0), Vec3::Y));
    let (t, id, s) = hit(&scene, &rays);
    assert_eq!((t, id), (splat(2.0), F::ZERO));
    assert_eq!((s.point.lane(0), s.outward().lane(0)), (Vec3::ZERO, -Vec3::Y));
    assert_eq!(s.value(Channel::Ior), splat(1.0));
}
