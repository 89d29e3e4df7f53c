//! Bloom: light over a threshold, blurred over several octaves and added to the picture.
//!
//! What passes: with l the largest channel of the exposed colour (clamped at 12), T the threshold
//! and a knee of 0.5, the share max(l - T, (l - T + 0.5)² / 2 for |l - T| < 0.5) / l. It is averaged
//! over squares of 2^k px such that the picture has about 270 lines, so the glow's width follows
//! the picture's size; each further octave has half the lines. Each is blurred by a binomial filter
//! of seven taps (sigma 1.22 px), and the octaves are joined bilinearly with weights 0.35, 0.28,
//! 0.22 and 0.15 (after Jimenez 2014, with fixed weights).

use crate::math::lanes::{F, V3, from_bits, splat};
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
/// Values before and after each row that repeat its ends.
const PAD: usize = 8;

/// A small picture of linear light: red, green and blue planes.
#[derive(Default)]
pub struct Glow {
    width: usize,
    height: usize,
    planes: [Vec<f32>; 3],
    /// The planes blurred along the rows, on the way to both ways.
    along: [Vec<f32>; 3],
    /// Side of its pixels, px of the picture: a power of two.
    scale: usize,
}

impl Glow {
    /// Makes it black, of this size.
    fn reset(&mut self, width: usize, height: usize, scale: usize) {
        (self.width, self.height, self.scale) = (width, height, scale);
        let length = self.stride() * height;
        for plane in self.planes.iter_mut().chain(&mut self.along) {
            plane.clear();
            plane.resize(length, 0.0);
        }
    }

    fn stride(&self) -> usize {
        self.width + 2 * PAD + 8
    }

    /// Repeats the ends of each row.
    fn pad(&mut self) {
        let (width, stride) = (self.width, self.stride());
        for row in self.planes.iter_mut().flat_map(|p| p.chunks_mut(stride)) {
            let (first, last) = (row[PAD], row[PAD + width - 1]);
            row[..PAD].fill(first);
            row[PAD + width..].fill(last);
        }
    }

    /// Blurs along the rows, then along the columns.
    fn blur(&mut self) {
        self.pad();
        let (width, height, stride) = (self.width, self.height, self.stride());
        parallel::run(self.planes.iter_mut().zip(&mut self.along).map(|(plane, along)| {
            move || {
                for (out, row) in along.chunks_mut(stride).zip(plane.chunks(stride)) {
                    for x in (PAD..PAD + width).step_by(8) {
                        let sum = (0..7).fold(F::ZERO, |sum, k| sum + load(row, x + k - 3) * splat(TAPS[k]));
                        out[x..x + 8].copy_from_slice(sum.as_array());
                    }
                }
                for (y, out) in plane.chunks_mut(stride).enumerate() {
                    for x in (PAD..PAD + width).step_by(8) {
                        let sum = (0..7).fold(F::ZERO, |sum, k| {
                            let y = (y + k).saturating_sub(3).min(height - 1);
                            sum + load(along, y * stride + x) * splat(TAPS[k])
                        });
                        out[x..x + 8].copy_from_slice(sum.as_array());
                    }
                }
            }
        }));
        self.pad();
    }

    /// The next octave: squares of four averaged.
    fn half(&self, half: &mut Glow) {
        half.reset(self.width.div_ceil(2), self.height.div_ceil(2), self.scale * 2);
        let (stride, out_stride) = (self.stride(), half.stride());
        for (out, plane) in half.planes.iter_mut().zip(&self.planes) {
            for y in 0..half.height {
                let rows = [2 * y, (2 * y + 1).min(self.height - 1)].map(|y| &plane[y * stride + PAD..]);
                for x in 0..half.width {
                    // One past the end is padding that repeats the end.
                    let sum: f32 = rows.iter().map(|r| r[2 * x] + r[2 * x + 1]).sum();
                    out[y * out_stride + PAD + x] = sum * 0.25;
                }
            }
        }
    }

    /// Adds the octave below, times `weight`, to this one times `own`.
    fn join(&mut self, below: &mut Glow, own: f32, weight: f32) {
        // Seen from the octave above it, a pixel is two wide.
        below.scale = 2;
        let (width, stride) = (self.width, self.stride());
        let mut line = Line::default();
        for y in 0..self.height {
            below.row(y, &mut line);
            for x in (0..width).step_by(8) {
                let add = line.at(x) * splat(weight);
                for (plane, add) in self.planes.iter_mut().zip([add.x, add.y, add.z]) {
                    let to = &mut plane[y * stride + PAD + x..][..8];
                    to.copy_from_slice((load(to, 0) * splat(own) + add).as_array());
                }
            }
        }
        self.pad();
    }

    /// The two rows around row `y` of a picture that is `scale` times as large, joined linearly,
    /// into `line`.
    pub fn row(&self, y: usize, line: &mut Line) {
        let scale = self.scale;
        let (row, fy) = place(y, scale);
        let (row, below) = (row.min(self.height - 1), (row + 1).min(self.height - 1));
        let stride = self.stride();
        line.offsets = std::array::from_fn(|i| place(i + scale, scale).0);
        line.fractions = F::new(std::array::from_fn(|i| place(i + scale, scale).1));
        line.step = scale.trailing_zeros();
        for (plane, out) in self.planes.iter().zip(&mut line.planes) {
            out.resize(stride, 0.0);
            for x in (0..stride - 7).step_by(8) {
                let (a, b) = (load(plane, row * stride + x), load(plane, below * stride + x));
                out[x..x + 8].copy_from_slice((a + (b - a) * splat(fy)).as_array());
            }
        }
    }
}

/// Pixel left of (above) pixel `p` of a picture `scale` times as large, and how far `p` lies beyond.
fn place(p: usize, scale: usize) -> (usize, f32) {
    let v = ((p as f32 + 0.5) / scale as f32 - 0.5).max(0.0);
    (v as usize, v - (v as usize) as f32)
}

/// Eight numbers from `at` on.
#[inline(always)]
fn load(plane: &[f32], at: usize) -> F {
    F::new(plane[at..at + 8].try_into().unwrap_or_default())
}

/// A row of a glow, ready to be read at the pixels of a larger picture.
#[derive(Default)]
pub struct Line {
    planes: [Vec<f32>; 3],
    /// Columns of eight pixels from a multiple of eight on, counted from one column before.
    offsets: [usize; 8],
    fractions: F,
    step: u32,
}

impl Line {
    /// Values at eight pixels, from `x` on, a multiple of eight.
    pub fn at(&self, x: usize) -> V3 {
        let base = PAD + (x >> self.step) - 1;
        let value = |plane: &Vec<f32>| {
            let near = &plane[base..base + 10];
            let a = F::new(self.offsets.map(|o| near[o]));
            let b = F::new(self.offsets.map(|o| near[o + 1]));
            a + (b - a) * self.fractions
        };
        let [r, g, b] = &self.planes;
        V3 { x: value(r), y: value(g), z: value(b) }
    }
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
    let stride = glow.stride();
    let [r, g, b] = &mut glow.planes;
    let some = stride * ROWS;
    let strips = r.chunks_mut(some).zip(g.chunks_mut(some)).zip(b.chunks_mut(some));
    let mean = 1.0 / (side * side) as f32;
    let any = AtomicBool::new(false);
    parallel::run(strips.enumerate().map(|(strip, ((r, g), b))| {
        let any = &any;
        move || {
            let mut lit = false;
            for y in (strip * ROWS * side..).take(ROWS * side).take_while(|y| *y < h) {
                let line = (y / side - strip * ROWS) * stride + PAD;
                for x in (0..w).step_by(8) {
                    let tile = &tiles[y / TILE * across + x / TILE];
                    let at = (y % TILE) * TILE + x % TILE;
                    let [cr, cg, cb] = tile.rgb.each_ref().map(|p| {
                        let v = load(p, at) * splat(grade.exposure);
                        v.fast_max(F::ZERO).fast_min(splat(LIMIT))
                    });
                    let most = cr.fast_max(cg).fast_max(cb);
                    let over = most - splat(grade.bloom_threshold);
                    let knee = splat(KNEE);
                    if !over.simd_gt(-knee).any() {
                        continue;
                    }
                    lit = true;
                    let soft = (over + knee).fast_max(F::ZERO).fast_min(knee + knee);
                    let share = over.fast_max(soft * soft * splat(0.5 / (2.0 * KNEE)));
                    // What the tile holds beyond the picture's right side doesn't count.
                    let inside = from_bits((0xff_u32 >> (8 - (w - x).min(8))) as u8);
                    let share = (share / most.fast_max(splat(1e-6)) * splat(mean)) & inside;
                    for (plane, c) in [(&mut *r, cr), (&mut *g, cg), (&mut *b, cb)] {
                        let light = (c * share).to_array();
                        let sums = &mut plane[line + (x >> step)..];
                        for (sum, part) in sums.iter_mut().zip(light.chunks_exact(side)) {
                            *sum += part.iter().sum::<f32>();
                        }
                    }
                }
            }
            if lit {
                any.store(true, Ordering::Relaxed);
            }
        }
    }));
    any.into_inner()
}

/// The octaves, which live from frame to frame.
#[derive(Default)]
pub struct Bloom([Glow; WEIGHTS.len()]);

impl Bloom {
    /// The glow to add to the exposed picture, if there is any.
    pub fn glow(&mut self, stage: &Stage, tiles: &[Tile]) -> Option<&Glow> {
        let amount = stage.scene.grade.bloom;
        if amount <= 0.0 || !bright(stage, tiles, &mut self.0[0]) {
            return None;
        }
        let last = WEIGHTS.len() - 1;
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
            upper[level].join(&mut lower[0], WEIGHTS[level] * amount, weight);
        }
        self.0.first()
    }
}
