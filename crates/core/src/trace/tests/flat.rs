//! Plane and triangle against f64; shared edges and corners without leaks.
//!
//! A flat surface has no inside: it moves by the skin along its normal, and its rim outwards by
//! as much as that moves the crossing. A ray may be parallel within 8 u of the angle.

use crate::math::Vec3;
use crate::math::lanes::{F, splat};
use crate::scene::{Plane, Triangle};
use crate::trace::check::{Inside, Line, Random, Tally, U, packet, sweep, two_to};
use crate::trace::{Rays8, plane, triangle};
use glam::{DVec2, DVec3};

/// The crossing with the plane through `p`, raised by `skin`: none where a ray may be parallel,
/// which is anywhere for a surface that grows.
fn crossing(ray: &Line, p: DVec3, n: DVec3, skin: f64) -> Option<Inside> {
    let along = n.dot(ray.d);
    let t = (n.dot(p - ray.o) + skin) / along;
    if along.abs() > 8.0 * U * ray.d.length() {
        return Some(Inside { t: [t; 2], part: [0; 2] });
    }
    (skin > 0.0).then_some(Inside { t: [f64::NEG_INFINITY, f64::INFINITY], part: [0; 2] })
}

fn plane_truth(s: &Plane, ray: &Line, [skin, ..]: [f64; 3]) -> Option<Inside> {
    let (p, n) = (s.point.as_dvec3(), s.normal.as_dvec3().normalize());
    let at = crossing(ray, p, n, skin)?;
    let along = n.dot(ray.d);
    let off = (ray.o + ray.d * (n.dot(p - ray.o) / along) - p).length();
    let room = skin * ray.d.length() / along.abs();
    (at.t[0].is_infinite() || off <= f64::from(s.reach) + room).then_some(at)
}

fn judge_plane(tally: &mut Tally, s: &Plane, rays: &Rays8) {
    let reach = |ray: &Line| (ray.o - s.point.as_dvec3()).length() + 1e-30;
    tally.body(rays, &plane(rays, s), |ray, skin| plane_truth(s, ray, skin), reach, [false; 2], s);
}

/// Edges as seen along the ray: the ray is inside if it lies on the same side of all three.
fn triangle_truth(s: &Triangle, ray: &Line, [skin, ..]: [f64; 3]) -> Option<Inside> {
    let corners = s.corners.map(Vec3::as_dvec3);
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    let at = crossing(ray, a, n, skin)?;
    let (x, y) = ray.d.normalize().any_orthonormal_pair();
    let flat = corners.map(|p| DVec2::new((p - ray.o).dot(x), (p - ray.o).dot(y)));
    let distance = |p: DVec2, q: DVec2| (q - p).perp_dot(-p) / (q - p).length().max(1e-300);
    let [p, q, r] = flat;
    let sides = [distance(p, q), distance(q, r), distance(r, p)];
    let inside = sides.iter().all(|&x| x >= -skin) || sides.iter().all(|&x| x <= skin);
    inside.then_some(at)
}

fn judge_triangle(tally: &mut Tally, s: &Triangle, rays: &Rays8) {
    let reach = |ray: &Line| s.corners.iter().fold(0.0, |m: f64, p| m.max((p.as_dvec3() - ray.o).length()));
    tally.body(rays, &triangle(rays, s), |ray, skin| triangle_truth(s, ray, skin), reach, [false; 2], s);
}

fn floor(point: Vec3, normal: Vec3, reach: f32) -> Plane {
    Plane { point, normal, reach, material: 0 }
}

fn tri(corners: [Vec3; 3]) -> Triangle {
    Triangle { corners, material: 0 }
}

#[test]
fn named_planes() {
    let v = Vec3::new;
    let ground = floor(Vec3::ZERO, Vec3::Y, f32::INFINITY);
    let cases = [
        (floor(v(1e6, 0.0, 0.0), v(0.6, 0.8, 0.0), f32::INFINITY), v(1e6, 1.0, 1e6), -Vec3::Y),
        // Near the horizon, in the plane, along it, on it.
        (ground, v(0.0, 1.0, 0.0), v(1.0, -1e-6, 0.0)),
        (ground, v(0.0, 1.0, 0.0), v(1.0, 1e-6, 0.0)),
        (ground, Vec3::ZERO, Vec3::X),
        (ground, v(0.0, 1.0, 0.0), v(1.0, -0.0, 0.0)),
        (ground, Vec3::ZERO, Vec3::Y),
        (ground, v(0.0, -0.0, 0.0), -Vec3::Y),
        (ground, v(0.0, 1e-30, 0.0), -Vec3::Y),
        // A disc: just inside, just outside.
        (floor(Vec3::ZERO, Vec3::Y, 2.0), v(2.0, 1.0, 0.0), -Vec3::Y),
        (floor(Vec3::ZERO, Vec3::Y, 2.0), v(2.001, 1.0, 0.0), -Vec3::Y),
        (floor(Vec3::ZERO, Vec3::Y, 2.0), v(1.999, 1.0, 0.0), -Vec3::Y),
    ];
    let mut tally = Tally::new("plane, named");
    for (s, o, d) in cases {
        judge_plane(&mut tally, &s, &packet(|| (o, d)));
    }
    tally.finish(4.0);
    // A ray in the plane, or along it, hits nothing.
    for o in [Vec3::ZERO, Vec3::Y] {
        assert_eq!(plane(&packet(|| (o, Vec3::X)), &ground).enter, splat(-1.0));
    }
}

#[test]
fn random_planes() {
    let mut tally = Tally::new("plane");
    sweep(1, 40, 25_000, |random| {
        let n = random.direction();
        let size = random.size(-10, 10);
        let s = floor(random.vector(-10, 14), n, if random.one_in(2) { f32::INFINITY } else { size });
        let rays = packet(|| {
            let any = random.direction();
            let across = (any - n * any.dot(n)).normalize_or(n.any_orthogonal_vector());
            let target = s.point + across * (size * random.signed(-10, 4));
            random.ray(target, n, across, size)
        });
        judge_plane(&mut tally, &s, &rays);
    });
    tally.finish(4.0);
}

#[test]
fn named_triangles() {
    let v = Vec3::new;
    let unit = tri([v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)]);
    let small = tri([v(0.0, 0.0, 0.0), v(1e-4, 0.0, 0.0), v(0.0, 1e-4, 0.0)]);
    let sliver = tri([v(0.0, 0.0, 0.0), v(1.0, 1e-6, 0.0), v(1.0, 0.0, 0.0)]);
    let point = tri([v(0.5, 0.5, 0.0); 3]);
    let cases = [
        (unit, v(0.25, 0.25, -1e4), Vec3::Z),
        (small, v(3e-5, 3e-5, -1.0), Vec3::Z),
        (small, v(3e-5, 3e-5, 1.0), -Vec3::Z),
        (sliver, v(0.9, 4e-7, -1.0), Vec3::Z),
        (unit, v(0.25, 0.25, 0.0), Vec3::Z),
        // In its plane, edge on; along an edge; at a corner.
        (unit, v(-1.0, 0.25, 0.0), Vec3::X),
        (unit, v(-1.0, 0.0, 0.0), Vec3::X),
        (unit, v(-1.0, 0.25, 1e-7), Vec3::X),
        (unit, v(0.0, 0.0, -1.0), Vec3::Z),
        (unit, v(0.0, 0.0, -1.0), v(-0.0, -0.0, 1.0)),
        (unit, v(0.5, 0.5, -1.0), Vec3::Z),
        (unit, v(0.5, 0.5000001, -1.0), Vec3::Z),
        (point, v(0.5, 0.5, -1.0), Vec3::Z),
        (unit, v(1e4, 1e4, -1e4), v(-1.0, -1.0, 1.0)),
    ];
    let mut tally = Tally::new("triangle, named");
    for (s, o, d) in cases {
        judge_triangle(&mut tally, &s, &packet(|| (o, d)));
    }
    tally.finish(4.0);
    assert_eq!(triangle(&packet(|| (v(-1.0, 0.25, 0.0), Vec3::X)), &unit).enter, splat(-1.0), "in its plane");
    assert_eq!(triangle(&packet(|| (v(0.5, 0.5, -1.0), Vec3::Z)), &point).enter, splat(-1.0), "no area");
}

#[test]
fn random_triangles() {
    let mut tally = Tally::new("triangle");
    sweep(1, 50, 40_000, |random| {
        let size = random.size(-12, 12);
        let at = random.vector(-6, 8) * size;
        let e = [random.direction() * size, random.direction() * (size * random.size(-8, 1))];
        let s = tri([at, at + e[0], at + e[1]]);
        let n = crate::math::cross(e[0], e[1]).normalize_or(Vec3::Y);
        let rays = packet(|| {
            let (mut x, mut y) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
            match random.bits() % 4 {
                0 => x = random.signed(-20, 0),
                1 => y = 1.0 - x + random.signed(-20, 0),
                _ => {}
            }
            random.ray(at + e[0] * x + e[1] * y, n, e[0].normalize_or(n), size)
        });
        judge_triangle(&mut tally, &s, &rays);
    });
    assert!(tally.hits > 50_000, "{} hits", tally.hits);
    tally.finish(4.0);
}

#[test]
fn scaling_by_a_power_of_two_gives_the_same_bits() {
    let mut random = Random::new(60);
    for _ in 0..20_000 {
        let p = [0; 3].map(|_| random.vector(-4, 4));
        if crate::math::cross(p[1] - p[0], p[2] - p[0]) == Vec3::ZERO {
            // Without an area all is rounding, some of it among the subnormal numbers, which don't scale.
            continue;
        }
        let n = random.direction();
        let rays = packet(|| random.ray(p[0] * 0.5 + p[1] * 0.25 + p[2] * 0.25, n, Vec3::X, 1.0));
        let k = two_to(random.bits() as i32 % 20);
        let scaled = Rays8 { origin: rays.origin * splat(k), direction: rays.direction * splat(k) };
        let replay = || format!("{p:?} {n:?} {:?} {:?} times {k}", rays.origin, rays.direction);
        let (small, large) = (tri(p), tri(p.map(|p| p * k)));
        assert_eq!(triangle(&rays, &small).enter, triangle(&scaled, &large).enter, "{}", replay());
        let (small, large) = (floor(p[0], n, 4.0), floor(p[0] * k, n, 4.0 * k));
        assert_eq!(plane(&rays, &small).enter, plane(&scaled, &large).enter, "{}", replay());
    }
}

/// Whether each ray hits one of the triangles in front of it; prints rays that don't.
fn leaks(mesh: &[Triangle], rays: &Rays8) -> u32 {
    let hit = mesh.iter().fold(F::ZERO, |hit, s| hit | triangle(rays, s).enter.simd_gt(F::ZERO));
    let missed = !hit.to_bitmask() & 255;
    if missed != 0 {
        let i = missed.trailing_zeros() as usize;
        println!("leak: {mesh:?} origin {:?} direction {:?}", rays.origin.lane(i), rays.direction.lane(i));
    }
    missed.count_ones()
}

/// Rays onto the spokes and the hub of uneven, nearly flat fans, at three distances from the
/// world's origin.
#[test]
fn fans_have_no_leaks() {
    let mut random = Random::new(70);
    let mut lost = 0;
    for case in 0..60_000 {
        let offset = [0.0, 1e3, 1e5][case % 3];
        let centre = Vec3::new(offset, -offset * 0.7, offset * 0.3);
        let n = random.direction();
        let (x, y) = n.any_orthonormal_pair();
        let count = 4 + random.bits() % 5;
        let corner = |random: &mut Random, k: u32| {
            let angle = (k as f32 + random.range(0.1, 0.9)) * (std::f32::consts::TAU / count as f32);
            let (s, c) = crate::math::scalar::sin_cos(angle);
            centre + (x * c + y * s) * random.range(1.0, 3.0) + n * random.range(-0.05, 0.05)
        };
        let rim: Vec<Vec3> = (0..count).map(|k| corner(&mut random, k)).collect();
        let fan: Vec<_> =
            (0..count as usize).map(|k| tri([centre, rim[k], rim[(k + 1) % rim.len()]])).collect();
        for _ in 0..3 {
            let rays = packet(|| {
                let along = if random.one_in(3) { 0.0 } else { random.size(-24, -1) };
                let target = centre + (rim[random.bits() as usize % rim.len()] - centre) * along;
                let tilt = x * random.range(-0.7, 0.7) + y * random.range(-0.7, 0.7);
                let o = target + (n + tilt) * random.size(-2, 10);
                (o, (target - o) * if random.one_in(2) { 1.0 } else { random.size(-4, 4) })
            });
            lost += leaks(&fan, &rays);
        }
    }
    assert_eq!(lost, 0);
}

/// From inside a closed octahedron every ray meets a face.
#[test]
fn closed_meshes_have_no_leaks() {
    let mut random = Random::new(80);
    let mut lost = 0;
    for case in 0..50_000 {
        let offset = [0.0, 1e3, 1e5][case % 3];
        let centre = Vec3::new(-offset, offset * 0.9, offset * 0.1);
        let [px, py, pz, nx, ny, nz] = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z]
            .map(|d| centre + (d + random.direction() * 0.2) * random.size(0, 5));
        let mesh = [
            [px, py, pz],
            [py, nx, pz],
            [nx, ny, pz],
            [ny, px, pz],
            [py, px, nz],
            [nx, py, nz],
            [ny, nx, nz],
            [px, ny, nz],
        ];
        for _ in 0..2 {
            let rays = packet(|| {
                let o = centre + random.direction() * random.range(0.0, 0.2);
                let [a, b, _] = mesh[random.bits() as usize % 8];
                let target = a + (b - a) * if random.one_in(3) { 0.0 } else { random.range(0.0, 1.0) };
                (o, target - o)
            });
            lost += leaks(&mesh.map(tri), &rays);
        }
    }
    assert_eq!(lost, 0);
}
