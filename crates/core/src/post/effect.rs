//! What each effect makes of eight pixels: display values in, display values out.
//!
//! Luminance has the weights of Rec. 709; edges are found by the operator of Sobel and Feldman (1968).

use super::picture::Picture;
use crate::features::*;
use crate::math::Vec3;
use crate::math::hash::{mix_x8, unit_x8};
use crate::math::lanes::{Bound, F, LANE_INDEX, V3, splat, splat_u};
use crate::sample::{self, TILE, Tile};
use crate::scene::Kind;

/// What an effect may ask for besides the pixels themselves.
pub struct Around<'a> {
    /// The picture it is applied to.
    pub picture: &'a Picture,
    /// How its pixels were got.
    pub tiles: &'a [Tile],
    /// Its bloom, if the effect adds one.
    pub glow: Option<&'a Picture>,
    /// Of the frame's noise.
    pub seed: u32,
}

fn luminance(v: V3) -> F {
    v.dot(V3::splat(Vec3::new(0.2126, 0.7152, 0.0722)))
}

/// Numbers from -1/2 to 1/2 for eight pixels from number `first` on.
pub fn noise(first: usize, seed: u32) -> F {
    unit_x8(mix_x8(splat_u(first as u32) + LANE_INDEX, splat_u(seed))) - splat(0.5)
}

/// An effect on the pixels `v`, which begin at (`x`, `y`); `px` and `py` run from -1 to 1 over the picture,
/// upwards. What this program has no such effect for stays as it is.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn apply(kind: &Kind, around: &Around, (x, y): (usize, usize), (px, py): (F, f32), v: V3) -> V3 {
    let picture = around.picture;
    let near = |right, down| picture.near(x, y, right, down);
    match *kind {
        Kind::Contrast(gain) if EFFECT_CONTRAST => {
            let half = V3::splat(Vec3::splat(0.5));
            half + (v - half) * splat(gain)
        }
        Kind::Tint { colour, strength } if EFFECT_TINT => {
            v + (V3::splat(colour) * luminance(v) - v) * splat(strength)
        }
        Kind::Bloom { intensity, .. } | Kind::WideBloom { intensity, .. }
            if EFFECT_BLOOM || EFFECT_WIDE_BLOOM =>
        {
            let add = around.glow.map_or(V3::ZERO, |glow| glow.light(x, y, glow.scale));
            v + add * splat(intensity)
        }
        Kind::Sharpness(gain) if EFFECT_SHARPNESS => {
            let mean = ((near(-1, 0) + near(1, 0)) + (near(0, -1) + near(0, 1))) * splat(0.25);
            v + (v - mean) * splat(gain)
        }
        Kind::Levels(levels) if EFFECT_LEVELS => {
            let last = V3::splat(levels - 1.0);
            let level = |v: F, n: f32, last: F| (v * splat(n)).floor().at_most(last) / last;
            V3 {
                x: level(v.x, levels.x, last.x),
                y: level(v.y, levels.y, last.y),
                z: level(v.z, levels.z, last.z),
            }
        }
        Kind::Fringes(shift) if EFFECT_FRINGES => {
            let (w, h) = (picture.width as f32 * 0.5, picture.height as f32 * 0.5);
            let place = |share: f32| {
                let (u, v) = (px * splat(share * w) + splat(w - 0.5), h - py * share * h - 0.5);
                (u, v)
            };
            let (red, blue) = (place(1.0 - shift), place(1.0 + shift));
            V3 { x: picture.between(0, red.0, red.1), y: v.y, z: picture.between(2, blue.0, blue.1) }
        }
        Kind::Edges { strength, colour } if EFFECT_EDGES => {
            let l = |right, down| luminance(near(right, down));
            let (a, c, g, i) = (l(-1, -1), l(1, -1), l(-1, 1), l(1, 1));
            let (b, d, f, h) = (l(0, -1), l(-1, 0), l(1, 0), l(0, 1));
            let across = (c - a) + (i - g) + (f - d) * splat(2.0);
            let down = (g - a) + (i - c) + (h - b) * splat(2.0);
            let step = (across * across + down * down).sqrt() * splat(0.25 * strength);
            v + V3::splat(colour) * step.at_most(F::ONE)
        }
        Kind::Cells { shade, colour } if EFFECT_CELLS => {
            let tile = &around.tiles[y / TILE * picture.width.div_ceil(TILE) + x / TILE];
            let border = F::new(std::array::from_fn(|lane| {
                let record = tile.record[y % TILE * TILE + x % TILE + lane];
                let [left, above] = [x + lane, y].map(|i| i & (record.size() - 1) == 0);
                let known = [sample::Kind::Filled, sample::Kind::Interpolated].contains(&record.kind());
                (known && record.size() >= 4 && (left || above)) as u32 as f32
            }));
            v + (v * splat(shade - 1.0) + V3::splat(colour)) * border
        }
        Kind::Lighten(share) if EFFECT_LIGHTEN => {
            let end = V3::splat(Vec3::splat(if share > 0.0 { 1.0 } else { 0.0 }));
            v + (end - v) * splat(share.abs())
        }
        Kind::Tube { base, glow, radius } if EFFECT_TUBE => {
            let r2 = (px * px + splat(py * py)) * splat(0.5 / (radius * radius));
            v * (splat(base) + splat(glow) * (F::ONE - r2).at_least(F::ZERO))
        }
        Kind::Grain(half) if EFFECT_GRAIN => {
            let noise = noise(y * picture.width + x, around.seed) * splat(2.0 * half);
            v + V3 { x: noise, y: noise, z: noise }
        }
        _ => v,
    }
}
