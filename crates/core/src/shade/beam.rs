//! Light scattered out of a beam towards the eye, in closed form: no marching.
//!
//! A ray gets the light of the place where it comes nearest to the beam's segment, at distance r:
//! `(exp(-(r/w)²) - exp(-9)) exp(-fade s) / max(sin a, 0.01)`, so it ends at r = 3 w. The integral
//! of a Gaussian along a line is such a Gaussian of the line's distance over sin a. Where the ray
//! ends before or soon after that place, part of the integral is missing: instead of the error
//! function of x = (end - nearest) sin a / w, its likeness of third degree.

use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::lanes_fn::exp;
use crate::scene::Beam;
use crate::trace::Rays8;

/// exp(-END²)
const REST: f32 = 1.234_098e-4;

/// Light that rays with unit direction get from the beam up to their ends at `t`.
///
/// `spread` is the width of a ray's footprint per unit of distance, which blurs the beam.
#[inline(never)]
pub fn beam(beam: &Beam, rays: &Rays8, spread: F, t: F) -> V3 {
    let (axis, length) = beam.along();
    let a = V3::splat(axis);
    let d = rays.direction;
    let f = rays.origin - V3::splat(beam.from);
    let (da, fa, fd) = (d.dot(a), f.dot(a), f.dot(d));
    let across = d.cross(a);
    let sin2 = across.dot(across);
    let least = splat(1e-4);
    let s = (fa - fd * da) / sin2.at_least(least);
    let s = s.at_least(F::ZERO).at_most(splat(length));
    let nearest = (s * da - fd).at_least(F::ZERO);
    let between = f + d * nearest - a * s;
    let blur = spread * nearest * splat(0.5);
    let own = splat(beam.width);
    let w2 = own * own + blur * blur;
    let q = between.dot(between) / w2;
    if !q.simd_lt(splat(Beam::END * Beam::END)).any() {
        return V3::ZERO;
    }
    let sin = if length > 0.0 { sin2.at_least(least).sqrt() } else { F::ONE };
    let w = w2.sqrt();
    let before = ((t - nearest) * sin / w * splat(0.35) + splat(0.5)).at_least(F::ZERO).at_most(F::ONE);
    let share = before * before * (splat(3.0) - (before + before));
    let left = exp(-(s * splat(beam.fade)));
    let light = (exp(-q) - splat(REST)).at_least(F::ZERO) * share * left * own / (w * sin);
    V3::splat(beam.colour) * light
}

#[cfg(test)]
mod tests;
