//! Rendering a frame: a pure function of scene, frame number, quality and size.

use super::Stage;
use crate::counters::Counters;
use crate::post::Bloom;
use crate::quality::Quality;
use crate::sample::{Scratch, TILE, Tile, beams, refine, share_edges, smooth_edges};
use crate::scene::Scene;
use crate::{parallel, post};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Work on the tile whose upper left pixel is given.
type Pass = fn(&Stage, &mut Scratch, (usize, usize), &mut Tile);

/// Buffers of the threads at work, handed out and taken back.
#[derive(Default)]
struct Pool(Mutex<Vec<Scratch>>);

impl Pool {
    fn list(&self) -> MutexGuard<'_, Vec<Scratch>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn take(&self) -> Scratch {
        self.list().pop().unwrap_or_default()
    }

    fn give(&self, scratch: Scratch) {
        self.list().push(scratch);
    }
}

/// Buffers that live from frame to frame.
#[derive(Default)]
pub struct Renderer {
    tiles: Vec<Tile>,
    scratch: Pool,
    bloom: Bloom,
    /// What the last frame did; all 0 without the feature `counters`.
    pub counters: Counters,
}

impl Renderer {
    /// Renders frame `n` of a scene as 0RGB rows, top to bottom, into `pixels`, which must hold
    /// `width * height` of them. `n` only seeds the grain.
    #[inline(never)]
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
        let pool = &self.scratch;
        let passes: [Pass; 3] = [refine, smooth_edges, beams];
        self.counters = Counters::default();
        for pass in passes {
            parallel::each(self.tiles.iter_mut(), |i, tile| {
                let mut scratch = pool.take();
                scratch.counters = Counters::default();
                pass(&stage, &mut scratch, (i % across * TILE, i / across * TILE), tile);
                tile.counters = scratch.counters;
                pool.give(scratch);
            });
            share_edges(&mut self.tiles, across);
            for tile in &self.tiles {
                self.counters.merge(&tile.counters);
            }
        }
        self.counters.merge(&post::finish(&stage, &self.tiles, &mut self.bloom, n, pixels));
    }
}
