//! The last pass: bloom, display curve, sampling overlay, then the effects, if the scene has any, then
//! vignette, grain, 0RGB.
//!
//! Vignette: 1 - V r^2.4 with r² = (x² + y²) / 2, x and y from -1 to 1; the power is a cubic in r²,
//! within 0.004. Grain: a hash of pixel and
//! frame, which also hides banding. Pixels are quantised by floor(255 v + 1/2).

use super::bloom::Bloom;
use super::chain::Chain;
use super::effect::noise;
use super::picture::{Picture, ROWS};
use crate::counters::{Counter, Counters};
use crate::math::hash::hash2;
use crate::math::lanes::{Bound, F, RAMP, V3, load, splat, splat_u};
use crate::math::{Vec3, number, whole};
use crate::render::Stage;
use crate::sample::{Kind, TILE, Tile};
use crate::scene::{Grade, Scene, Stop};
use crate::shade::Points;
use crate::study::Phase;
use crate::trace::ramp;
use crate::{features, parallel};

/// Whether something may come between tiles and pixels.
pub const KEEPS: bool = features::EFFECTS || features::SPLIT;

/// What lives from frame to frame.
#[derive(Default)]
pub struct Post {
    bloom: Bloom,
    chain: Chain,
}

impl Post {
    /// Keeps the picture that the tiles of frame `n` show, with the scene's effects on it; returns what that
    /// took.
    #[inline(never)]
    pub fn keep(&mut self, stage: &Stage, tiles: &[Tile], n: u64) -> Counters {
        let mut counters = Counters::start(&stage.quality.study, Phase::Bloom);
        let glow = self.bloom.glow(stage, tiles);
        counters.watch.enter(Phase::Finishing);
        counters.add(Counter::BloomPasses, glow.is_some() as usize);
        let size = [stage.width as usize, stage.height as usize];
        self.chain.fill(size, &|x: usize, y: usize| develop(stage, tiles, glow, (x, y)));
        self.chain.run(&stage.scene.effects, tiles, n, &mut counters);
        counters.watch.stop();
        counters
    }

    /// Writes frame `n` of a scene as 0RGB rows into `pixels`: the picture that was kept, if one was, and what
    /// the tiles of a stage show, if there are any; it need not be of this scene. Returns what that took.
    #[inline(never)]
    pub fn finish(
        &mut self,
        scene: &Scene,
        stage: &Stage,
        kept: bool,
        lit: Option<&[Tile]>,
        n: u64,
        pixels: &mut [u32],
    ) -> Counters {
        let (width, height) = (stage.width as usize, stage.height as usize);
        let mut counters = Counters::start(&stage.quality.study, Phase::Bloom);
        let glow = lit.and_then(|tiles| self.bloom.glow(stage, tiles));
        counters.watch.enter(Phase::Finishing);
        counters.add(Counter::BloomPasses, glow.is_some() as usize);
        let painted = whole(scene.overlay * stage.width as f32);
        counters.add(Counter::OverlayPixels, painted * height);
        let picture = &self.chain.picture;
        parallel::each(pixels.chunks_mut(width * ROWS), |strip, rows| {
            for (row, y) in rows.chunks_mut(width).zip(strip * ROWS..) {
                for (out, x) in row.chunks_mut(8).zip((0..).step_by(8)) {
                    let mut colour = V3::ZERO;
                    if KEEPS && kept {
                        colour = picture.near(x, y, 0, 0);
                    }
                    if let Some(tiles) = lit {
                        colour += develop(stage, tiles, glow, (x, y));
                    }
                    print(&scene.grade, (width, height), colour, (x, y), n, out);
                }
            }
        });
        counters.watch.stop();
        counters
    }
}

/// Display values of eight pixels from (`x`, `y`) on.
fn develop(stage: &Stage, tiles: &[Tile], glow: Option<&Picture>, (x, y): (usize, usize)) -> V3 {
    let tile = &tiles[y / TILE * (stage.width as usize).div_ceil(TILE) + x / TILE];
    let at = (y % TILE) * TILE + x % TILE;
    let [r, g, b] = &tile.rgb;
    let mut linear = V3 { x: load(&r[at..]), y: load(&g[at..]), z: load(&b[at..]) };
    if let Some(glow) = glow {
        linear += glow.light(x, y, glow.scale) * splat(1.0 / stage.scene.grade.exposure);
    }
    let mut colour = stage.display.map8(linear);

    if x < whole(stage.scene.overlay * stage.width as f32) {
        for lane in 0..8 {
            let painted = overlay(tile, (x % TILE + lane, y % TILE), colour.lane(lane));
            colour.set_lane(lane, painted);
        }
    }
    if features::POINTS && stage.scene.light_count > 0.0 {
        let side = stage.quality.light_tile as usize;
        let reach = tile.reach((x % TILE, y % TILE), side);
        let count = |points: &Points| points.count(&stage.scene.points, [x / side, y / side], reach);
        let count = stage.points.map_or(0, count);
        let paint = ramp(&COUNTS, splat(count as i32 as f32));
        colour = colour + (paint - colour) * splat(stage.scene.light_count);
    }
    colour
}

/// Vignette, grain and bytes of eight pixels from (`x`, `y`) of a picture on, or as many as `out` takes.
fn print(
    grade: &Grade,
    (width, height): (usize, usize),
    mut colour: V3,
    (x, y): (usize, usize),
    n: u64,
    out: &mut [u32],
) {
    let (w, h) = (number(width), number(height));
    if grade.vignette > 0.0 {
        let fx = (splat(number(x) + 0.5) + RAMP) * splat(2.0 / w) - F::ONE;
        let fy = ((number(y) + 0.5) * 2.0 - h) / h;
        let r2 = (fx * fx + splat(fy * fy)) * splat(0.5);
        let fall = r2 * (splat(0.5939) + r2 * (splat(0.6871) - r2 * splat(0.2849)));
        colour = colour * (F::ONE - splat(grade.vignette) * fall);
    }
    let noise = noise(y * width + x, hash2(n as u32, 0)) * splat(2.0 * grade.grain);
    let byte = |c: F| {
        let c = (c + noise).at_least(F::ZERO).at_most(F::ONE);
        // A whole number added to 2^23 stands in the low bits.
        ((c * splat(255.0) + splat(0.5)).floor() + splat(8_388_608.0)).to_bits() & splat_u(255)
    };
    let packed = (byte(colour.x) << 16u32) | (byte(colour.y) << 8u32) | byte(colour.z);
    let count = out.len();
    out.copy_from_slice(&packed.as_array()[..count]);
}

/// Colours of filled and interpolated pixels: #E0342B and #2D6BFF.
const FILLED: Vec3 = Vec3::new(0.878, 0.204, 0.169);
const INTERPOLATED: Vec3 = Vec3::new(0.176, 0.42, 1.0);

/// Colours for 0, 1, 4, 12, 32 and 64 small lights: black, #1B2A7A, #5A3FC0, #C05A9E, #FFB347, #FFF3D6.
static COUNTS: [Stop; 6] = [
    Stop { y: 0.0, colour: Vec3::ZERO },
    Stop { y: 1.0, colour: Vec3::new(0.106, 0.165, 0.478) },
    Stop { y: 4.0, colour: Vec3::new(0.353, 0.247, 0.753) },
    Stop { y: 12.0, colour: Vec3::new(0.753, 0.353, 0.62) },
    Stop { y: 32.0, colour: Vec3::new(1.0, 0.702, 0.278) },
    Stop { y: 64.0, colour: Vec3::new(1.0, 0.953, 0.839) },
];

/// Shows how a pixel was got: 45 % red or blue, darker at the upper and left edge of large cells.
fn overlay(tile: &Tile, (x, y): (usize, usize), colour: Vec3) -> Vec3 {
    let record = tile.record[y * TILE + x];
    let paint = match record.kind() {
        Kind::Filled => FILLED,
        Kind::Interpolated => INTERPOLATED,
        Kind::Traced | Kind::Smoothed => return colour,
    };
    let size = record.size();
    let rim = size >= 8 && (x % size == 0 || y % size == 0);
    (colour + (paint - colour) * 0.45) * if rim { 0.7 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Side of the pictures.
    const SIDE: usize = 64;

    /// A picture of one display value, as bytes of its green channel.
    fn printed(grade: Grade, n: u64, value: f32) -> Vec<u32> {
        let mut pixels = vec![!0; SIDE * SIDE];
        for (k, eight) in pixels.chunks_mut(8).enumerate() {
            print(
                &grade,
                (SIDE, SIDE),
                V3::splat(Vec3::splat(value)),
                (8 * k % SIDE, 8 * k / SIDE),
                n,
                eight,
            );
        }
        assert!(pixels.iter().all(|p| p >> 16 == p & 255 && p >> 8 & 255 == p & 255), "grey, and 0 on top");
        pixels.iter().map(|p| p >> 8 & 255).collect()
    }

    #[test]
    fn without_dither_every_byte_comes_back() {
        let plain = Grade { grain: 0.0, ..Grade::DEFAULT };
        for byte in 0..=255 {
            assert_eq!(printed(plain, 7, byte as f32 / 255.0), [byte; SIDE * SIDE]);
        }
        let ends = [-1.0, f32::NAN, 2.0, f32::INFINITY].map(|value| printed(plain, 7, value)[0]);
        assert_eq!(ends, [0, 0, 255, 255]);
    }

    #[test]
    fn dither_keeps_the_mean_moves_by_one_step_and_changes_with_the_frame() {
        let plain = Grade { vignette: 0.0, ..Grade::DEFAULT };
        for k in 0..40 {
            let value = 20.0 + 0.1 * k as f32;
            let found = printed(plain, k, value / 255.0);
            let (low, high) = (value.floor() as u32, value.ceil() as u32);
            assert!(found.iter().all(|byte| (low..=high).contains(byte)), "{value}");
            // Of 4096 throws the mean is right to 0.5 / 64, and this is four times that.
            let mean = found.iter().sum::<u32>() as f32 / (SIDE * SIDE) as f32;
            assert!((mean - value).abs() < 0.032, "{mean} for {value}");
        }
        assert_eq!(printed(plain, 3, 0.5 / 255.0), printed(plain, 3, 0.5 / 255.0));
        assert_ne!(printed(plain, 3, 0.5 / 255.0), printed(plain, 4, 0.5 / 255.0));
    }

    #[test]
    fn the_vignette_is_its_formula_up_to_a_step() {
        let dark = Grade { vignette: 1.0, grain: 0.0, ..Grade::DEFAULT };
        for (i, byte) in printed(dark, 0, 1.0).into_iter().enumerate() {
            let [x, y] = [i % SIDE, i / SIDE].map(|at| (2 * at + 1) as f64 / SIDE as f64 - 1.0);
            #[allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]
            let fall = ((x * x + y * y) * 0.5).powf(1.2);
            let off = f64::from(byte) / 255.0 - (1.0 - fall);
            assert!(off.abs() <= 0.004 + 0.5 / 255.0, "{byte} at ({x}, {y}): {off}");
        }
    }
}
