//! A homogeneous coloured medium inside a box: transmittance exp(-s d) over the length d that a
//! ray runs in the box, in-scatter F (1 - exp(-s d)).

use crate::math::lanes::{F, V3, splat};
use crate::math::lanes_fn::exp;
use crate::scene::Fog;
use crate::trace::Rays8;

/// Transmittance and in-scattered light of rays with unit direction up to the distance `t`.
///
/// The slab's near and far planes are chosen by the sign of 1/d, which knows -0 too, and the
/// bounds only move where a comparison holds, so that 0 · inf = NaN, on a face, changes nothing.
#[inline(never)]
pub fn fog(fog: &Fog, rays: &Rays8, t: F) -> (F, V3) {
    let (lo, hi) = (V3::splat(fog.lo), V3::splat(fog.hi));
    let (mut enter, mut exit) = (F::ZERO, t);
    for (o, d, lo, hi) in [
        (rays.origin.x, rays.direction.x, lo.x, hi.x),
        (rays.origin.y, rays.direction.y, lo.y, hi.y),
        (rays.origin.z, rays.direction.z, lo.z, hi.z),
    ] {
        let inv = F::ONE / d;
        let forward = inv.simd_gt(F::ZERO);
        let (a, b) = ((lo - o) * inv, (hi - o) * inv);
        let (near, far) = (forward.select(a, b), forward.select(b, a));
        enter = near.simd_gt(enter).select(near, enter);
        exit = exit.simd_gt(far).select(far, exit);
    }
    let depth = (exit - enter).fast_max(F::ZERO);
    let through = exp(-(depth * splat(fog.density)));
    (through, V3::splat(fog.colour) * (F::ONE - through))
}

#[cfg(test)]
mod tests;
