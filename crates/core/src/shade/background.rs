//! The sky behind everything, discs in it, and the shining rectangles that mirrors see.

use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::lanes_fn::exp;
use crate::scene::{Background, Emitter};
use crate::trace::{NONE, Rays8, ramp};

/// Share of the filter [x - w/2, x + w/2] that lies in [-half, half]: a box seen through a box.
///
/// That is the least of 1, 2 half / w and ½ + (half - |x|) / w, none of which cancels, so that
/// `w` may be 0, the hard edge, at any distance. 0 where x is NaN.
#[inline(always)]
fn covered(x: F, half: F, w: F) -> F {
    let inv = F::ONE / w.at_least(splat(1e-30));
    let edge = splat(0.5) + (half - x.abs()) * inv;
    // The second operand counts where one is NaN.
    ((half + half) * inv).at_most(edge).at_least(F::ZERO).at_most(F::ONE)
}

/// Colour of the background in the direction of rays that hit nothing, and what was hit:
/// [`NONE`] for the sky, `NONE - 1 - k` for disc k.
///
/// `spread` is the width of a ray's footprint per unit of distance. `soft` is the inverse sharpness
/// that the footprint gives to glows, keeping their light; lanes in `blind` don't see discs.
#[inline(never)]
pub fn background(sky: &Background, rays: &Rays8, spread: F, soft: F, blind: F) -> (V3, F) {
    let d = rays.direction;
    let mut colour = ramp(&sky.stops, d.y);
    for glow in &sky.glows {
        // Lobes of inverse sharpness a and b blur to one of a + b.
        let share = F::ONE / (F::ONE + soft * splat(glow.sharpness));
        let x = (d.dot(V3::splat(glow.direction)) - F::ONE) * splat(glow.sharpness) * share;
        colour += V3::splat(glow.colour) * share * exp(x);
    }
    let mut id = splat(NONE);
    for (k, disc) in sky.discs.iter().enumerate().rev() {
        let c = V3::splat(disc.centre);
        let r = splat(disc.radius);
        let t = (c.z - rays.origin.z) / d.z;
        let (x, y) = (rays.origin.x + d.x * t - c.x, rays.origin.y + d.y * t - c.y);
        let share = covered((x * x + y * y).sqrt(), r, spread * t);
        let share = t.simd_gt(F::ZERO).select(share, F::ZERO) & !blind;
        let height = y / (r + r) + splat(0.5);
        let low = V3::splat(disc.low);
        let shine = low + (V3::splat(disc.high) - low) * height.at_least(F::ZERO).at_most(F::ONE);
        colour += (shine - colour) * share;
        id = share.simd_gt(splat(0.5)).select(splat(NONE - 1.0 - k as f32), id);
    }
    (colour, id)
}

/// What shining rectangles add to rays that end at `t`: their light, the share of the ray that
/// they hide, and a code of which of them cover more than half of it.
///
/// The edges are softened by the ray's footprint (its width at the rectangle is `spread` times
/// the distance), as a rough mirror would.
#[inline(never)]
pub fn emitters(list: &[Emitter], rays: &Rays8, spread: F, t: F) -> (V3, F, F) {
    let mut light = V3::splat(crate::math::Vec3::ZERO);
    let (mut open, mut seen) = (F::ONE, F::ZERO);
    for (k, e) in list.iter().enumerate() {
        let n = V3::splat(e.normal());
        let facing = n.dot(rays.direction);
        let c = V3::splat(e.centre) - rays.origin;
        let at = c.dot(n) / facing;
        let front = at.simd_gt(F::ZERO) & at.simd_lt(t) & facing.simd_lt(F::ZERO);
        if !front.any() {
            continue;
        }
        let p = rays.direction * at - c;
        let w = spread * at;
        let (x, y) = (p.dot(V3::splat(e.u)), p.dot(V3::splat(e.v)));
        let (half_x, half_y) = (splat(e.half[0]), splat(e.half[1]));
        let share = front.select(covered(x, half_x, w) * covered(y, half_y, w), F::ZERO);
        light += V3::splat(e.radiance) * (share * open);
        open *= F::ONE - share;
        let within = front & x.abs().simd_lt(half_x) & y.abs().simd_lt(half_y);
        seen += within & splat((1 << k.min(20)) as f32);
    }
    (light, F::ONE - open, seen)
}

#[cfg(test)]
mod tests;
