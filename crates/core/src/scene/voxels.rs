//! Solid cells on a grid, each of one of up to 254 materials, and what can be done to them.
//!
//! A grid is made by rules: every change is a function of a cell's place and what is there. Bricks of
//! 4x4x4 cells hold a bit for each solid cell, so a ray asks one word for 64 of them.

use super::Field;
use crate::math::hash::{hash2, mix, unit};
use crate::math::lanes::{F, TRUE, V3, splat};
use crate::math::{Vec3, number};
use crate::trace::distance;

/// A grid of voxels; the cells are kept with the bricks, so they change only by [`Voxels::edit`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Voxels {
    /// Least corner, world.
    pub lo: Vec3,
    /// Side of a cell, world units.
    pub cell: f32,
    /// Material of cells of value 1; those of the next value have the next, and so on.
    pub material: usize,
    /// Width of the dark grooves between cells, as a share of a cell's side; 0 is still a line as wide as a pixel,
    /// less than 0 none.
    pub groove: f32,
    /// How much the colours of cells differ, 0 to 1.
    pub variation: f32,
    size: [usize; 3],
    cells: Vec<u8>,
    bricks: Vec<u64>,
    bounds: [Vec3; 2],
}

/// What is done to each cell of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edit {
    /// Empty cells become solid.
    Add(u8),
    /// Cells become empty.
    Remove,
    /// Solid cells change their value.
    Paint(u8),
    /// About so many of 256 solid cells change their value; which, follows from the place and a seed.
    PaintRandomly(u8, u8, u32),
    /// All cells get a value.
    Overwrite(u8),
    /// Solid cells become [`Voxels::SMOKE`].
    Convert,
}

impl Voxels {
    /// Nothing there.
    pub const EMPTY: u8 = 0;
    /// No longer solid: it gives off smoke.
    pub const SMOKE: u8 = 255;
    /// Cells along a side, at most.
    pub const MOST: usize = 128;

    /// An empty grid of cells of side `cell` from the corner `lo` on.
    pub fn new(lo: Vec3, cell: f32, size: [usize; 3]) -> Self {
        let mut empty = Self::default();
        empty.reset(lo, cell, size);
        empty
    }

    /// Makes it [`Voxels::new`], in the room that it has.
    pub fn reset(&mut self, lo: Vec3, cell: f32, size: [usize; 3]) {
        let size = size.map(|n| n.min(Self::MOST));
        (self.lo, self.cell, self.size, self.bounds) = (lo, cell, size, [lo; 2]);
        (self.material, self.groove, self.variation) = (0, 0.0, 0.0);
        self.cells.clear();
        self.cells.resize(size.iter().product(), Self::EMPTY);
        self.bricks.clear();
        self.bricks.resize(size.iter().map(|n| n.div_ceil(4)).product(), 0);
    }

    /// Cells along each axis.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Bricks along each axis.
    pub fn bricks(&self) -> [usize; 3] {
        self.size.map(|n| n.div_ceil(4))
    }

    /// A bit for each solid cell of a brick: 1 << (x + 4 y + 16 z).
    #[inline(always)]
    pub fn brick(&self, at: usize) -> u64 {
        self.bricks[at]
    }

    /// The box around all solid cells, world.
    pub fn bounds(&self) -> [Vec3; 2] {
        self.bounds
    }

    /// The materials of its cells, and perhaps some that none of them has.
    pub fn materials(&self) -> std::ops::Range<usize> {
        let solid = self.cells.iter().filter(|&&value| Self::is_solid(value));
        self.material..self.material + solid.max().map_or(0, |&value| value.into())
    }

    /// What is at a place; nothing outside the grid.
    #[inline]
    pub fn get(&self, at: [i32; 3]) -> u8 {
        let [nx, ny, nz] = self.size;
        let [x, y, z] = at.map(|i| i as u32 as usize);
        if x < nx && y < ny && z < nz { self.cells[(z * ny + y) * nx + x] } else { Self::EMPTY }
    }

    /// Whether a value is that of a solid cell.
    #[inline(always)]
    pub fn is_solid(value: u8) -> bool {
        value.wrapping_add(1) > 1
    }

    /// Gives each cell the value that `rule` makes of place and value.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn edit_all_by(&mut self, rule: &mut dyn FnMut([i32; 3], u8) -> u8) {
        let [nx, ny, _] = self.size;
        let [bx, by, _] = self.bricks();
        self.bricks.fill(0);
        let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (i, value) in self.cells.iter_mut().enumerate() {
            let (x, y, z) = (i % nx, i / nx % ny, i / (nx * ny));
            *value = rule([x as i32, y as i32, z as i32], *value);
            if Self::is_solid(*value) {
                let corner = Vec3::new(number(x), number(y), number(z));
                (least, most) = (least.min(corner), most.max(corner + 1.0));
                self.bricks[(z / 4 * by + y / 4) * bx + x / 4] |= 1 << (x & 3 | (y & 3) << 2 | (z & 3) << 4);
            }
        }
        self.bounds = if least.x < most.x {
            [self.lo + least * self.cell, self.lo + most * self.cell]
        } else {
            [self.lo; 2]
        };
    }

    /// [`Voxels::edit_all_by`] for the cells with `lo <= place < hi`.
    pub fn edit_by(&mut self, lo: [i32; 3], hi: [i32; 3], rule: &mut dyn FnMut([i32; 3], u8) -> u8) {
        self.edit_all_by(&mut |at, value| {
            let within = (0..3).all(|axis| at[axis] >= lo[axis] && at[axis] < hi[axis]);
            if within { rule(at, value) } else { value }
        });
    }

    /// Does one of the usual things to each cell with `lo <= place < hi`.
    pub fn edit(&mut self, edit: Edit, lo: [i32; 3], hi: [i32; 3]) {
        self.edit_by(lo, hi, &mut |[x, y, z], value| {
            let solid = Self::is_solid(value);
            match edit {
                Edit::Add(new) if !solid => new,
                Edit::Remove => Self::EMPTY,
                Edit::Paint(new) if solid => new,
                Edit::PaintRandomly(new, share, seed) if solid => {
                    let bits = mix(mix(hash2(seed, x as u32), y as u32), z as u32);
                    if unit(bits) * 256.0 < share.into() { new } else { value }
                }
                Edit::Overwrite(new) => new,
                Edit::Convert if solid => Self::SMOKE,
                _ => value,
            }
        });
    }

    /// [`Voxels::edit`] over the whole grid.
    pub fn edit_all(&mut self, edit: Edit) {
        self.edit(edit, [0; 3], self.size.map(|n| n as i32));
    }

    /// [`Voxels::edit`] over the cells of one height.
    pub fn edit_layer(&mut self, edit: Edit, y: i32) {
        let [nx, _, nz] = self.size.map(|n| n as i32);
        self.edit(edit, [0, y, 0], [nx, y + 1, nz]);
    }

    /// Gives a value to all cells whose middles lie within a body.
    pub fn fill(&mut self, body: &Field, value: u8) {
        let (lo, cell) = (self.lo, self.cell);
        // Eight cells of a row at a time, as the rule comes by them in order.
        let mut eight = [0.0; 8];
        self.edit_all_by(&mut |[x, y, z], old| {
            if x & 7 == 0 {
                let middle = |i: f32| Vec3::new(x as f32 + i + 0.5, y as f32 + 0.5, z as f32 + 0.5);
                let p = V3::from_fn(|i| lo + middle(number(i)) * cell);
                eight = distance(body, p, &[TRUE; Field::MOST], None).to_array();
            }
            if eight[x as usize & 7] < 0.0 { value } else { old }
        });
    }

    /// The values of the solid cells that hold points, given in cells from the corner; 0 elsewhere.
    pub fn values(&self, cells: V3) -> F {
        let [x, y, z] = [cells.x, cells.y, cells.z].map(|c| c.to_array());
        let mut values = F::ZERO;
        for (lane, value) in values.as_mut_array().iter_mut().enumerate() {
            // Casts keep to the range of i32, and turn NaN into 0.
            let found = self.get([x[lane], y[lane], z[lane]].map(|c| c.floor() as i32));
            *value = if Self::is_solid(found) { found.into() } else { 0.0 };
        }
        values
    }

    /// Where points lie, in cells from the corner.
    pub fn in_cells(&self, p: V3) -> V3 {
        (p - V3::splat(self.lo)) * splat(1.0 / self.cell)
    }
}
