//! The steps of a walk through unit cells, eight rays at a time, from face to face (Amanatides and Woo 1987).
//!
//! Nothing accumulates: the distance of a face is `(face - o) / d` wherever it is asked for, so it only
//! grows along the ray. Ties have an order: a face across x comes before one across y at the same
//! distance, and that before one across z. So a ray through an edge visits one of the two cells beside
//! it, always the same.

use crate::math::lanes::{Bound, F, V3, splat};

/// Directions nearer to 0 are taken for this, which is too small to be seen, and so never give 0/0.
pub(super) const LEVEL: f32 = 1e-30;

/// Rays in units of cells.
pub struct Walk {
    origin: [F; 3],
    direction: [F; 3],
    /// 1 / direction.
    pub inverse: [F; 3],
    /// Masks: towards greater coordinates.
    pub up: [F; 3],
}

impl Walk {
    /// Rays given in cells.
    #[inline(always)]
    pub fn new(origin: V3, direction: V3) -> Self {
        let d = [direction.x, direction.y, direction.z];
        let d = d.map(|d| d.abs().simd_lt(splat(LEVEL)).select(splat(LEVEL), d));
        Self {
            origin: [origin.x, origin.y, origin.z],
            direction: d,
            inverse: d.map(|d| F::ONE / d),
            up: d.map(|d| d.simd_gt(F::ZERO)),
        }
    }

    /// The cell in which the rays are at `t`, along an axis.
    #[inline(always)]
    pub fn place(&self, axis: usize, t: F) -> F {
        (self.origin[axis] + self.direction[axis] * t).floor()
    }

    /// Distances of the far faces of boxes of `side` cells a side that begin at `from`.
    #[inline(always)]
    pub fn far(&self, from: &[F; 3], side: f32) -> [F; 3] {
        std::array::from_fn(|axis| {
            (from[axis] + (self.up[axis] & splat(side)) - self.origin[axis]) * self.inverse[axis]
        })
    }

    /// Where the rays leave such cells, and masks of the axis across which they do.
    #[inline(always)]
    pub fn leave(&self, cell: &[F; 3]) -> (F, [F; 3]) {
        let [x, y, z] = self.far(cell, 1.0);
        let now = x.at_most(y).at_most(z);
        let x = x.simd_eq(now);
        let y = y.simd_eq(now) & !x;
        (now, [x, y, !(x | y)])
    }

    /// The next cell's place along an axis, for rays that leave across it where `across` is set.
    #[inline(always)]
    pub fn next(&self, cell: F, axis: usize, across: F) -> F {
        cell + (across & self.up[axis].select(F::ONE, splat(-1.0)))
    }
}
