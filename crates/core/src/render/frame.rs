//! Rendering a frame: a pure function of scene, frame number, quality and size.

use super::Stage;
use crate::counters::Counters;
use crate::features;
use crate::math::sampling::r2;
use crate::parallel;
use crate::post::Post;
use crate::quality::Quality;
use crate::sample::{Scratch, TILE, Tile, beams, refine, share_edges, smoke, smooth_edges};
use crate::scene::Scene;
use crate::sim::{Simulation, Volume};
use crate::study::Phase;
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
    post: Post,
    simulation: Simulation,
    volume: Volume,
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
        let mut stage = Stage::new(scene, quality, width, height);
        self.counters = Counters::default();
        if let Some(smoke) = scene.smoke.as_ref().filter(|_| features::SMOKE) {
            self.simulation.run(smoke, &mut self.counters);
            let eye = scene.camera.position;
            self.volume.light(smoke, &self.simulation, &stage.lamps, eye, &mut self.counters);
            stage.volume = Some(&self.volume);
        }
        let across = (width as usize).div_ceil(TILE);
        let down = (height as usize).div_ceil(TILE);
        self.tiles.resize_with(across * down, Tile::default);
        let pool = &self.scratch;
        // Edges are shared out after the first pass, which finds them.
        let passes: [(Pass, bool); 4] =
            [(refine, true), (smooth_edges, false), (smoke, false), (beams, false)];
        let mut sums = Vec::new();
        for pattern in 0..quality.average {
            // The first pattern lies in the middle of the pixels.
            (stage.pattern, stage.shift) = (pattern, r2(pattern) - 0.5);
            for (pass, finds_edges) in passes {
                parallel::each(self.tiles.iter_mut(), |i, tile| {
                    let mut scratch = pool.take();
                    scratch.counters = Counters::start(&stage.quality.study, Phase::Sampling);
                    pass(&stage, &mut scratch, (i % across * TILE, i / across * TILE), tile);
                    scratch.counters.watch.stop();
                    tile.counters = scratch.counters;
                    pool.give(scratch);
                });
                if finds_edges {
                    share_edges(&mut self.tiles, across);
                }
                for tile in &self.tiles {
                    self.counters.merge(&tile.counters);
                }
            }
            if quality.average > 1 {
                average(&mut self.tiles, &mut sums, pattern + 1);
            }
        }
        self.counters.merge(&self.post.finish(&stage, &self.tiles, n, pixels));
    }
}

/// Adds the light of the tiles to `sums`, and puts the mean of all `count` so far in its place.
fn average(tiles: &mut [Tile], sums: &mut Vec<f32>, count: u32) {
    let share = 1.0 / count as f32;
    sums.resize(tiles.len() * 3 * TILE * TILE, 0.0);
    for (k, tile) in tiles.iter_mut().enumerate() {
        for (i, plane) in tile.rgb.iter_mut().enumerate() {
            let sums = &mut sums[(3 * k + i) * TILE * TILE..];
            for (light, sum) in plane.iter_mut().zip(sums) {
                *sum += *light;
                *light = *sum * share;
            }
        }
    }
}
