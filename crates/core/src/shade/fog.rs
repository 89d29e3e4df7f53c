//! A homogeneous coloured medium inside a box: transmittance exp(-s d) over the length d that a
//! ray runs in the box, in-scatter F (1 - exp(-s d)).

use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::lanes_fn::exp;
use crate::scene::Fog;
use crate::trace::Rays8;

/// Transmittance and in-scattered light of rays with unit direction up to the distance `t`.
#[inline(never)]
pub fn fog(fog: &Fog, rays: &Rays8, t: F) -> (F, V3) {
    let (enter, exit) = rays.in_box(fog.lo, fog.hi, t);
    let depth = (exit - enter).at_least(F::ZERO);
    let through = exp(-(depth * splat(fog.density)));
    (through, V3::splat(fog.colour) * (F::ONE - through))
}

#[cfg(test)]
mod tests;
