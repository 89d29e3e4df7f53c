//! Bloom: light over a threshold, blurred over several octaves and added to the picture.
//!
//! What passes: with l the largest channel of the exposed colour (clamped at 12), T the threshold
//! and a knee of 0.5, the share max(l - T, (l - T + 0.5)² / 2 for |l - T| < 0.5) / l. It is averaged
//! over squares of 2^k px such that the picture has about 270 lines, so the glow's width follows
//! the picture's size; each further octave has half the lines. Each is blurred by a binomial filter
//! of seven taps (sigma 1.22 px), and the octaves are joined bilinearly with weights 0.35, 0.28,
//! 0.22 and 0.15 (after Jimenez 2014, with fixed weights).

use crate::math::lanes::{F, RAMP, V3, from_bits, pick, splat, splat_u};
use crate::parallel;
use crate::render::Stage;
use crate::sample::{TILE, Tile};

use std::sync::atomic::{AtomicBool, Ordering};

/// Lines of the first octave, about.
const LINES: u32 = 270;
const WEIGHTS: [f32; 4] = [0.35, 0.28, 0.22, 0.15];
const KNEE: f32 = 0.5;
const LIMIT: f32 = 12.0;
/// The seven taps of the blur: row six of Pascal's triangle.
const TAPS: [f32; 7] =
    [1.0 / 64.0, 6.0 / 64.0, 15.0 / 64.0, 20.0 / 64.0, 15.0 / 64.0, 6.0 / 64.0, 1.0 / 64.0];
/// Rows that are gathered as one piece of work: waking a thread costs more than a few rows.
const ROWS: usize = 16;
/// Values that are blurred as one piece of work.
const PIECE: usize = 1 << 15;
/// Values before and after each row that repeat its ends.
const PAD: usize = 8;
/// Rows above and below the picture that repeat its first and last: the reach of the taps.
const REACH: usize = 3;

/// A small picture of linear light. Each row holds its red, then its green, then its blue values;
/// around the picture its edges are repeated.
#[derive(Default)]
pub struct Glow {
    width: usize,
    height: usize,
    light: Vec<f32>,
    /// The light blurred along the rows, on the way to both ways.
    along: Vec<f32>,
    /// Side of its pixels, px of the picture: a power of two.
    pub scale: usize,
}

impl Glow {
    /// Gives it this size; what it holds is then still to be written.
    fn reset(&mut self, width: usize, height: usize, scale: usize) {
        (self.width, self.height, self.scale) = (width, height, scale);
        let length = self.line() * (height + 2 * REACH);
        if self.light.len() != length {
            self.light = vec![0.0; length];
            self.along = vec![0.0; length];
        }
    }

    /// Distance between the colours of a row.
    fn stride(&self) -> usize {
        self.width + 2 * PAD + 8
    }

    /// Distance between rows.
    fn line(&self) -> usize {
        3 * self.stride()
    }

    /// Where the red values of row `y` are, from column `x` on.
    fn at(&self, x: usize, y: usize) -> usize {
        (REACH + y) * self.line() + PAD + x
    }

    /// Repeats the edges.
    #[inline(never)]
    fn pad(&mut self) {
        let (width, stride, line) = (self.width, self.stride(), self.line());
        for row in self.light.chunks_mut(stride) {
            let (first, last) = (row[PAD], row[PAD + width - 1]);
            row[..PAD].fill(first);
            row[PAD + width..].fill(last);
        }
        for k in 0..REACH {
            self.light.copy_within(REACH * line..(REACH + 1) * line, k * line);
            let last = (REACH + self.height - 1) * line;
            self.light.copy_within(last..last + line, last + (k + 1) * line);
        }
    }

    /// Blurs along the rows, then along the columns.
    fn blur(&mut self) {
        let line = self.line();
        self.pad();
        spread(&self.light, &mut self.along, 1);
        spread(&self.along, &mut self.light, line);
        self.pad();
    }

    /// The next octave: squares of four averaged.
    fn half(&self, half: &mut Glow) {
        half.reset(self.width.div_ceil(2), self.height.div_ceil(2), self.scale * 2);
        for y in 0..half.height {
            for colour in 0..3 {
                // One past the end is what repeats the end.
                let upper = &self.light[self.at(0, 2 * y) + colour * self.stride()..];
                let lower = &upper[self.line()..];
                let out = half.at(0, y) + colour * half.stride();
                for x in 0..half.width {
                    let sum = (upper[2 * x] + upper[2 * x + 1]) + (lower[2 * x] + lower[2 * x + 1]);
                    half.light[out + x] = sum * 0.25;
                }
            }
        }
    }

    /// Adds the octave below, times `weight`, to this one times `own`.
    fn join(&mut self, below: &Glow, own: f32, weight: f32) {
        let stride = self.stride();
        for y in 0..self.height {
            for x in (0..self.width.div_ceil(8)).map(|i| 8 * i) {
                // Seen from the octave above it, a pixel is two wide.
                let add = below.light(x, y, 2) * splat(weight);
                for (colour, add) in [add.x, add.y, add.z].into_iter().enumerate() {
                    let at = self.at(x, y) + colour * stride;
                    let to = &mut self.light[at..at + 8];
                    to.copy_from_slice((load(to, 0) * splat(own) + add).as_array());
                }
            }
        }
        self.pad();
    }

    /// Light at eight pixels, from (x, y) on, of a picture `scale` times as large, bilinearly.
    #[inline(never)]
    pub fn light(&self, x: usize, y: usize, scale: usize) -> V3 {
        // The position among the glow's pixels: exact, as the scale is a power of two.
        let place = |p: F| ((p + splat(0.5)) * splat(1.0 / scale as f32) - splat(0.5)).fast_max(F::ZERO);
        let (u, v) = (place(splat(x as f32) + RAMP), place(splat(y as f32)));
        let (columns, row) = (u.floor(), v.floor());
        let (fx, fy) = (u - columns, v - row);
        let first = columns.as_array()[0];
        let start = self.at(first as usize, row.as_array()[0] as usize);
        let offsets = (columns - splat(first)).trunc_int().cast_unsigned();
        let colour = |k: usize| {
            let upper = &self.light[start + k * self.stride()..];
            let a = load(upper, 0);
            if scale == 1 {
                return a;
            }
            // Eight pixels lie on six columns at most.
            let near = a + (load(&upper[self.line()..], 0) - a) * fy;
            let left = pick(near, offsets);
            left + (pick(near, offsets + splat_u(1)) - left) * fx
        };
        V3::new(colour(0), colour(1), colour(2))
    }
}

/// Filters values that lie `step` apart; `REACH` of them at either end of `out` stay as they are.
#[inline(never)]
fn spread(from: &[f32], out: &mut [f32], step: usize) {
    let inside = REACH * step..from.len() - REACH * step;
    parallel::each(out[inside].chunks_mut(PIECE), |piece, out| {
        for (i, eight) in out.chunks_exact_mut(8).enumerate() {
            let taps = TAPS.into_iter().enumerate();
            let sum = taps.fold(F::ZERO, |sum, (k, tap)| {
                sum + load(from, piece * PIECE + 8 * i + k * step) * splat(tap)
            });
            eight.copy_from_slice(sum.as_array());
        }
    });
}

/// Eight numbers from `at` on.
#[inline(always)]
fn load(plane: &[f32], at: usize) -> F {
    F::new(plane[at..at + 8].try_into().unwrap_or_default())
}

/// Gathers the light over the threshold in the first octave; false if there is no such light.
fn bright(stage: &Stage, tiles: &[Tile], glow: &mut Glow) -> bool {
    let grade = &stage.scene.grade;
    // At most eight, so that eight pixels in a row always lie on the columns in the same way.
    let step = (stage.height / LINES).clamp(1, 8).ilog2();
    let side = 1_usize << step;
    let (w, h) = (stage.width as usize, stage.height as usize);
    let across = w.div_ceil(TILE);
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
                let tile = &tiles[y / TILE * across + x / TILE];
                let at = (y % TILE) * TILE + x % TILE;
                let colour = tile.rgb.each_ref().map(|p| {
                    let v = load(p, at) * splat(grade.exposure);
                    v.fast_max(F::ZERO).fast_min(splat(LIMIT))
                });
                let most = colour[0].fast_max(colour[1]).fast_max(colour[2]);
                let over = most - splat(grade.bloom_threshold);
                let knee = splat(KNEE);
                if !over.simd_gt(-knee).any() {
                    continue;
                }
                any.store(true, Ordering::Relaxed);
                let soft = (over + knee).fast_max(F::ZERO).fast_min(knee + knee);
                let share = over.fast_max(soft * soft * splat(0.5 / (2.0 * KNEE)));
                // What the tile holds beyond the picture's right side doesn't count.
                let inside = from_bits((0xff_u32 >> (8 - (w - x).min(8))) as u8);
                let share = (share / most.fast_max(splat(1e-6)) * splat(mean)) & inside;
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
pub struct Bloom([Glow; WEIGHTS.len()]);

impl Bloom {
    /// The glow to add to the exposed picture, if there is any.
    #[inline(never)]
    pub fn glow(&mut self, stage: &Stage, tiles: &[Tile]) -> Option<&Glow> {
        let amount = stage.scene.grade.bloom;
        if amount <= 0.0 || !bright(stage, tiles, &mut self.0[0]) {
            return None;
        }
        let last = stage.quality.study.octaves(WEIGHTS.len()) - 1;
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
        self.0.first()
    }
}
