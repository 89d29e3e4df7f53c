//! Whether light reaches a point: blocked by an opaque shape, coloured by transparent ones.

use super::{Hits, NONE, Rays8, Shape, penumbra};
use crate::counters::{Counter, Counters};
use crate::features;
use crate::math::lanes::{Bound, F, splat};
use crate::mesh::Blockers;
use crate::quality::Quality;
use crate::scene::{Field, Scene};

/// Visibility code of a lamp that an opaque shape hides.
pub const BLOCKED: f32 = -1.0;

/// Visibility code of a lamp that is behind fields with all of its disc. They hide it little by little, so it
/// tells of no edge.
pub const FAINT: f32 = -1.0 + 1.0 / 16_777_216.0;

/// End of a shadow ray that runs to the lamp: just before it, by four units in the last place.
const END: f32 = 1.0 - 4.0 / 16_777_216.0;

/// What may hide a lamp from points that are lit one packet after the other.
pub struct Suspects {
    /// Bit i stands for the shapes whose index is i modulo 64.
    pub shapes: u64,
    /// Facets that did so before.
    pub facets: Blockers,
}

impl Suspects {
    /// These shapes, and facets of which nothing is known.
    pub fn new(shapes: u64) -> Self {
        Self { shapes, facets: Blockers::new([NONE; 4]) }
    }
}

/// What lies between each origin and `origin + direction`.
///
/// Returns per lane [`BLOCKED`], or the sum of `bits[shape]` over the transparent shapes that the
/// segment crosses. `bits` holds a power of two for each transparent shape and 0 for opaque ones.
/// Lanes outside `wanted` return anything. If the lamp has a radius, opaque fields hide a share of it,
/// which is returned as a number from 0 down to [`FAINT`].
#[inline(never)]
pub fn occlusion(
    scene: &Scene,
    quality: &Quality,
    bits: &[f32],
    rays: &Rays8,
    (wanted, radius): (F, f32),
    suspects: &Suspects,
    counters: &mut Counters,
) -> F {
    let (zero, end) = (F::ZERO, splat(END));
    let mut code = F::ZERO;
    let mut open = wanted;
    let mut seen = F::ONE;
    for (index, &bit) in bits.iter().enumerate() {
        if suspects.shapes >> (index & 63) & 1 == 0 {
            continue;
        }
        let shape = scene.shape(index);
        if matches!(shape, Shape::Field(Field { shadowless: true, .. })) {
            continue;
        }
        counters.add(shape.counter(), 8);
        if let (true, Shape::Field(field)) = (features::FIELD_SHADOWS && radius > 0.0 && bit == 0.0, shape) {
            seen = seen.at_most(penumbra(rays, field, radius, quality, open, counters));
            continue;
        }
        let span = shape.span(rays, F::ONE, quality, counters);
        if bit > 0.0 {
            counters.add(Counter::ColouredShadows, 8);
            let crossed = span.exit.simd_gt(zero) & span.enter.simd_lt(end);
            code += crossed & splat(bit);
        } else {
            let within = |t: F| t.simd_gt(zero) & t.simd_lt(end);
            let hidden = within(span.enter) | within(span.exit);
            open &= !hidden;
            if !open.any() {
                break;
            }
        }
    }
    if open.any() {
        let mut hits = Hits { t: end, id: splat(NONE) };
        scene.meshes.search(scene, rays, open, Some(&suspects.facets), &mut hits, counters);
        open &= hits.t.simd_gt(zero);
    }
    if features::FIELD_SHADOWS {
        let hidden = (seen - F::ONE).at_least(splat(FAINT));
        code = hidden.simd_lt(zero).select(hidden, code);
    }
    (wanted & !open).select(splat(BLOCKED), code)
}
