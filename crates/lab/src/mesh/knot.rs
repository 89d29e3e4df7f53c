//! A tube along a (2, 3) torus knot, with bumps: a closed smooth body of as many triangles as are wanted.

use luc_core::math::Vec3;
use std::f32::consts::TAU;

/// Points along the knot for each point around the tube.
const LONG: usize = 10;

/// Middle of the tube, and its radius.
fn path(t: f32) -> Vec3 {
    let (around, across) = (2.0 * t * TAU, 3.0 * t * TAU);
    let out = 2.0 + across.cos() * 0.8;
    Vec3::new(out * around.cos(), out * around.sin(), across.sin() * 0.8)
}

/// A point of the surface: along the knot and around the tube, both from 0 to 1.
fn point(t: f32, u: f32) -> Vec3 {
    let along = (path(t + 1e-3) - path(t - 1e-3)).normalize();
    let out = (path(t) * Vec3::new(1.0, 1.0, 0.0)).normalize();
    let side = along.cross(out).normalize();
    let up = side.cross(along);
    let (sin, cos) = (u * TAU).sin_cos();
    let bumps = (48.0 * t * TAU).sin() * (5.0 * u * TAU).sin() * 0.035;
    path(t) + (up * cos + side * sin) * (0.42 + bumps)
}

/// The triangles, anticlockwise from outside, and the normals at their corners; about `count` of them.
pub fn knot(count: usize) -> (Vec<[Vec3; 3]>, Vec<[Vec3; 3]>) {
    let around = ((count as f64 / (2 * LONG) as f64).sqrt().round() as usize).max(3);
    let long = (count / (2 * around)).max(8);
    let at = |i: usize, k: usize| ((i % long) as f32 / long as f32, (k % around) as f32 / around as f32);
    let place = |(t, u): (f32, f32)| point(t, u);
    let normal = |(t, u): (f32, f32)| {
        let (along, side) =
            (point(t + 1e-3, u) - point(t - 1e-3, u), point(t, u + 1e-3) - point(t, u - 1e-3));
        side.cross(along).normalize()
    };
    let (mut corners, mut normals) = (Vec::new(), Vec::new());
    for (i, k) in (0..long).flat_map(|i| (0..around).map(move |k| (i, k))) {
        let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
        for three in [[a, c, b], [a, d, c]] {
            corners.push(three.map(place));
            normals.push(three.map(normal));
        }
    }
    (corners, normals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_knot_is_closed_and_its_normals_point_outwards() {
        let (corners, normals) = knot(20_000);
        assert!((18_000..22_000).contains(&corners.len()), "{}", corners.len());
        let mut volume = 0.0;
        let mut area = Vec3::ZERO;
        for ([a, b, c], n) in corners.iter().zip(normals) {
            let face = (*b - *a).cross(*c - *a);
            assert!(n.iter().all(|n| n.dot(face.normalize()) > 0.5), "{n:?} {face}");
            volume += a.dot(face) / 6.0;
            area += face;
        }
        assert!(area.length() < 1e-3, "closed surfaces have no area as a sum of vectors: {area}");
        assert!(volume > 5.0, "{volume}");
    }
}
