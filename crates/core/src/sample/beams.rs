//! Beams as the eye sees them, added to a tile's finished pixels in blocks of eight by eight.
//!
//! They are thin and bright, so nothing is interpolated: each pixel has its own ray, which ends at
//! the depth of the pixel's surface.

use super::tile::{TILE, Tile};
use super::wave::Scratch;
use crate::counters::Counter;
use crate::features;
use crate::math::lanes::{F, RAMP, V3, load, splat};
use crate::math::number;
use crate::render::Stage;
use crate::shade::beam;
use crate::trace::Rays8;
use glam::Vec2;

/// Side of a block, px.
const BLOCK: usize = 8;

/// Adds the beams to the tile whose upper left pixel is `corner`.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn beams(stage: &Stage, scratch: &mut Scratch, corner: (usize, usize), tile: &mut Tile) {
    if !features::BEAMS {
        return;
    }
    let forward = V3::splat(stage.forward());
    // A square's middle on the plane one unit ahead of the eye, and its half sides.
    let square = |corner: (usize, usize), side: usize| {
        let half = 0.5 * number(side);
        let middle = stage.on_screen(number(corner.0) + half, number(corner.1) + half);
        (middle, Vec2::splat(half * stage.pixel))
    };
    let meets = |i: usize, (middle, half): (Vec2, Vec2)| stage.beams[i].meets_rectangle(middle, half);
    // Beams that meet the tile, and behind them those that meet a block of it.
    let Scratch { beams: met, counters, .. } = scratch;
    met.clear();
    met.extend((0..stage.beams.len()).filter(|&i| meets(i, square(corner, TILE))));
    let of_tile = met.len();
    for block in 0..(TILE / BLOCK) * (TILE / BLOCK) {
        let (x, y) = (block % (TILE / BLOCK) * BLOCK, block / (TILE / BLOCK) * BLOCK);
        let (left, top) = (number(corner.0 + x), number(corner.1 + y));
        let here = square((corner.0 + x, corner.1 + y), BLOCK);
        met.truncate(of_tile);
        for k in 0..of_tile {
            if meets(met[k], here) {
                met.push(met[k]);
            }
        }
        let of_block = &met[of_tile..];
        if of_block.is_empty() {
            continue;
        }
        counters.add(Counter::Beams, BLOCK * BLOCK * of_block.len());
        for row in 0..BLOCK {
            let at = (y + row) * TILE + x;
            let direction = stage.directions(splat(left + 0.5) + RAMP, splat(top + 0.5 + number(row)));
            let rays = Rays8 { origin: V3::splat(stage.scene.camera.position), direction };
            let end = F::ONE / (load(&tile.nearness[at..]) * direction.dot(forward));
            let [red, green, blue] = tile.rgb.each_ref().map(|plane| load(&plane[at..]));
            let mut sum = V3::new(red, green, blue);
            for &i in of_block {
                sum += beam(&stage.scene.beams[i], &rays, splat(stage.pixel), end);
            }
            for (plane, sum) in tile.rgb.iter_mut().zip([sum.x, sum.y, sum.z]) {
                plane[at..at + 8].copy_from_slice(sum.as_array());
            }
        }
    }
}
