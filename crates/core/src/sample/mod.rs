//! Where to trace: adaptive subsampling of a frame, tile by tile.
//!
//! Each tile is refined on its own from finished samples only, level by level over work lists, so
//! the result depends neither on threads nor on order. Pixels on edges are found by all tiles
//! first and get their additional samples in a second pass.

mod beams;
mod block;
mod edges;
mod glint;
mod interpolate;
mod rays;
mod refine;
mod scatter;
mod tile;
mod wave;

pub use beams::beams;
pub use edges::smooth_edges;
pub use refine::refine;
pub use scatter::ROUGH;
pub use tile::{Kind, Record, TILE, Tile, share_edges};
pub use wave::Scratch;
