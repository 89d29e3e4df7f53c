//! The nearest hit of eight rays among a scene's shapes.

use super::Rays8;
use crate::counters::Counters;
use crate::math::lanes::{F, TRUE, splat};
use crate::quality::Quality;
use crate::scene::Scene;

/// Hit id of a lane that hit nothing.
pub const NONE: f32 = -1.0;

/// Nearest hits of a packet.
#[derive(Clone, Copy)]
pub struct Hits {
    /// Distance in lengths of the ray's direction, infinity for none.
    pub t: F,
    /// `4 * shape + part`, or [`NONE`]. Whole numbers under 2^24 are exact in an f32 lane, and
    /// can be mixed under the same masks as the distances.
    pub id: F,
}

/// The nearest hit of each ray among the candidate shapes and all facets; ties go to the lower shape index.
///
/// Bit i of `candidates` stands for the shapes whose index is i modulo 64: leaving out a bit must
/// only leave out shapes that no lane can hit.
#[inline(never)]
pub fn nearest(
    scene: &Scene,
    quality: &Quality,
    rays: &Rays8,
    candidates: u64,
    counters: &mut Counters,
) -> Hits {
    let mut best = Hits { t: splat(f32::INFINITY), id: splat(NONE) };
    for index in 0..scene.shape_count() {
        if candidates >> (index & 63) & 1 == 0 {
            continue;
        }
        let shape = scene.shape(index);
        counters.add(shape.counter(), 8);
        let (t, part) = shape.span(rays, best.t, quality, counters).first();
        let closer = t.simd_gt(F::ZERO) & t.simd_lt(best.t);
        best.t = closer.select(t, best.t);
        best.id = closer.select(splat(index as f32 * 4.0) + part, best.id);
    }
    scene.meshes.search(scene, rays, TRUE, None, &mut best, counters);
    best
}
