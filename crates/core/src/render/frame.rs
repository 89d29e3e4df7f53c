//! Rendering a frame: a pure function of scene, frame number, quality and size.

use super::Stage;
use crate::counters::Counters;
use crate::post;
use crate::quality::Quality;
use crate::sample::{Borders, Scratch, TILE, Tile, refine, smooth_edges};
use crate::scene::Scene;
use rayon::prelude::*;

/// Buffers that live from frame to frame.
#[derive(Default)]
pub struct Renderer {
    tiles: Vec<Tile>,
    /// What the last frame did; all 0 without the feature `counters`.
    pub counters: Counters,
}

impl Renderer {
    /// Renders frame `n` of a scene as 0RGB rows, top to bottom, into `pixels`, which must hold
    /// `width * height` of them. `n` only seeds the grain.
    pub fn frame(
        &mut self,
        scene: &Scene,
        n: u64,
        (width, height): (u32, u32),
        quality: &Quality,
        pixels: &mut [u32],
    ) {
        let stage = Stage::new(scene, quality, width, height);
        let across = (width as usize).div_ceil(TILE);
        let down = (height as usize).div_ceil(TILE);
        self.tiles.resize_with(across * down, Tile::default);
        let corner = |i: usize| (i % across * TILE, i / across * TILE);

        let borders: Vec<(Borders, Counters)> = self
            .tiles
            .par_iter_mut()
            .enumerate()
            .map_init(Scratch::default, |scratch, (i, tile)| {
                scratch.counters = Counters::default();
                (refine(&stage, scratch, corner(i), tile), scratch.counters)
            })
            .collect();
        let border = |x: usize, y: usize| {
            if x > 0 && y > 0 { borders[(y - 1) * across + x - 1].0 } else { Borders::default() }
        };
        let more: Vec<Counters> = self
            .tiles
            .par_iter_mut()
            .enumerate()
            .map_init(Scratch::default, |scratch, (i, tile)| {
                scratch.counters = Counters::default();
                let (x, y) = (i % across, i / across);
                let near = [border(x, y + 1), border(x + 1, y), border(x, y)];
                smooth_edges(&stage, scratch, corner(i), tile, near);
                scratch.counters
            })
            .collect();
        self.counters = Counters::default();
        for counters in borders.iter().map(|b| &b.1).chain(&more) {
            self.counters.merge(counters);
        }
        post::finish(&stage, &self.tiles, n, pixels);
    }
}
