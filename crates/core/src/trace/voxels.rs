//! Rays against voxels: a walk from face to face (Amanatides and Woo 1987) that takes bricks without a
//! solid cell in one step.
//!
//! Nothing accumulates: the distance of a face is `(face - o) / d` wherever it is asked for, so it only
//! grows along the ray, and a walk by bricks meets the very cells of a walk by cells. Ties have an order:
//! a face across x comes before one across y at the same distance, and that before one across z. So a
//! ray through an edge visits one of the two cells beside it, always the same.

use super::{Rays8, Span};
use crate::counters::{Counter, Counters};
use crate::math::Vec3;
use crate::math::hash::{mix_x8, unit_x8};
use crate::math::lanes::{F, V3, splat};
use crate::math::noise;
use crate::scene::Voxels;

/// A ray in the grid's cells.
#[derive(Clone, Copy)]
pub struct Walk {
    origin: [f32; 3],
    direction: [f32; 3],
    inverse: [f32; 3],
}

/// Directions nearer to 0 are taken for this, which is too small to be seen, and so never give 0/0.
const LEVEL: f32 = 1e-30;

impl Walk {
    /// A ray from `origin` along `direction`, both in cells from the grid's corner.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let direction = direction.to_array().map(|d| if d.abs() < LEVEL { LEVEL } else { d });
        Walk { origin: origin.to_array(), direction, inverse: direction.map(|d| 1.0 / d) }
    }

    /// Distance of the face number `face` across an axis.
    #[inline(always)]
    fn at(&self, axis: usize, face: i32) -> f32 {
        (face as f32 - self.origin[axis]) * self.inverse[axis]
    }

    /// Number of the face by which the ray comes into the cells `from..from + side`, or leaves them.
    #[inline(always)]
    fn face(&self, axis: usize, from: i32, side: i32, leaving: bool) -> i32 {
        if (self.direction[axis] > 0.0) == leaving { from + side } else { from }
    }

    /// When, and across which axis, the ray comes into a box of cells, at least 0 (and then across
    /// none, -1).
    #[inline(always)]
    pub fn enters(&self, from: [i32; 3], side: [i32; 3]) -> (f32, i32) {
        let mut last = (0.0, -1);
        for axis in 0..3 {
            let t = self.at(axis, self.face(axis, from[axis], side[axis], false));
            if t >= last.0 {
                last = (t, axis as i32);
            }
        }
        last
    }

    /// When, and across which axis, it leaves it.
    #[inline(always)]
    pub fn leaves(&self, from: [i32; 3], side: [i32; 3]) -> (f32, i32) {
        let mut first = (f32::INFINITY, 0);
        for axis in 0..3 {
            let t = self.at(axis, self.face(axis, from[axis], side[axis], true));
            if t < first.0 {
                first = (t, axis as i32);
            }
        }
        first
    }

    /// The cell that the ray comes into at `event`, among those of a box which it comes into then or
    /// crosses.
    #[inline(always)]
    fn cell(&self, event: (f32, i32), from: [i32; 3], side: [i32; 3], leaving: bool) -> [i32; 3] {
        let (t, across) = event;
        let mut cell = [0; 3];
        for axis in 0..3 {
            let up = self.direction[axis] > 0.0;
            if axis as i32 == across {
                let face = self.face(axis, from[axis], side[axis], leaving);
                cell[axis] = if up { face } else { face - 1 };
                continue;
            }
            let step = if up { 1 } else { -1 };
            let (least, most) = (from[axis], from[axis] + side[axis] - 1);
            // Near enough; then the faces themselves are asked.
            let mut i = ((self.origin[axis] + self.direction[axis] * t) as i32).clamp(least, most);
            let before = |face: i32| {
                let other = self.at(axis, face);
                other < t || (other == t && (axis as i32) < across)
            };
            while i != (if up { least } else { most }) && !before(self.face(axis, i, 1, false)) {
                i -= step;
            }
            while i != (if up { most } else { least }) && before(self.face(axis, i, 1, true)) {
                i += step;
            }
            cell[axis] = i;
        }
        cell
    }

    /// Distance and axis of the first face of a solid cell that the ray comes to before `limit`. The
    /// cell that it starts in doesn't count.
    pub fn first(&self, grid: &Voxels, limit: f32, steps: &mut usize) -> Option<(f32, i32)> {
        let bricks = grid.bricks().map(|n| n as i32);
        let all = bricks.map(|n| 4 * n);
        let mut event = self.enters([0; 3], all);
        if event >= self.leaves([0; 3], all) {
            return None;
        }
        let mut cell = self.cell(event, [0; 3], all, false);
        loop {
            if event.0 >= limit || (0..3).any(|axis| cell[axis] as u32 >= all[axis] as u32) {
                return None;
            }
            *steps += 1;
            let [x, y, z] = cell;
            let brick = grid.brick((((z >> 2) * bricks[1] + (y >> 2)) * bricks[0] + (x >> 2)) as usize);
            if brick >> (x & 3 | (y & 3) << 2 | (z & 3) << 4) & 1 == 1 && event.0 > 0.0 {
                return Some(event);
            }
            if brick == 0 {
                let from = [x & -4, y & -4, z & -4];
                event = self.leaves(from, [4; 3]);
                cell = self.cell(event, from, [4; 3], true);
            } else {
                event = self.leaves(cell, [1; 3]);
                let axis = event.1 as usize;
                cell[axis] += if self.direction[axis] > 0.0 { 1 } else { -1 };
            }
        }
    }
}

/// Where `rays` come to a solid cell before `limit`. The parts are the axes across which they do.
#[inline(never)]
pub fn voxels(rays: &Rays8, grid: &Voxels, limit: F, counters: &mut Counters) -> Span {
    let mut span = Span::MISS;
    let [lo, hi] = grid.bounds();
    // With room for what rounds differently there.
    let room = grid.cell * 1e-3;
    let (enter, exit) = rays.in_box(lo - room, hi + room, limit);
    let mut todo = enter.simd_le(exit).to_bitmask();
    let (origin, direction) = (grid.in_cells(rays.origin), rays.direction * splat(1.0 / grid.cell));
    let mut steps = 0;
    while todo != 0 {
        let lane = todo.trailing_zeros() as usize;
        todo &= todo - 1;
        let walk = Walk::new(origin.lane(lane), direction.lane(lane));
        if let Some((t, axis)) = walk.first(grid, limit.as_array()[lane & 7], &mut steps) {
            span.enter.as_mut_array()[lane & 7] = t;
            span.enter_part.as_mut_array()[lane & 7] = axis as f32;
        }
    }
    counters.add(Counter::VoxelSteps, steps);
    Span { exit: span.enter, exit_part: span.enter_part, ..span }
}

/// A point of a grid's face.
pub struct Face {
    /// Put back onto the face, world.
    pub point: V3,
    /// Unit vector out of the solid cell.
    pub outward: V3,
    /// Value of that cell.
    pub value: F,
    /// The number of the plane, and the value: equal where one face goes on into the next.
    pub plane: F,
    /// Factor on the cell's colour and its own light.
    pub shade: F,
}

/// The face across the axis `part` near `p`, seen along `direction` by rays whose footprints there are
/// `width` wide, world units.
#[inline(never)]
pub fn locate(grid: &Voxels, p: V3, direction: V3, part: u32, width: F) -> Face {
    let mut q = grid.in_cells(p);
    let mut outward = V3::ZERO;
    let pick = |v: &mut V3, f: &mut dyn FnMut(&mut F)| {
        f(match part {
            0 => &mut v.x,
            1 => &mut v.y,
            _ => &mut v.z,
        })
    };
    let mut along = direction;
    let mut back = F::ZERO;
    pick(&mut along, &mut |d| back = d.simd_gt(F::ZERO).select(splat(-1.0), F::ONE));
    pick(&mut outward, &mut |n| *n = back);
    let mut plane = F::ZERO;
    pick(&mut q, &mut |x| {
        plane = (*x + splat(0.5)).floor();
        *x = plane;
    });
    let point = V3::splat(grid.lo) + q * splat(grid.cell);
    let middle = q - outward * splat(0.5);
    let value = grid.values(middle);
    let ([x, y, z], within) = noise::cell(middle);
    let sharp = splat(grid.cell) / width.fast_max(splat(1e-3 * grid.cell));
    let open = |x: F| {
        let inside = x.fast_min(F::ONE - x) - splat(0.5 * grid.groove);
        (inside * sharp + splat(0.5)).fast_max(F::ZERO).fast_min(F::ONE)
    };
    let own = unit_x8(mix_x8(mix_x8(x, y), z)) * splat(grid.variation);
    let shade = open(within.x) * open(within.y) * open(within.z) * (F::ONE - own);
    Face { point, outward, value, plane: plane + value * splat(256.0), shade }
}

#[cfg(test)]
mod tests;
