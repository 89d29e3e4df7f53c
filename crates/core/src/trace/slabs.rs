//! Rays against axis-parallel boxes, by the slabs between their faces.
//!
//! The near and far planes of a slab are chosen by the sign of 1/d, which knows -0 too, and the bounds only
//! move where a comparison holds, so that 0 · inf = NaN, on a face, changes nothing. Ize, JCGT 2(2), 2013.

use super::Rays8;
use crate::math::Vec3;
use crate::math::lanes::{Bound, F, splat};

/// How eight rays meet planes across an axis.
#[derive(Clone, Copy)]
pub struct Across {
    /// Origins, moved back along the axis by what boxes are to be widened.
    pub lo: F,
    /// Origins, moved on by that.
    pub hi: F,
    /// 1/d.
    pub inverse: F,
}

/// Eight rays as boxes see them.
pub struct Slabs(pub [Across; 3]);

impl Slabs {
    /// Rays for boxes that are wider by `room` to all sides.
    #[inline(never)]
    pub fn new(rays: &Rays8, room: F) -> Self {
        let Rays8 { origin: o, direction: d } = rays;
        let across = |o: F, d: F| Across { lo: o - room, hi: o + room, inverse: F::ONE / d };
        Slabs([across(o.x, d.x), across(o.y, d.y), across(o.z, d.z)])
    }

    /// Distances at which the rays enter and leave a box, at least 0 and at most `end`; a miss has
    /// them in the wrong order.
    #[inline(never)]
    pub fn span(&self, lo: Vec3, hi: Vec3, end: F) -> (F, F) {
        let (mut enter, mut exit) = (F::ZERO, end);
        let mut cut = |rays: &Across, lo: f32, hi: f32| {
            let forward = rays.inverse.simd_gt(F::ZERO);
            let (a, b) = ((splat(lo) - rays.hi) * rays.inverse, (splat(hi) - rays.lo) * rays.inverse);
            enter = forward.select(a, b).at_least(enter);
            exit = forward.select(b, a).at_most(exit);
        };
        let Slabs([x, y, z]) = self;
        cut(x, lo.x, hi.x);
        cut(y, lo.y, hi.y);
        cut(z, lo.z, hi.z);
        (enter, exit)
    }
}

impl Rays8 {
    /// Distances at which the rays enter and leave a box: see [`Slabs::span`].
    #[inline(never)]
    pub fn in_box(&self, lo: Vec3, hi: Vec3, end: F) -> (F, F) {
        Slabs::new(self, F::ZERO).span(lo, hi, end)
    }
}
