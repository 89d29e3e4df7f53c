//! Rendering a frame: a pure function of scene, frame number, quality and size.

use super::{Stage, Tables};
use crate::counters::Counters;
use crate::features;
use crate::math::sampling::r2;
use crate::parallel;
use crate::post::{KEEPS, Post};
use crate::quality::Quality;
use crate::sample::{Scratch, TILE, Tile, beams, refine, share_edges, smooth_edges};
use crate::scene::{Effect, Figures, Scene};
use crate::sim::{Room, Simulation, Volume};
use crate::study::Phase;
use std::mem::take;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Work on the tile whose upper left pixel is given.
type Pass = fn(&Stage, &mut Scratch, (usize, usize), &mut Tile);

/// Whether the threads' buffers are made alike after each frame. The size build has no room for that: there they
/// grow alike within a few frames.
const EVEN: bool = cfg!(not(luc_size));

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

    /// Has a buffer for each thread, and in each the room that the largest tile took: which thread comes by that
    /// one next time isn't known.
    fn even(&mut self) {
        let list = self.0.get_mut().unwrap_or_else(PoisonError::into_inner);
        let threads = list.len().max(rayon::current_num_threads());
        list.resize_with(threads, Scratch::default);
        Scratch::even(list);
    }

    /// Does `pass` on all tiles, and adds what it counted.
    fn run(&self, stage: &Stage, pass: Pass, tiles: &mut [Tile], counters: &mut Counters) {
        let across = (stage.width as usize).div_ceil(TILE);
        parallel::each(tiles.iter_mut(), |i, tile| {
            let mut scratch = self.take();
            scratch.counters = Counters::start(&stage.quality.study, Phase::Sampling);
            pass(stage, &mut scratch, (i % across * TILE, i / across * TILE), tile);
            scratch.counters.watch.stop();
            tile.counters = scratch.counters;
            self.give(scratch);
        });
        for tile in tiles {
            counters.merge(&tile.counters);
        }
    }
}

/// What the two sides of a split frame cost so far.
#[derive(Default)]
struct Ledger {
    rays: [u64; 2],
    measured: [f32; 2],
}

impl Ledger {
    /// Takes from the tiles what they counted in a pass.
    fn enter(&mut self, tiles: &mut [Tile]) {
        for tile in tiles {
            for side in 0..2 {
                self.rays[side] += take(&mut tile.rays[side]);
                self.measured[side] += take(&mut tile.measured[side]);
            }
        }
    }

    /// Mean squared error of a channel's display value.
    fn error(&self) -> f32 {
        self.measured[1] / (3.0 * self.measured[0]).max(1.0)
    }
}

/// Beams on black, before everything.
fn bare_beams(stage: &Stage, scratch: &mut Scratch, corner: (usize, usize), tile: &mut Tile) {
    tile.rgb = [[0.0; TILE * TILE]; 3];
    tile.nearness = [0.0; TILE * TILE];
    beams(stage, scratch, corner, tile);
}

/// Buffers that live from frame to frame: a frame like the last one takes nothing from the heap.
#[derive(Default)]
pub struct Renderer {
    tiles: Vec<Tile>,
    tables: Tables,
    scratch: Pool,
    post: Post,
    simulation: Simulation,
    smoke: Room,
    /// The sum of the patterns of a still that averages several.
    sums: Vec<f32>,
    /// What is written over a split frame.
    titles: Option<Box<Scene>>,
    /// What the last frame did; all 0 without the feature `counters`.
    pub counters: Counters,
}

impl Renderer {
    /// Renders frame `n` of a scene as 0RGB rows, top to bottom, into `pixels`, which must hold
    /// `width * height` of them. `n` only seeds the grain.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn frame(
        &mut self,
        scene: &Scene,
        n: u64,
        (width, height): (u32, u32),
        quality: &Quality,
        pixels: &mut [u32],
    ) {
        self.counters = Counters::start(&quality.study, Phase::SmokeStep);
        let volume = scene.smoke.as_ref().filter(|_| features::SMOKE).map(|smoke| {
            self.simulation.run(smoke, &mut self.counters);
            Volume::new(smoke, &self.simulation, &mut self.smoke, &mut self.counters)
        });
        self.counters.watch.stop();
        let mut stage = Stage::new(scene, quality, [width, height], &mut self.tables);
        stage.volume = volume.as_ref();
        let across = (width as usize).div_ceil(TILE);
        let down = (height as usize).div_ceil(TILE);
        self.tiles.resize_with(across * down, Tile::default);
        let pool = &self.scratch;
        // Edges are shared out after the first pass, which finds them.
        let passes: [(Pass, bool); 3] = [(refine, true), (smooth_edges, false), (beams, false)];
        self.sums.clear();
        let mut ledger = Ledger::default();
        let patterns = if features::AVERAGE { quality.average } else { 1 };
        for pattern in 0..patterns {
            // The first pattern lies in the middle of the pixels.
            (stage.pattern, stage.shift) = (pattern, r2(pattern) - 0.5);
            for (pass, finds_edges) in passes {
                pool.run(&stage, pass, &mut self.tiles, &mut self.counters);
                if finds_edges {
                    share_edges(&mut self.tiles, across);
                }
                if features::SPLIT {
                    ledger.enter(&mut self.tiles);
                }
            }
            if patterns > 1 {
                average(&mut self.tiles, &mut self.sums, pattern + 1);
            }
        }
        let kept = KEEPS && (scene.effects.iter().any(Effect::runs) || scene.split.is_some());
        if kept {
            self.counters.merge(&self.post.keep(&stage, &self.tiles, n));
        }
        // What is written over the picture are beams, in the same tiles.
        let mut lit = !kept;
        if let Some(split) = scene.split.filter(|_| features::SPLIT) {
            let titles = self.titles.get_or_insert_with(|| Box::new(Scene::new()));
            titles.beams.clear();
            let aspect = height as f32 / width as f32;
            let (rays, error) = (ledger.rays, ledger.error());
            let figures = Figures { split, height: aspect, rays, error };
            (titles.camera, titles.grade) = (split.titles)(&figures, &mut titles.beams);
            if !titles.beams.is_empty() {
                stage = Stage::new(titles, quality, [width, height], &mut self.tables);
                pool.run(&stage, bare_beams, &mut self.tiles, &mut self.counters);
                lit = true;
            }
        }
        let lit = lit.then_some(&self.tiles[..]);
        self.counters.merge(&self.post.finish(scene, &stage, kept, lit, n, pixels));
        if EVEN {
            self.scratch.even();
        }
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
