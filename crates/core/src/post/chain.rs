//! The chain of effects: each reads one picture and writes another, row by row, on all threads.
//!
//! A pass is `v + (effect(v) - v) amount`; the amount is also a function of the place. Passes that
//! change nothing are left out, so a chain of amounts 0 leaves the picture as it is, bit for bit.

use super::bloom::Bloom;
use super::effect::{self, Around};
use super::picture::{PAD, Picture, REACH, ROWS};
use crate::counters::Counters;
use crate::features;
use crate::math::hash::hash2;
use crate::math::lanes::{Bound, F, RAMP, V3, splat};
use crate::math::number;
use crate::parallel;
use crate::sample::Tile;
use crate::scene::{Effect, Kind};

/// A picture of display values and what its effects need; lives from frame to frame.
#[derive(Default)]
pub struct Chain {
    /// The picture, of the frame's size.
    pub picture: Picture,
    next: Picture,
    bloom: Bloom,
}

impl Chain {
    /// Gives the picture its size, and its pixels eight by eight.
    #[inline(never)]
    pub fn fill(&mut self, size: [usize; 2], value: &dyn Value) {
        self.picture.reset(size[0], size[1], 1);
        write(&mut self.picture, value);
    }

    /// Applies effects, one after another, to frame `n`.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn run(&mut self, effects: &[Effect], tiles: &[Tile], n: u64, counters: &mut Counters) {
        if !features::EFFECTS {
            return;
        }
        let Chain { picture, next, bloom } = self;
        let (width, height) = (picture.width, picture.height);
        for effect in effects.iter().filter(|effect| effect.runs()) {
            for _ in 0..effect.multipass {
                if cfg!(feature = "counters") {
                    counters.add(effect.kind.counter(), 1);
                }
                let shine = match effect.kind {
                    Kind::Bloom { threshold, .. } if features::EFFECT_BLOOM => Some((threshold, 1)),
                    Kind::WideBloom { threshold, octaves, .. } if features::EFFECT_WIDE_BLOOM => {
                        Some((threshold, octaves.clamp(2, 4)))
                    }
                    _ => None,
                };
                let glow = shine.and_then(|(threshold, octaves)| {
                    let read = |x, y| picture.near(x, y, 0, 0);
                    bloom.of([width, height], (threshold, 1.0, octaves), read)
                });
                next.reset(width, height, 1);
                let around = Around { picture, tiles, glow, seed: hash2(n as u32, 1) };
                let (across, up) = (2.0 / number(width), 2.0 / number(height));
                write(next, &|x: usize, y: usize| {
                    let px = (splat(number(x) + 0.5) + RAMP) * splat(across) - F::ONE;
                    let py = 1.0 - (number(y) + 0.5) * up;
                    let place = &effect.place;
                    let far = px * splat(place.normal.x) + splat(py * place.normal.y - place.from);
                    let share = (far * splat(1.0 / place.over)).at_least(F::ZERO).at_most(F::ONE);
                    let from = picture.near(x, y, 0, 0);
                    let to = effect::apply(&effect.kind, &around, (x, y), (px, py), from);
                    from + (to - from) * (share * splat(effect.amount))
                });
                std::mem::swap(picture, next);
            }
        }
    }
}

/// Light of eight pixels from (x, y) on. A trait of its own, as the table of a `dyn Fn` holds each closure twice more.
pub trait Value: Sync {
    /// That light.
    fn at(&self, x: usize, y: usize) -> V3;
}

impl<F: Fn(usize, usize) -> V3 + Sync> Value for F {
    fn at(&self, x: usize, y: usize) -> V3 {
        self(x, y)
    }
}

/// Writes all pixels of a picture and repeats its edges.
#[inline(never)]
fn write(picture: &mut Picture, value: &dyn Value) {
    let (width, height, stride, line) = (picture.width, picture.height, picture.stride(), picture.line());
    let rows = &mut picture.light[REACH * line..(REACH + height) * line];
    parallel::each(rows.chunks_mut(ROWS * line), |strip, rows| {
        for (row, y) in rows.chunks_mut(line).zip(strip * ROWS..) {
            for x in (0..width).step_by(8) {
                let v = value.at(x, y);
                for (k, v) in [v.x, v.y, v.z].into_iter().enumerate() {
                    let at = k * stride + PAD + x;
                    row[at..at + 8].copy_from_slice(v.as_array());
                }
            }
        }
    });
    picture.pad();
}

#[cfg(test)]
mod tests;
