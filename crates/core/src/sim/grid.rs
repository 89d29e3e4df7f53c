//! Where the cells of a grid stand in memory: rows along x, with empty cells around everything.
//!
//! The border makes neighbours of every cell be there, so no kernel asks where it is. One border of
//! eight cells serves the end of a row and the beginning of the next.

use crate::parallel;

/// Empty cells before each row, and after the last.
pub const GAP: usize = 8;

/// Work on a row: where its first cell is, that cell's number, and what is made of the row.
pub type Row<'a, T> = dyn Fn([usize; 3], usize, &mut [T]) + Sync + 'a;

/// Shape of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Grid {
    /// Cells along each axis, without the border.
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

    /// Number of a cell.
    #[inline(always)]
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        let [_, row, slice] = self.steps();
        (z + 1) * slice + (y + 1) * row + GAP + x
    }

    /// The cell below a point, and where between it and the next the point lies along each axis, from 0
    /// to 1. Points count cells from the middle of the border's first cell. They are bounded before they
    /// become whole numbers.
    #[inline(always)]
    pub fn corner(&self, at: [f32; 3]) -> ([usize; 3], [f32; 3]) {
        let (mut cell, mut within) = ([0; 3], [0.0; 3]);
        for axis in 0..3 {
            let most = self.size[axis] as f32;
            let at = at[axis].max(0.0).min(most + 1.0);
            cell[axis] = at.min(most) as i32 as usize;
            within[axis] = at - cell[axis] as f32;
        }
        (cell, within)
    }

    /// Number of a cell that is counted from the border's first.
    #[inline(always)]
    pub fn bordered(&self, [x, y, z]: [usize; 3]) -> usize {
        let [_, row, slice] = self.steps();
        z * slice + y * row + x + GAP - 1
    }

    /// Calls `work` for each row, with the row of `out`, by slices on all threads.
    #[inline(never)]
    pub fn rows<T: Send>(&self, out: &mut [T], work: &Row<T>) {
        let [_, row, slice] = self.steps();
        let [nx, ny, nz] = self.size;
        parallel::each(out.chunks_mut(slice).skip(1).take(nz), |z, out| {
            for (y, out) in out.chunks_mut(row).skip(1).take(ny).enumerate() {
                work([0, y, z], self.index([0, y, z]), &mut out[GAP..GAP + nx]);
            }
        });
    }
}
