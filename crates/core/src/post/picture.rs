//! Pictures as planes of numbers, with their edges repeated, so that filters need not ask where they are.

use crate::math::lanes::{Bound, F, RAMP, V3, load, pick, splat, splat_u};
use crate::math::{number, whole};
use crate::parallel;

/// The seven taps of the blur: row six of Pascal's triangle.
const TAPS: [f32; 7] =
    [1.0 / 64.0, 6.0 / 64.0, 15.0 / 64.0, 20.0 / 64.0, 15.0 / 64.0, 6.0 / 64.0, 1.0 / 64.0];
/// Values that are blurred as one piece of work.
const PIECE: usize = 1 << 15;
/// Brightest value that is read, and that glows.
pub const LIMIT: f32 = 12.0;
/// Rows that are done as one piece of work: waking a thread costs more than a few rows.
pub const ROWS: usize = 16;
/// Values before and after each row that repeat its ends.
pub const PAD: usize = 8;
/// Rows above and below the picture that repeat its first and last: the reach of the taps.
pub const REACH: usize = 3;

/// A picture. Each row holds its red, then its green, then its blue values; around the picture its
/// edges are repeated.
#[derive(Default)]
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pub light: Vec<f32>,
    /// The light blurred along the rows, on the way to both ways.
    along: Vec<f32>,
    /// Side of its pixels, px of the frame: a power of two.
    pub scale: usize,
}

impl Picture {
    /// Gives it this size; what it holds is then still to be written.
    pub fn reset(&mut self, width: usize, height: usize, scale: usize) {
        (self.width, self.height, self.scale) = (width, height, scale);
        let length = self.line() * (height + 2 * REACH);
        if self.light.len() != length {
            self.light = vec![0.0; length];
        }
    }

    /// Distance between the colours of a row.
    pub fn stride(&self) -> usize {
        self.width + 2 * PAD + 8
    }

    /// Distance between rows.
    pub fn line(&self) -> usize {
        3 * self.stride()
    }

    /// Where the red values of row `y` are, from column `x` on.
    pub fn at(&self, x: usize, y: usize) -> usize {
        (REACH + y) * self.line() + PAD + x
    }

    /// Repeats the edges.
    #[inline(never)]
    pub fn pad(&mut self) {
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

    /// Eight pixels that lie a few px `right` and `down` of (x, y) and the following, at most [`PAD`] and
    /// [`REACH`]. NaN counts as black and infinity as very bright: neither gets from here to other pixels.
    #[inline(never)]
    pub fn near(&self, x: usize, y: usize, right: isize, down: isize) -> V3 {
        let at = self.at(x, y).wrapping_add_signed(down * self.line() as isize + right);
        let colour =
            |k: usize| load(&self.light[at + k * self.stride()..]).at_least(F::ZERO).at_most(splat(LIMIT));
        V3::new(colour(0), colour(1), colour(2))
    }

    /// Values of one colour between the pixels of (fractional) columns and a row, bilinearly.
    #[inline(never)]
    pub fn between(&self, colour: usize, columns: F, row: f32) -> F {
        let row = row.clamp(0.0, number(self.height - 1));
        let down = row.floor();
        let clean = |v: f32| if v > 0.0 { v.min(LIMIT) } else { 0.0 };
        F::new(columns.to_array().map(|column| {
            let column = column.clamp(0.0, number(self.width - 1));
            let left = column.floor();
            let at = self.at(whole(left), whole(down)) + colour * self.stride();
            let pair = |at: usize| {
                let (a, b) = (clean(self.light[at]), clean(self.light[at + 1]));
                a + (b - a) * (column - left)
            };
            let (upper, lower) = (pair(at), pair(at + self.line()));
            upper + (lower - upper) * (row - down)
        }))
    }

    /// Blurs along the rows, then along the columns.
    pub fn blur(&mut self) {
        let line = self.line();
        self.pad();
        self.along.resize(self.light.len(), 0.0);
        spread(&self.light, &mut self.along, 1);
        spread(&self.along, &mut self.light, line);
        self.pad();
    }

    /// The next octave: squares of four averaged.
    pub fn half(&self, half: &mut Picture) {
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
    pub fn join(&mut self, below: &Picture, own: f32, weight: f32) {
        let stride = self.stride();
        for y in 0..self.height {
            for x in (0..self.width.div_ceil(8)).map(|i| 8 * i) {
                // Seen from the octave above it, a pixel is two wide.
                let add = below.light(x, y, 2) * splat(weight);
                for (colour, add) in [add.x, add.y, add.z].into_iter().enumerate() {
                    let at = self.at(x, y) + colour * stride;
                    let to = &mut self.light[at..at + 8];
                    to.copy_from_slice((load(to) * splat(own) + add).as_array());
                }
            }
        }
        self.pad();
    }

    /// Light at eight pixels, from (x, y) on, of a picture `scale` times as large, bilinearly.
    #[inline(never)]
    pub fn light(&self, x: usize, y: usize, scale: usize) -> V3 {
        // The position among the glow's pixels: exact, as the scale is a power of two.
        let place = |p: F| ((p + splat(0.5)) * splat(1.0 / number(scale)) - splat(0.5)).at_least(F::ZERO);
        let (u, v) = (place(splat(number(x)) + RAMP), place(splat(number(y))));
        let (columns, row) = (u.floor(), v.floor());
        let (fx, fy) = (u - columns, v - row);
        let first = columns.as_array()[0];
        let start = self.at(whole(first), whole(row.as_array()[0]));
        let offsets = (columns - splat(first)).fast_trunc_int().cast_unsigned();
        let colour = |k: usize| {
            let upper = &self.light[start + k * self.stride()..];
            let a = load(upper);
            if scale == 1 {
                return a;
            }
            // Eight pixels lie on six columns at most.
            let near = a + (load(&upper[self.line()..]) - a) * fy;
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
                sum + load(&from[piece * PIECE + 8 * i + k * step..]) * splat(tap)
            });
            eight.copy_from_slice(sum.as_array());
        }
    });
}
