//! The cells of a grid that a ray passes.

use super::{Ray, first};
use crate::math::Vec3;
use crate::math::lanes::{Bound, F, splat};
use crate::scene::Voxels;
use crate::trace::Walk;

/// A cell on a ray's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// Place in the grid.
    pub cell: [i32; 3],
    /// Distance at which the ray enters it, in lengths of its direction; 0 for the cell it begins in.
    pub enter: f32,
}

/// The cells of side 1 between the origin and `size` (at most [`Voxels::MOST`] a side) that a ray passes, in
/// order. Amanatides and Woo 1987.
///
/// Neighbours in the list share a face. Where a ray meets an edge or a corner, a face across x comes before
/// one across y, and that before one across z; a ray along a face is in the cell above it; one that begins on
/// a face is in the cell that it goes into. Each distance is within 4 u of (face - origin) / direction, for
/// origins at most 1e5 cells away.
pub fn walk(ray: &Ray, size: [usize; 3]) -> Vec<Visit> {
    let mut visits = Vec::new();
    let size = size.map(|n| n.min(Voxels::MOST) as f32);
    let packet = ray.packet();
    let rays = &packet.rays;
    let (room, hi) = (Vec3::splat(crate::trace::ROOM), Vec3::from_array(size));
    // What is farther is so by a level direction only.
    let (begin, end) = rays.in_box(-room, hi + room, splat(1e25));
    let walk = Walk::new(rays.origin, rays.direction);
    let mut cell: [F; 3] = std::array::from_fn(|axis| walk.place(axis, begin));
    let mut enter = F::ZERO;
    for _ in 0..crate::trace::MOST_STEPS {
        let (leave, across) = walk.leave(&cell);
        let place = cell.map(first);
        let inside = (0..3).all(|axis| place[axis] >= 0.0 && place[axis] < size[axis]);
        if inside && first(leave) > 0.0 {
            visits.push(Visit { cell: place.map(|x| x as i32), enter: packet.length(first(enter)) });
        }
        // Also ends where a number is NaN.
        if !(first(begin) <= first(end) && first(leave) < first(end)) {
            break;
        }
        enter = leave.at_least(F::ZERO);
        cell = std::array::from_fn(|axis| walk.next(cell[axis], axis, across[axis]));
    }
    visits
}
