//! Additional samples where the tiles found edges: anti-aliasing where it is needed, nowhere else.
//!
//! A cell of one pixel's side, between the middles of four pixels, that an edge runs through lies in one quadrant of
//! each. Such quadrants are sampled, one sample each placed like the men of a turned grid, no two in a row or column;
//! for the other quadrants the pixel's middle stands. So an upright edge, which two quadrants of a pixel see, passes
//! two samples one by one. Where a preset samples all pixels, the samples are the points of [`spread`].
//!
//! Colours are averaged as c / (1 + max(c)), so that a bright light behind an edge doesn't swallow the edge
//! (Karis 2014); the same for all presets.

use super::refine::Cell;
use super::tile::{Kind, Record, TILE, Tile};
use super::wave::{Scratch, trace};
use crate::counters::Counter;
use crate::math::sampling::spread;
use crate::math::{Vec3, number};
use crate::quality::Quality;
use crate::render::Stage;
use glam::Vec2;

/// Samples that are traced at once: keeps the lists in the cache.
const BATCH: usize = 1024;

/// Point `i` of `count` in a quadrant of the unit square: on its diagonal that runs round the middle, so that those of
/// all four fill `4 * count` rows and columns.
fn in_quadrant(quadrant: u32, i: u32, count: u32) -> Vec2 {
    let middle = Vec2::new(number(quadrant as usize & 1), number(quadrant as usize >> 1)) * 0.5 - 0.25;
    let along = (2 * i + 1) as f32 / (2 * count) as f32;
    0.5 + middle + middle.perp() * if i & 1 == 0 { along } else { -along }
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
    let Quality { samples: all, edge_samples: each, .. } = stage.quality;
    let most = if all > 0 { all } else { 4 * each };
    if most == 0 {
        return;
    }
    let share = 1.0 / (most + u32::from(all > 0)) as f32;
    let width = TILE.min(stage.width as usize - corner.0);
    let height = TILE.min(stage.height as usize - corner.1);
    for side in stage.sides() {
        let before = scratch.counters.rays();
        // The size of these cells is the quadrants to be sampled: so their list needs no room of its own.
        let mut pixels = std::mem::take(&mut scratch.cells);
        pixels.clear();
        for y in 0..height {
            for x in 0..width {
                let quadrants = if all > 0 { 15 } else { tile.edges[y][x] };
                if quadrants > 0 && stage.side(corner.0 + x, corner.1 + y) == side {
                    pixels.push(Cell { x, y, size: usize::from(quadrants) });
                }
            }
        }
        let candidates = stage.candidates(corner, TILE);
        for batch in pixels.chunks((BATCH / most as usize).max(1)) {
            scratch.positions.clear();
            for &Cell { x, y, size: quadrants } in batch {
                for i in 0..most {
                    let quadrant = i & 3;
                    let offset = match all {
                        0 if quadrants >> quadrant & 1 == 0 => continue,
                        0 => in_quadrant(quadrant, i >> 2, each),
                        _ => spread(i + 1),
                    };
                    let at = (number(corner.0 + x) + offset.x, number(corner.1 + y) + offset.y);
                    scratch.positions.push(at);
                }
            }
            scratch.samples.0.clear();
            trace(stage, scratch, candidates);
            scratch.counters.add(Counter::EdgeSamples, scratch.positions.len());
            let mut next = 0;
            for &Cell { x, y, size: quadrants } in batch {
                let count = if all > 0 { all } else { quadrants.count_ones() * each };
                let mut sum = compress(tile.get(x, y)) * (1.0 - number(count as usize) * share);
                for _ in 0..count {
                    sum += compress(scratch.samples.get(next).colour()) * share;
                    next += 1;
                }
                tile.set(x, y, expand(sum), Record::new(Kind::Smoothed, 1));
            }
        }
        scratch.cells = pixels;
        tile.rays[side] = scratch.counters.rays() - before;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_all_quadrants_fill_rows_and_columns() {
        for count in 1..=4_u32 {
            let side = 4 * count;
            let mut taken = [vec![false; side as usize], vec![false; side as usize]];
            for (quadrant, i) in (0..4).flat_map(|q| (0..count).map(move |i| (q, i))) {
                let p = in_quadrant(quadrant, i, count);
                assert_eq!([p.x > 0.5, p.y > 0.5], [quadrant & 1 == 1, quadrant > 1], "{p} of {quadrant}");
                for (axis, taken) in taken.iter_mut().enumerate() {
                    let place = &mut taken[(p[axis] * side as f32) as usize];
                    assert!(!std::mem::replace(place, true), "{count} a quadrant: {p} stands behind another");
                }
            }
        }
    }
}
