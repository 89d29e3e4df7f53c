//! A square of pixels that is sampled as one unit, and how each of its pixels was got.

use crate::counters::Counters;
use crate::math::Vec3;

/// Side of a tile, px.
pub const TILE: usize = 64;

/// How a pixel was got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// By its own ray.
    Traced = 0,
    /// By its own ray and additional ones.
    Smoothed = 1,
    /// Between samples of equal signature.
    Interpolated = 2,
    /// Between samples of equal colour.
    Filled = 3,
}

/// How a pixel was got, and the size of the cell it lay in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Record(pub u8);

impl Record {
    /// A pixel of a cell of `size` px (a power of two).
    pub fn new(kind: Kind, size: usize) -> Self {
        Self(kind as u8 | (size.trailing_zeros() as u8) << 2)
    }

    /// How the pixel was got.
    pub fn kind(self) -> Kind {
        [Kind::Traced, Kind::Smoothed, Kind::Interpolated, Kind::Filled][self.0 as usize & 3]
    }

    /// Side of the pixel's cell, px.
    pub fn size(self) -> usize {
        1 << (self.0 >> 2)
    }
}

/// Side of the grid of a tile's samples: one more than its pixels.
pub const GRID: usize = TILE + 1;

/// The finished linear light of a tile's pixels, row after row of [`TILE`].
pub struct Tile {
    /// Red, green and blue planes.
    pub rgb: [[f32; TILE * TILE]; 3],
    /// How each pixel was got.
    pub record: [Record; TILE * TILE],
    /// One over the depth of each pixel's surface along the view axis, 0 where there is none; not kept
    /// where the scene has no use for it.
    pub nearness: [f32; TILE * TILE],
    /// In which quadrants of a pixel, a bit each in reading order, there is an edge; by row, of which the last, as the
    /// last of each column, is the neighbour's.
    pub edges: [[u8; GRID]; GRID],
    /// What sampling it took.
    pub counters: Counters,
    /// Rays left and right of the scene's line, if it has one, in the last pass.
    pub rays: [u64; 2],
    /// Pixels that were measured, and the sum of their squared errors.
    pub measured: [f32; 2],
}

impl Default for Tile {
    fn default() -> Self {
        Self {
            rgb: [[0.0; TILE * TILE]; 3],
            record: [Record(0); TILE * TILE],
            nearness: [0.0; TILE * TILE],
            edges: [[0; GRID]; GRID],
            counters: Counters::default(),
            rays: [0; 2],
            measured: [0.0; 2],
        }
    }
}

/// Hands the edge pixels that tiles have found beyond their right and lower border on to the tiles
/// there, `across` to a row.
pub fn share_edges(tiles: &mut [Tile], across: usize) {
    for i in 0..tiles.len() {
        for (right, below) in [(1, 0), (0, 1), (1, 1)] {
            let to = i + right + below * across;
            if i % across + right == across || to >= tiles.len() {
                continue;
            }
            for k in 0..TILE {
                let (x, y) = (k * (1 - right), k * (1 - below));
                let found = tiles[i].edges[y + TILE * below][x + TILE * right];
                tiles[to].edges[y][x] |= found;
            }
        }
    }
}

impl Tile {
    /// Linear colour of the pixel at (x, y).
    pub fn get(&self, x: usize, y: usize) -> Vec3 {
        let i = y * TILE + x;
        Vec3::new(self.rgb[0][i], self.rgb[1][i], self.rgb[2][i])
    }

    /// The greatest and the least nearness of the surfaces in the square of `side` px that holds a
    /// pixel; 0 and infinity where only the background shows.
    pub fn reach(&self, (x, y): (usize, usize), side: usize) -> [f32; 2] {
        let side = side.min(TILE);
        let (left, top) = (x / side * side, y / side * side);
        let (mut nearest, mut farthest) = (0.0_f32, f32::INFINITY);
        for row in top..(top + side).min(TILE) {
            for &nearness in &self.nearness[row * TILE + left..row * TILE + (left + side).min(TILE)] {
                if nearness > 0.0 {
                    nearest = nearest.max(nearness);
                    farthest = farthest.min(nearness);
                }
            }
        }
        [nearest, farthest]
    }

    /// Sets the pixel at (x, y).
    pub fn set(&mut self, x: usize, y: usize, colour: Vec3, record: Record) {
        let i = y * TILE + x;
        for (plane, c) in self.rgb.iter_mut().zip(colour.to_array()) {
            plane[i] = c;
        }
        self.record[i] = record;
    }
}
