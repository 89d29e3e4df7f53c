//! Bloom: light over a threshold, blurred over several octaves and added to the picture.
//!
//! What passes: with l the largest channel of the exposed colour (clamped at 12), T the threshold
//! and a knee of 0.5, the share max(l - T, (l - T + 0.5)² / 2 for |l - T| < 0.5) / l. It is averaged
//! over squares of 2^k px such that the picture has about 270 lines, so the glow's width follows
//! the picture's size; each further octave has half the lines. Each is blurred by a binomial filter
//! of seven taps (sigma 1.22 px), and the octaves are joined bilinearly with weights 0.35, 0.28,
//! 0.22 and 0.15 (after Jimenez 2014, with fixed weights).

use crate::math::lanes::{F, V3, splat};
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
/// Values before and after each row that repeat its ends.
const PAD: usize = 8;

/// A small picture of linear light: red, green and blue planes.
pub struct Glow {
    width: usize,
    height: usize,
    planes: [Vec<f32>; 3],
    /// Side of its pixels, px of the picture.
    scale: f32,
}

impl Glow {
    fn new(width: usize, height: usize, scale: f32) -> Self {
        let planes = std::array::from_fn(|_| vec![0.0; (width + 2 * PAD + 8) * height]);
        Self { width, height, planes, scale }
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
        let load = |row: &[f32], x: usize| F::new(std::array::from_fn(|i| row[x + i]));
        parallel::run(self.planes.iter_mut().map(|plane| {
            move || {
                let mut along = vec![0.0; plane.len()];
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
                            sum + load(&along[y * stride..], x) * splat(TAPS[k])
                        });
                        out[x..x + 8].copy_from_slice(sum.as_array());
                    }
                }
            }
        }));
        self.pad();
    }

    /// The next octave: squares of four averaged.
    fn half(&self) -> Glow {
        let mut half = Glow::new(self.width.div_ceil(2), self.height.div_ceil(2), self.scale * 2.0);
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
        half
    }

    /// Bilinear values at eight pixels of a row of the picture, from `x` on.
    pub fn at(&self, x: usize, y: usize) -> V3 {
        let place = |p: usize, end: usize| {
            let v = ((p as f32 + 0.5) / self.scale - 0.5).max(0.0);
            let whole = (v as usize).min(end - 1);
            (whole, v - whole as f32)
        };
        let (row, fy) = place(y, self.height);
        let below = (row + 1).min(self.height - 1);
        let columns: [(usize, f32); 8] = std::array::from_fn(|i| place(x + i, self.width));
        let fx = F::new(columns.map(|c| c.1));
        let value = |plane: &Vec<f32>| {
            let line = |y: usize| {
                let row = &plane[y * self.stride() + PAD..];
                let a = F::new(columns.map(|c| row[c.0]));
                let b = F::new(columns.map(|c| row[c.0 + 1]));
                a + (b - a) * fx
            };
            let (a, b) = (line(row), line(below));
            a + (b - a) * splat(fy)
        };
        let [r, g, b] = &self.planes;
        V3 { x: value(r), y: value(g), z: value(b) }
    }
}

/// The light over the threshold, as the first octave; none if there is no such light.
fn bright(stage: &Stage, tiles: &[Tile]) -> Option<Glow> {
    let grade = &stage.scene.grade;
    let step = (stage.height / LINES).max(1).ilog2();
    let side = 1_usize << step;
    let (w, h) = (stage.width as usize, stage.height as usize);
    let across = w.div_ceil(TILE);
    let mut glow = Glow::new(w.div_ceil(side), h.div_ceil(side), side as f32);
    let stride = glow.stride();
    let [r, g, b] = &mut glow.planes;
    let rows = r.chunks_mut(stride).zip(g.chunks_mut(stride)).zip(b.chunks_mut(stride));
    let any = AtomicBool::new(false);
    parallel::run(rows.enumerate().map(|(row, ((r, g), b))| {
        let any = &any;
        move || {
            for y in (row * side..(row + 1) * side).take_while(|y| *y < h) {
                for x in (0..w).step_by(8) {
                    let tile = &tiles[y / TILE * across + x / TILE];
                    let at = (y % TILE) * TILE + x % TILE;
                    let [cr, cg, cb] = tile.rgb.each_ref().map(|p| {
                        let v = F::new(std::array::from_fn(|i| p[at + i])) * splat(grade.exposure);
                        v.fast_max(F::ZERO).fast_min(splat(LIMIT))
                    });
                    let most = cr.fast_max(cg).fast_max(cb);
                    let over = most - splat(grade.bloom_threshold);
                    let knee = splat(KNEE);
                    if !over.simd_gt(-knee).any() {
                        continue;
                    }
                    any.store(true, Ordering::Relaxed);
                    let soft = (over + knee).fast_max(F::ZERO).fast_min(knee + knee);
                    let share = over.fast_max(soft * soft * splat(0.5 / (2.0 * KNEE)));
                    let share =
                        (share / most.fast_max(splat(1e-6))).as_array().map(|s| s / (side * side) as f32);
                    for (i, share) in share.into_iter().enumerate().take(w - x) {
                        let to = PAD + ((x + i) >> step);
                        r[to] += cr.as_array()[i] * share;
                        g[to] += cg.as_array()[i] * share;
                        b[to] += cb.as_array()[i] * share;
                    }
                }
            }
        }
    }));
    any.into_inner().then_some(glow)
}

/// The glow to add to the exposed picture, if there is any.
pub fn bloom(stage: &Stage, tiles: &[Tile]) -> Option<Glow> {
    let amount = stage.scene.grade.bloom;
    if amount <= 0.0 {
        return None;
    }
    let mut octaves = vec![bright(stage, tiles)?];
    for level in 0..WEIGHTS.len() {
        octaves[level].blur();
        if level + 1 < WEIGHTS.len() {
            let next = octaves[level].half();
            octaves.push(next);
        }
    }
    // From the smallest up, each octave takes in the one below it at its own resolution.
    let mut sum = octaves.pop()?;
    let mut weight = WEIGHTS[WEIGHTS.len() - 1] * amount;
    for (mut octave, own) in octaves.into_iter().zip(WEIGHTS).rev() {
        // Seen from the octave above it, a pixel is two wide.
        sum.scale = 2.0;
        let stride = octave.stride();
        for y in 0..octave.height {
            for x in (0..octave.width).step_by(8) {
                let below = sum.at(x, y) * splat(weight);
                for (plane, add) in octave.planes.iter_mut().zip([below.x, below.y, below.z]) {
                    let to = &mut plane[y * stride + PAD + x..][..8];
                    let here = F::new(std::array::from_fn(|i| to[i]));
                    to.copy_from_slice((here * splat(own * amount) + add).as_array());
                }
            }
        }
        octave.pad();
        (sum, weight) = (octave, 1.0);
    }
    Some(sum)
}
