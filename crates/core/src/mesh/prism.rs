//! The body that crystals are made of.

use crate::math::scalar::sin_cos;
use glam::Vec3;
use std::f32::consts::TAU;

/// Appends a prism of `sides` sides between the middles of its ends, with a radius at each (0 is a
/// tip), turned about its axis by `turn` (1 is once around).
#[inline(never)]
pub fn prism(
    out: &mut Vec<[Vec3; 3]>,
    (a, radius_a): (Vec3, f32),
    (b, radius_b): (Vec3, f32),
    sides: usize,
    turn: f32,
) {
    let (u, v) = (b - a).normalize_or(Vec3::Y).any_orthonormal_pair();
    let around = |k: usize| {
        let (sin, cos) = sin_cos((k as f32 / sides as f32 + turn) * TAU);
        u * cos + v * sin
    };
    for k in 0..sides {
        // The last side ends where the first began, bit for bit.
        let (from, to) = (around(k), around((k + 1) % sides));
        let [p, q] = [from, to].map(|d| a + d * radius_a);
        let [r, s] = [to, from].map(|d| b + d * radius_b);
        for triangle in [[p, q, r], [p, r, s], [a, q, p], [b, s, r]] {
            let area = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
            if area != Vec3::ZERO {
                out.push(triangle);
            }
        }
    }
}
