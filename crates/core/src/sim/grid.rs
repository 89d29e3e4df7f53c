//! Where the cells of a grid stand in memory, work on all of them, and what lies between them.
//!
//! Cells stand in rows along x, with a border of cells around everything that no work touches: so the
//! neighbours of every cell are there, and no kernel asks where it is. One border of eight cells serves the
//! end of a row and the beginning of the next. A field has eight numbers per element, which are those of one
//! cell or one number each of eight cells along x.

use crate::math::lanes::{Bound, F, splat};
use crate::math::number;
use crate::parallel;

/// Cells of the border before each row, and after the last.
pub const GAP: usize = 8;

/// An element of a field.
pub type Eight = [f32; 8];

/// Work on a row: its first cell's place, that cell's number, and the row. A trait of its own, as the table of a
/// `dyn Fn` holds each closure twice more.
pub trait Work: Sync {
    /// Does it.
    fn on(&self, place: [usize; 3], i: usize, row: &mut [Eight]);
}

impl<F: Fn([usize; 3], usize, &mut [Eight]) + Sync> Work for F {
    fn on(&self, place: [usize; 3], i: usize, row: &mut [Eight]) {
        self(place, i, row)
    }
}

/// Shape of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Grid {
    /// Cells along each axis, without the border; those along x are a multiple of 8.
    pub size: [usize; 3],
}

impl Grid {
    /// From one cell to its neighbour along each axis.
    #[inline(always)]
    pub fn steps(&self) -> [usize; 3] {
        let row = self.size[0] + GAP;
        [1, row, row * (self.size[1] + 2)]
    }

    /// Cells with the border.
    pub fn len(&self) -> usize {
        self.steps()[2] * (self.size[2] + 2) + GAP
    }

    /// Whether there is no room for a cell.
    pub fn is_empty(&self) -> bool {
        self.size.contains(&0)
    }

    /// Number of a cell; places count from the border's first.
    #[inline(always)]
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        let [_, row, slice] = self.steps();
        z * slice + y * row + GAP - 1 + x
    }

    /// Calls `work` for each row of `out` that isn't border, by slices on all threads; `cells` is how many an
    /// element stands for, 1 or 8.
    #[inline(never)]
    pub fn each(&self, out: &mut [Eight], cells: usize, work: &dyn Work) {
        let [_, row, slice] = self.steps();
        let [_, ny, nz] = self.size;
        parallel::each(out.chunks_mut(slice / cells).take(nz + 1), |z, out| {
            for (y, out) in out.chunks_mut(row / cells).enumerate() {
                if z > 0 && (1..=ny).contains(&y) {
                    let place = [1, y, z];
                    work.on(place, self.index(place), &mut out[GAP / cells..]);
                }
            }
        });
    }

    /// What a field of one cell per element holds at a point, in the first three lanes, between the eight
    /// cells around it. Points count cells as places do, and are bounded before they become whole numbers.
    #[inline(never)]
    pub fn sample(&self, field: &[Eight], at: F) -> F {
        let [x, y, z] = self.size.map(number);
        let most = F::new([x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let at = at.at_least(F::ZERO).at_most(most + F::ONE);
        let below = at.at_most(most).fast_trunc_int();
        let within = at - F::from_i32x8(below);
        let (below, within) = (below.as_array(), within.as_array());
        let first = self.index([below[0] as usize, below[1] as usize, below[2] as usize]);
        let [_, row, slice] = self.steps();
        let between = |a: F, b: F, axis: usize| a + (b - a) * splat(within[axis]);
        let line = |i: usize| between(F::new(field[i]), F::new(field[i + 1]), 0);
        let sheet = |i: usize| between(line(i), line(i + row), 1);
        between(sheet(first), sheet(first + slice), 2)
    }
}

/// The first three lanes of a vector.
#[inline(always)]
pub fn lanes([x, y, z]: [f32; 3]) -> F {
    F::new([x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0])
}
