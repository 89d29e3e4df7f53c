//! Bloom: light over a threshold, blurred over several octaves and added to the picture.
//!
//! What passes: with l the largest channel of the exposed colour (clamped at 12), T the threshold
//! and a knee of 0.5, the share max(l - T, (l - T + 0.5)² / 2 for |l - T| < 0.5) / l. It is averaged
//! over squares of 2^k px such that the picture has about 270 lines, so the glow's width follows
//! the picture's size; each further octave has half the lines. Each is blurred by a binomial filter
//! of seven taps (sigma 1.22 px), and the octaves are joined bilinearly with weights 0.35, 0.28,
//! 0.22 and 0.15 (after Jimenez 2014, with fixed weights).

use super::picture::{LIMIT, PAD, Picture, REACH, ROWS};
use crate::math::lanes::{Bound, F, V3, from_bits, load, splat};
use crate::parallel;
use crate::render::Stage;
use crate::sample::{TILE, Tile};
use std::sync::atomic::{AtomicBool, Ordering};

/// Lines of the first octave, about.
const LINES: u32 = 270;
const WEIGHTS: [f32; 4] = [0.35, 0.28, 0.22, 0.15];
const KNEE: f32 = 0.5;

/// Gathers the light over the threshold in the first octave; false if there is no such light. `read`
/// gives eight pixels from a place on.
fn bright(
    [w, h]: [usize; 2],
    threshold: f32,
    read: impl Fn(usize, usize) -> V3 + Sync,
    glow: &mut Picture,
) -> bool {
    // At most eight, so that eight pixels in a row always lie on the columns in the same way.
    let step = (h as u32 / LINES).clamp(1, 8).ilog2();
    let side = 1_usize << step;
    glow.reset(w.div_ceil(side), h.div_ceil(side), side);
    let (stride, line) = (glow.stride(), glow.line());
    let mean = 1.0 / (side * side) as f32;
    let any = AtomicBool::new(false);
    let rows = &mut glow.light[REACH * line..];
    rows.fill(0.0);
    parallel::each(rows.chunks_mut(ROWS * line), |strip, rows| {
        let first = strip * ROWS * side;
        for y in first..h.min(first + ROWS * side) {
            for x in (0..w.div_ceil(8)).map(|i| 8 * i) {
                let V3 { x: r, y: g, z: b } = read(x, y);
                let colour = [r, g, b].map(|v| v.at_least(F::ZERO).at_most(splat(LIMIT)));
                let most = colour[0].at_least(colour[1]).at_least(colour[2]);
                let over = most - splat(threshold);
                let knee = splat(KNEE);
                if !over.simd_gt(-knee).any() {
                    continue;
                }
                any.store(true, Ordering::Relaxed);
                let soft = (over + knee).at_least(F::ZERO).at_most(knee + knee);
                let share = over.at_least(soft * soft * splat(0.5 / (2.0 * KNEE)));
                // What is held beyond the picture's right side doesn't count.
                let inside = from_bits((0xff_u32 >> (8 - (w - x).min(8))) as u8);
                let share = (share / most.at_least(splat(1e-6)) * splat(mean)) & inside;
                for (k, c) in colour.into_iter().enumerate() {
                    let sums = &mut rows[((y - first) >> step) * line + k * stride + PAD + (x >> step)..];
                    for (sum, part) in sums.iter_mut().zip((c * share).as_array().chunks_exact(side)) {
                        *sum += part.iter().sum::<f32>();
                    }
                }
            }
        }
    });
    any.into_inner()
}

/// The octaves, which live from frame to frame.
#[derive(Default)]
pub struct Bloom([Picture; WEIGHTS.len()]);

impl Bloom {
    /// The glow to add to the exposed picture, if there is any.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn glow(&mut self, stage: &Stage, tiles: &[Tile]) -> Option<&Picture> {
        let grade = &stage.scene.grade;
        let across = (stage.width as usize).div_ceil(TILE);
        let read = |x: usize, y: usize| {
            let tile = &tiles[y / TILE * across + x / TILE];
            let at = (y % TILE) * TILE + x % TILE;
            let [x, y, z] = tile.rgb.each_ref().map(|p| load(&p[at..]) * splat(grade.exposure));
            V3 { x, y, z }
        };
        let octaves = stage.quality.study.octaves(WEIGHTS.len());
        let shine = (grade.bloom_threshold, grade.bloom, octaves);
        self.of([stage.width as usize, stage.height as usize], shine, read)
    }

    /// The glow of a picture of this size for a threshold, an amount (which one octave alone
    /// doesn't heed) and a number of octaves.
    pub fn of(
        &mut self,
        size: [usize; 2],
        (threshold, amount, octaves): (f32, f32, usize),
        read: impl Fn(usize, usize) -> V3 + Sync,
    ) -> Option<&Picture> {
        if amount <= 0.0 || !bright(size, threshold, read, &mut self.0[0]) {
            return None;
        }
        self.spread(amount, octaves);
        self.0.first()
    }

    /// Blurs the first octaves, and joins them in the first.
    fn spread(&mut self, amount: f32, octaves: usize) {
        let last = octaves - 1;
        for level in 0..=last {
            let (upper, lower) = self.0.split_at_mut(level + 1);
            upper[level].blur();
            if let Some(next) = lower.first_mut() {
                upper[level].half(next);
            }
        }
        // From the smallest up, each octave takes in the one below it at its own resolution.
        for level in (0..last).rev() {
            let (upper, lower) = self.0.split_at_mut(level + 1);
            let weight = if level + 1 == last { WEIGHTS[last] * amount } else { 1.0 };
            upper[level].join(&lower[0], WEIGHTS[level] * amount, weight);
        }
    }
}
