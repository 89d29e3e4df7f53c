//! The box around points that come eight at a time.

use crate::math::Vec3;
use crate::math::lanes::{Bound, F, V3};

/// Least and greatest coordinates, lane by lane.
#[derive(Clone, Copy)]
pub struct Bounds {
    lo: V3,
    hi: V3,
}

impl Bounds {
    /// Around nothing.
    pub const EMPTY: Bounds = {
        let (lo, hi) = (F::splat(f32::INFINITY), F::splat(f32::NEG_INFINITY));
        Bounds { lo: V3::new(lo, lo, lo), hi: V3::new(hi, hi, hi) }
    };

    /// Takes in the points in lanes `mask`.
    pub fn add(&mut self, points: V3, mask: F) {
        let low = |old: F, p: F| old.at_most(mask.select(p, old));
        let high = |old: F, p: F| old.at_least(mask.select(p, old));
        let V3 { x, y, z } = points;
        self.lo = V3::new(low(self.lo.x, x), low(self.lo.y, y), low(self.lo.z, z));
        self.hi = V3::new(high(self.hi.x, x), high(self.hi.y, y), high(self.hi.z, z));
    }

    /// The least and the greatest corner, if there is a point.
    #[inline(never)]
    pub fn corners(&self) -> Option<(Vec3, Vec3)> {
        let first = (self.lo.lane(0), self.hi.lane(0));
        let (lo, hi) = (1..8).fold(first, |(lo, hi), i| (lo.min(self.lo.lane(i)), hi.max(self.hi.lane(i))));
        (lo.x <= hi.x).then_some((lo, hi))
    }
}
