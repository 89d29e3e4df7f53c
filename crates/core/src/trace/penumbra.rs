//! Soft shadows of signed distance fields by the field itself: one ray to the lamp's middle, no samples.
//!
//! Seen from a surface a lamp of radius R at distance D is a cone around that ray, R s / D wide at s. A
//! body that comes as near as h to the ray at s hides a share of the lamp that x = h D / (R s) tells: none
//! from 1 on, all at -1, and as a smooth step between (Quilez, "Soft shadows in raymarched SDFs", whose
//! k is D / R). What counts is the least x. Where two values of the field tell that the ray passed nearest
//! between them, that point counts (Aaltonen 2018, in the same place), so that few steps show no bands.
//!
//! It is exact for no body. For a straight edge the smooth step is within 0.02 of the share of a disc; a
//! body thinner than the cone keeps too little of the light away. Two fields count as one.

use super::Rays8;
use super::field::{Nodes, REACH, distance};
use crate::counters::{Counter, Counters};
use crate::math::lanes::{Bound, F, INFINITY, TRUE, V3, splat};
use crate::quality::Quality;
use crate::scene::Field;

/// Part of the lamp's cone, by its width, that a step goes on at least.
const LEAST_STEP: f32 = 0.25;

/// Distance from a box, less than 0 in it.
fn from_box(p: V3, field: &Field) -> F {
    let (lo, hi) = (V3::splat(field.lo) - p, p - V3::splat(field.hi));
    let outside = |lo: F, hi: F| lo.at_least(hi);
    outside(lo.x, hi.x).at_least(outside(lo.y, hi.y)).at_least(outside(lo.z, hi.z))
}

/// Share of a lamp of this radius, world units, that the field leaves to surfaces at the rays' origins,
/// where `origin + direction` is the lamp's middle: 0 to 1, in lanes outside `wanted` 1.
#[inline(never)]
pub fn penumbra(
    rays: &Rays8,
    field: &Field,
    radius: f32,
    quality: &Quality,
    wanted: F,
    counters: &mut Counters,
) -> F {
    let (o, d) = (rays.origin, rays.direction);
    let (lo, hi) = (field.lo - radius, field.hi + radius);
    let (enter, exit) = rays.in_box(lo, hi, F::ONE);
    let square = d.dot(d);
    let far = square.sqrt();
    let mut near: Nodes = [TRUE; Field::MOST];
    let beyond = REACH * field.growth();
    for (node, near) in field.nodes.iter().zip(&mut near) {
        if let Some(half) = node.core() {
            let f = o - V3::splat(node.centre);
            let off = f - d * (f.dot(d) / square);
            let reach = splat(half.length() + node.rounding + beyond + radius);
            *near = off.dot(off).simd_lt(reach * reach);
        }
    }
    let mut active = wanted & enter.simd_lt(exit);
    let mut least = F::ONE;
    let mut t = active.select(enter, F::ZERO);
    let (mut last, mut step) = (INFINITY, INFINITY);
    let pace = splat(1.0 / field.lipschitz().max(1.0));
    let small = splat(1e-6);
    for _ in 0..quality.steps {
        if !active.any() {
            break;
        }
        counters.add(Counter::FieldShadows, active.to_bitmask().count_ones() as usize);
        let p = o + d * t;
        // Where the box cuts a body, it is closed.
        let value = distance(field, p, &near, None).at_least(from_box(p, field));
        let cone = splat(radius) * t;
        let mut x = value / cone.at_least(small);
        // How far back the body was nearest, if all of it is one point; between the last two places only.
        let back = (step * step + value * value - last * last) / (step + step);
        let between = value.simd_gt(F::ZERO) & back.simd_gt(F::ZERO) & back.simd_lt(step.at_most(value));
        let nearest = (value * value - back * back).at_least(F::ZERO).sqrt();
        let then = splat(radius) * (t - back / far);
        x = between.select(x.at_most(nearest / then.at_least(small)), x);
        least = active.select(least.at_most(x), least);
        active &= least.simd_gt(splat(-1.0));
        step = (value.abs() * pace).at_least(cone * splat(LEAST_STEP) + splat(quality.epsilon));
        last = value;
        t += step / far;
        active &= t.simd_lt(exit);
    }
    let x = least.at_least(splat(-1.0)) + F::ONE;
    wanted.select(x * x * (splat(3.0) - x) * splat(0.25), F::ONE)
}

#[cfg(test)]
mod tests;
