//! Whether light reaches a point: blocked by an opaque shape, coloured by transparent ones.

use super::{Hits, NONE, Rays8, Shape};
use crate::counters::{Counter, Counters};
use crate::math::lanes::{F, splat};
use crate::quality::Quality;
use crate::scene::{Field, Scene};

/// Visibility code of a lamp that an opaque shape hides.
pub const BLOCKED: f32 = -1.0;

/// End of a shadow ray that runs to the lamp: just before it, by four units in the last place.
const END: f32 = 1.0 - 4.0 / 16_777_216.0;

/// What lies between each origin and `origin + direction`.
///
/// Returns per lane [`BLOCKED`], or the sum of `bits[shape]` over the transparent shapes that the
/// segment crosses. `bits` holds a power of two for each transparent shape and 0 for opaque ones.
/// Lanes outside `wanted` return anything.
#[inline(never)]
pub fn occlusion(
    scene: &Scene,
    quality: &Quality,
    bits: &[f32],
    rays: &Rays8,
    wanted: F,
    candidates: u64,
    counters: &mut Counters,
) -> F {
    let (zero, end) = (F::ZERO, splat(END));
    let mut code = F::ZERO;
    let mut open = wanted;
    for (index, &bit) in bits.iter().enumerate() {
        if candidates >> (index & 63) & 1 == 0 {
            continue;
        }
        let shape = scene.shape(index);
        if matches!(shape, Shape::Field(Field { shadowless: true, .. })) {
            continue;
        }
        counters.add(shape.counter(), 8);
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
        scene.meshes.search(scene, rays, open, true, &mut hits, counters);
        open &= hits.t.simd_gt(zero);
    }
    (wanted & !open).select(splat(BLOCKED), code)
}
