//! Rays against voxels: a [`Walk`] from face to face, eight rays at a time, that takes bricks without a solid
//! cell in one step.
//!
//! Where a walk begins, or leaves an empty brick, its cell is that of a point a little before, and the faces
//! that still come lead on from there; so it meets the very cells of a walk by cells.

use super::walk::Walk;
use super::{Rays8, Span};
use crate::counters::{Counter, Counters};
use crate::math::hash::{mix_x8, unit_x8};
use crate::math::lanes::{Bound, F, V3, from_bits, splat};
use crate::math::noise;
use crate::math::{Vec3, number};
use crate::scene::Voxels;

/// How far before its faces a walk looks for its cell, in cells: more than rounding moves a point.
pub const ROOM: f32 = 0.01;

/// Steps of a walk, at most: more than across any grid.
pub const MOST_STEPS: usize = 4 * Voxels::MOST;

/// Where `rays` come to the first face of a solid cell before `limit`. The parts are the axes across which
/// they do. The cell that a ray starts in doesn't count.
#[inline(never)]
pub fn voxels(rays: &Rays8, grid: &Voxels, limit: F, counters: &mut Counters) -> Span {
    let mut span = Span::MISS;
    let [lo, hi] = grid.bounds();
    let (mut now, exit) = rays.in_box(lo - grid.cell * ROOM, hi + grid.cell * ROOM, limit);
    let mut busy = now.simd_le(exit);
    let walk = Walk::new(grid.in_cells(rays.origin), rays.direction * splat(1.0 / grid.cell));
    let room = walk.inverse.iter().fold(splat(f32::INFINITY), |room, i| room.at_most(i.abs())) * splat(ROOM);
    let mut cell: [F; 3] = std::array::from_fn(|axis| walk.place(axis, now));
    // How far bricks have been taken: along a face, rounding may put a ray back across it, to leave again.
    let mut past = now;
    for _ in 0..MOST_STEPS {
        let across;
        (now, across) = walk.leave(&cell);
        busy &= now.simd_lt(exit);
        if !busy.any() {
            break;
        }
        let (mut index, mut bit, mut inside) = (F::ZERO, F::ZERO, busy);
        let mut from = cell;
        for axis in [2, 1, 0] {
            cell[axis] = walk.next(cell[axis], axis, across[axis]);
            let bricks = splat(number(grid.bricks()[axis]));
            let brick = (cell[axis] * splat(0.25)).floor();
            from[axis] = brick * splat(4.0);
            inside &= brick.simd_ge(F::ZERO) & brick.simd_lt(bricks);
            index = index * bricks + brick;
            bit = bit * splat(4.0) + (cell[axis] - from[axis]);
        }
        let [index, bit] = [index, bit].map(|x| x.fast_trunc_int().to_array());
        let (mut solid, mut empty) = (0, 0);
        let mut todo = inside.to_bitmask();
        counters.add(Counter::VoxelSteps, todo.count_ones() as usize);
        while todo != 0 {
            let lane = todo.trailing_zeros() as usize & 7;
            todo &= todo - 1;
            let brick = grid.brick(index[lane] as usize);
            solid |= ((brick >> bit[lane] & 1) as u8) << lane;
            empty |= u8::from(brick == 0) << lane;
        }
        let hit = from_bits(solid) & now.simd_gt(F::ZERO);
        span.enter = hit.select(now, span.enter);
        span.enter_part = hit.select((across[1] & F::ONE) + (across[2] & splat(2.0)), span.enter_part);
        busy &= !hit;
        let [x, y, z] = walk.far(&from, 4.0);
        let leave = x.at_most(y).at_most(z) - room;
        let skip = from_bits(empty) & leave.simd_gt(now.at_least(past) + room);
        past = skip.select(leave, past);
        for axis in 0..3 {
            let last = walk.place(axis, leave).at_least(from[axis]).at_most(from[axis] + splat(3.0));
            cell[axis] = skip.select(last, cell[axis]);
        }
    }
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
    let axis = V3::splat(Vec3::AXES[part as usize % 3]);
    let outward = axis * direction.dot(axis).simd_gt(F::ZERO).select(splat(-1.0), F::ONE);
    let q = grid.in_cells(p);
    // The sum is exact: the point lies next to the plane.
    let along = q.dot(axis);
    let plane = (along + splat(0.5)).floor();
    let q = q + axis * (plane - along);
    let point = V3::splat(grid.lo) + q * splat(grid.cell);
    let middle = q - outward * splat(0.5);
    let value = grid.values(middle);
    let ([x, y, z], within) = noise::cell(middle);
    let sharp = splat(grid.cell) / width.at_least(splat(1e-3 * grid.cell));
    let open = |x: F| {
        let inside = x.at_most(F::ONE - x) - splat(0.5 * grid.groove);
        (inside * sharp + splat(0.5)).at_least(F::ZERO).at_most(F::ONE)
    };
    let own = unit_x8(mix_x8(mix_x8(x, y), z)) * splat(grid.variation);
    let shade = open(within.x) * open(within.y) * open(within.z) * (F::ONE - own);
    Face { point, outward, value, plane: plane + value * splat(256.0), shade }
}

#[cfg(test)]
mod tests;
