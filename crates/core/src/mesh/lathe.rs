//! The body that crystals are made of.

use crate::math::scalar::sin_cos;
use crate::math::{Vec3, number};
use std::f32::consts::TAU;

/// Appends a body of `sides` flat sides around some points of an axis, with a radius at each; a
/// radius of 0 is a tip, or the middle of a cap. It is turned about the axis by `turn` (1 is once
/// around).
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn lathe(out: &mut Vec<[Vec3; 3]>, rings: &[(Vec3, f32)], sides: usize, turn: f32) {
    let axis = rings[rings.len() - 1].0 - rings[0].0;
    let (u, v) = axis.normalize_or(Vec3::Y).any_orthonormal_pair();
    let mut around = [Vec3::ZERO; 2];
    // The last side ends where the first began, bit for bit.
    for k in 0..=sides {
        let (sin, cos) = sin_cos((number(k % sides) / number(sides) + turn) * TAU);
        around = [around[1], u * cos + v * sin];
        for ring in rings.windows(2).filter(|_| k > 0) {
            let [p, q, s, r] = [0, 1, 2, 3].map(|i| ring[i / 2].0 + around[i % 2] * ring[i / 2].1);
            for (triangle, (_, radius)) in [[p, q, r], [p, r, s]].into_iter().zip(ring) {
                if *radius > 0.0 {
                    out.push(triangle);
                }
            }
        }
    }
}
