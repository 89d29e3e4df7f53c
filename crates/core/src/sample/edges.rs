//! Additional samples where the tiles found edges: anti-aliasing where it is needed, nowhere else.
//!
//! Sample i of a pixel lies at the i-th point of [`spread`], whose first is the pixel's centre. Edges of little
//! contrast take half as many: what they are off by is seen as little. Colours are averaged as c / (1 + max(c)), so
//! that a bright light behind an edge doesn't swallow the edge (Karis 2014); the same for all presets.

use super::refine::Cell;
use super::tile::{Kind, Record, TILE, Tile};
use super::wave::{Position, Scratch, trace};
use crate::counters::Counter;
use crate::math::sampling::spread;
use crate::math::{Vec3, number};
use crate::render::Stage;

/// Samples that are traced at once: keeps the lists in the cache.
const BATCH: usize = 1024;

/// Position of sample `i` of the pixel at (x, y).
fn place(x: usize, y: usize, i: u32) -> Position {
    let offset = spread(i);
    (number(x) + offset.x, number(y) + offset.y)
}

fn compress(c: Vec3) -> Vec3 {
    c / (1.0 + c.max_element())
}

fn expand(c: Vec3) -> Vec3 {
    c / (1.0 - c.max_element()).max(1e-4)
}

/// Takes more samples of the tile's edge pixels.
#[cfg_attr(luc_size, optimize(size))]
pub fn smooth_edges(stage: &Stage, scratch: &mut Scratch, corner: (usize, usize), tile: &mut Tile) {
    let all = stage.quality.samples;
    let edge = stage.quality.edge_samples.max(all);
    if edge == 0 {
        return;
    }
    // By what is known of the pixel's edges.
    let counts = [all, all.max(edge / 2), edge, edge];
    let width = TILE.min(stage.width as usize - corner.0);
    let height = TILE.min(stage.height as usize - corner.1);
    for side in stage.sides() {
        let before = scratch.counters.rays();
        // The size of these cells is the number of their samples: so their list needs no room of its own.
        let mut pixels = std::mem::take(&mut scratch.cells);
        pixels.clear();
        for y in 0..height {
            for x in 0..width {
                let count = counts[usize::from(tile.edges[y][x]) & 3];
                if count > 0 && stage.side(corner.0 + x, corner.1 + y) == side {
                    pixels.push(Cell { x, y, size: count as usize });
                }
            }
        }
        let candidates = stage.candidates(corner, TILE);
        for batch in pixels.chunks((BATCH / edge as usize).max(1)) {
            scratch.positions.clear();
            for &Cell { x, y, size: count } in batch {
                for i in 0..count {
                    scratch.positions.push(place(corner.0 + x, corner.1 + y, i as u32 + 1));
                }
            }
            scratch.samples.0.clear();
            trace(stage, scratch, candidates);
            scratch.counters.add(Counter::EdgeSamples, scratch.positions.len());
            let mut next = 0;
            for &Cell { x, y, size: count } in batch {
                let mut sum = compress(tile.get(x, y));
                for _ in 0..count {
                    sum += compress(scratch.samples.get(next).colour());
                    next += 1;
                }
                let colour = expand(sum / number(count + 1));
                tile.set(x, y, colour, Record::new(Kind::Smoothed, 1));
            }
        }
        scratch.cells = pixels;
        tile.rays[side] = scratch.counters.rays() - before;
    }
}
