//! Smoke in front of what the eye sees, put over a tile's finished pixels.
//!
//! Smoke is smooth where surfaces are not, so it has samples of its own: cells of pixels are split as
//! those of surfaces are, until the smoke between their corners is known. It ends at the surfaces, so a
//! cell is only interpolated if the depths of its pixels run evenly between its corners; those behind
//! all smoke count as one. So no silhouette has a halo, however coarse the cells are beside it.

use super::refine::Cell;
use super::tile::{GRID, TILE, Tile};
use super::wave::Scratch;
use crate::features;
use crate::math::Vec3;
use crate::math::lanes::{F, RAMP, V3, splat};
use crate::render::Stage;
use crate::sim::Volume;
use crate::trace::Rays8;
use glam::Vec4;

/// Share of a depth by which it may differ from what its cell's corners say.
const EVEN: f32 = 0.02;

/// Puts the smoke over the tile whose upper left pixel is `corner`.
#[inline(never)]
pub fn smoke(stage: &Stage, scratch: &mut Scratch, corner: (usize, usize), tile: &mut Tile) {
    let Some(volume) = stage.volume.filter(|_| features::SMOKE) else { return };
    let width = TILE.min(stage.width as usize - corner.0);
    let height = TILE.min(stage.height as usize - corner.1);
    let Some(farthest) = reach(stage, volume, corner) else { return };
    let size = stage.quality.cell(stage.height) as usize;
    let along = |end: usize| (0..TILE).step_by(size).take_while(move |x| *x < end);
    let mut cells = Vec::new();
    for y in along(height) {
        for x in along(width) {
            cells.push(Cell { x, y, size });
        }
    }
    scratch.grid.clear();
    scratch.grid.resize(GRID * GRID, u32::MAX);
    let mut samples: Vec<Vec4> = Vec::new();
    let mut done = 0;
    while done < cells.len() {
        let level = done..cells.len();
        done = level.end;
        let mut missing = Vec::new();
        for cell in &cells[level.clone()] {
            for (x, y) in (0..5).map(|i| cell.point(i)) {
                let slot = &mut scratch.grid[y * GRID + x];
                if *slot == u32::MAX {
                    *slot = (samples.len() + missing.len()) as u32;
                    missing.push((x, y));
                }
            }
        }
        for eight in missing.chunks(8) {
            let lane = |i: usize| eight[i.min(eight.len() - 1)];
            let x = F::new(std::array::from_fn(|i| (corner.0 + lane(i).0) as f32 + 0.5));
            let y = F::new(std::array::from_fn(|i| (corner.1 + lane(i).1) as f32 + 0.5));
            let rays = Rays8 { origin: V3::splat(stage.view.origin), direction: stage.directions(x, y) };
            let nearness = F::new(std::array::from_fn(|i| tile.nearness[own(lane(i))].max(farthest)));
            let end = F::ONE / (nearness * rays.direction.dot(V3::splat(stage.forward())));
            let (through, light) = volume.march(&rays, end, stage.quality.smoke, &mut scratch.counters);
            for i in 0..eight.len() {
                samples.push(light.lane(i).extend(through.as_array()[i]));
            }
        }
        for i in level {
            let cell = cells[i];
            let known = |i: usize| {
                let (x, y) = cell.point(i);
                samples[scratch.grid[y * GRID + x] as usize]
            };
            let known: [Vec4; 5] = std::array::from_fn(known);
            if cell.size > 1 && !(agree(stage, cell, &known, tile) && even(cell, tile, farthest)) {
                let half = Cell { size: cell.size / 2, ..cell };
                for (x, y) in (0..4).map(|i| half.point(i)) {
                    if x < width && y < height {
                        cells.push(Cell { x, y, ..half });
                    }
                }
            } else {
                cover(cell, &known, tile);
            }
        }
    }
}

/// One over the greatest depth of the smoke, if the tile may show any.
fn reach(stage: &Stage, volume: &Volume, corner: (usize, usize)) -> Option<f32> {
    let [lo, hi] = volume.bounds();
    if lo.x >= hi.x {
        return None;
    }
    let half = TILE as f32 * 0.5 + 1.0;
    let middle = stage.on_screen(corner.0 as f32 + half - 1.0, corner.1 as f32 + half - 1.0);
    let seen = crate::cull::Dop::aligned(&stage.view, [lo, hi])
        .meets_rectangle(middle, glam::Vec2::splat(half * stage.pixel));
    let forward = stage.forward();
    let far = Vec3::select(forward.cmpgt(Vec3::ZERO), hi, lo);
    let depth = (far - stage.view.origin).dot(forward);
    (seen && depth > 0.0).then(|| 1.0 / depth)
}

/// The pixel whose depth a sample takes; beyond the tile's border the last one before it.
fn own((x, y): (usize, usize)) -> usize {
    y.min(TILE - 1) * TILE + x.min(TILE - 1)
}

/// Whether the mean of the corners shows, over the middle pixel, as what is there.
fn agree(stage: &Stage, cell: Cell, known: &[Vec4; 5], tile: &Tile) -> bool {
    let [a, b, c, d, middle] = *known;
    let (x, y) = cell.point(4);
    let behind = tile.get(x, y);
    let over = |smoke: Vec4| stage.display.map(behind * smoke.w + Vec3::from_vec4(smoke));
    let error = (over((a + b + c + d) * 0.25) - over(middle)).abs().max_element();
    error <= stage.quality.tolerance
}

/// Whether depths run evenly over a cell. Over a plane, one over the depth does; whatever lies behind all
/// smoke lies at its end.
fn even(cell: Cell, tile: &Tile, farthest: f32) -> bool {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| tile.nearness[own(cell.point(i))].max(farthest));
    let scale = 1.0 / cell.size as f32;
    (0..cell.size * cell.size).all(|i| {
        let (column, row) = (i % cell.size, i / cell.size);
        let (x, y) = (column as f32 * scale, row as f32 * scale);
        let (upper, lower) = (a + (b - a) * x, c + (d - c) * x);
        let between = upper + (lower - upper) * y;
        let nearness = tile.nearness[(cell.y + row) * TILE + cell.x + column].max(farthest);
        (nearness - between).abs() <= EVEN * nearness
    })
}

/// Puts what is known at the corners of a cell over its pixels.
fn cover(cell: Cell, known: &[Vec4; 5], tile: &mut Tile) {
    let [a, b, c, d, _] = *known;
    if [a, b, c, d].iter().all(|s| *s == Vec4::W) {
        return;
    }
    let scale = 1.0 / cell.size as f32;
    let x = RAMP * splat(scale);
    for row in 0..cell.size {
        let y = row as f32 * scale;
        let (left, right) = (a + (c - a) * y, b + (d - b) * y);
        for column in (0..cell.size).step_by(8) {
            let x = x + splat(column as f32 * scale);
            let between = |i: usize| splat(left[i]) + splat(right[i] - left[i]) * x;
            let at = (cell.y + row) * TILE + cell.x + column;
            let count = cell.size.min(8);
            for (i, plane) in tile.rgb.iter_mut().enumerate() {
                let mut behind = F::ZERO;
                behind.as_mut_array()[..count].copy_from_slice(&plane[at..at + count]);
                let sum = behind * between(3) + between(i);
                plane[at..at + count].copy_from_slice(&sum.as_array()[..count]);
            }
        }
    }
}
