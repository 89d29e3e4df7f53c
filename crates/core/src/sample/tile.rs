//! A square of pixels that is sampled as one unit, and how each of its pixels was got.

use glam::Vec3;

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

/// Edge pixels of the neighbours to the right and below that this tile has found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Borders {
    /// Bit y: the pixel at (64, y).
    pub right: u64,
    /// Bit x: the pixel at (x, 64).
    pub bottom: u64,
    /// The pixel at (64, 64).
    pub corner: bool,
}

/// The finished linear light of a tile's pixels, row after row of [`TILE`].
pub struct Tile {
    /// Red, green and blue planes.
    pub rgb: [Vec<f32>; 3],
    /// How each pixel was got.
    pub record: Vec<Record>,
    /// One over the depth of each pixel's surface along the view axis, 0 where there is none; empty
    /// if the scene doesn't ask for it.
    pub nearness: Vec<f32>,
    /// Bit x of word y: the pixel lies on an edge.
    pub edges: [u64; TILE],
}

impl Default for Tile {
    fn default() -> Self {
        Self {
            rgb: std::array::from_fn(|_| vec![0.0; TILE * TILE]),
            record: vec![Record::default(); TILE * TILE],
            nearness: Vec::new(),
            edges: [0; TILE],
        }
    }
}

impl Tile {
    /// Linear colour of the pixel at (x, y).
    pub fn get(&self, x: usize, y: usize) -> Vec3 {
        let i = y * TILE + x;
        Vec3::new(self.rgb[0][i], self.rgb[1][i], self.rgb[2][i])
    }

    /// Notes the depth of the surface at (x, y), if that is asked for.
    pub fn set_nearness(&mut self, x: usize, y: usize, nearness: f32) {
        if let Some(place) = self.nearness.get_mut(y * TILE + x) {
            *place = nearness;
        }
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
