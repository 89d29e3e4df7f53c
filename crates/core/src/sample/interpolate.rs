//! Pixels between the samples of a cell, eight at a time, on one of three rungs of accuracy.
//!
//! Between corners a, b, c, d the value is bilinear, in the form p + (q - p) x that keeps equal
//! values equal, plus a bump 16 x (1-x) y (1-y) (centre - mean) through the centre sample, which
//! vanishes on the cell's border.

use super::block::Sample;
use super::refine::{Cell, Known};
use super::scatter;
use super::tile::{Kind, Record, TILE, Tile};
use super::wave::soft;
use crate::counters::{Counter, Counters};
use crate::math::lanes::{F, LANE_INDEX, U, V3, splat, splat_u};
use crate::math::{Vec3, number, whole};
use crate::quality::Rung;
use crate::render::Stage;
use crate::scene::Channel;
use crate::shade::{self, Visibility};
use crate::study::Phase;
use crate::trace::{NONE, Rays8, surface};

/// Half an output step: colours closer than this display the same.
const SAME: f32 = 0.5 / 255.0;

/// A value over a cell: at the corners, and the bump.
struct Patch([Vec3; 5]);

impl Patch {
    #[inline(never)]
    fn of(known: &Known, value: fn(Sample) -> Vec3) -> Patch {
        let [a, b, c, d, centre] = known.samples.map(value);
        // A cell that was too small to be split may end on an edge: a bump would dot it.
        let bend = if known.taken == 5 && known.same_surface() { 16.0 } else { 0.0 };
        let bump = (centre - known.mean(value)) * bend;
        Patch([a, b, c, d, bump])
    }

    fn at(&self, x: F, y: F) -> V3 {
        let [a, b, c, d, bump] = self.0.map(V3::splat);
        let upper = a + (b - a) * x;
        let lower = c + (d - c) * x;
        upper + (lower - upper) * y + bump * (x * (F::ONE - x) * y * (F::ONE - y))
    }
}

/// Fills all pixels of a cell from its samples.
#[inline(never)]
pub(super) fn fill(
    stage: &Stage,
    corner: (usize, usize),
    cell: Cell,
    known: &Known,
    tile: &mut Tile,
    counters: &mut Counters,
) {
    counters.watch.enter(Phase::Filling);
    let first = known.samples[0];
    let equal = known.agree_within(SAME);
    let kind = if equal { Kind::Filled } else { Kind::Interpolated };
    let counter = if equal { Counter::Filled } else { Counter::Interpolated };
    let count = cell.size * cell.size;
    counters.add(counter, count);
    let record = Record::new(kind, cell.size);

    let textured = first.material(stage).is_some_and(|m| m.texture.is_visible())
        || first.voxels(stage).is_some()
        || first.is_painted(stage);
    // Where the colour itself runs smoothly the exact surface would show the same.
    let smooth = equal || known.colour_error() <= stage.quality.tolerance * 0.25;
    let most = match (smooth, textured) {
        (true, false) => Rung::Colour,
        (true, true) => Rung::Light,
        (false, _) => Rung::Surface,
    };
    let rung =
        if first.relief_within(stage, cell.size) { Rung::Surface } else { most.min(stage.rung(first.id())) };
    if stage.wants_depths() {
        fill_nearness(cell, known, tile);
    }
    let scale = splat(1.0 / number(cell.size));
    let shift = cell.size.trailing_zeros();
    let patch = Patch::of(
        known,
        match rung {
            Rung::Light if textured => |s| s.colour() - s.irradiance() * s.albedo(),
            Rung::Colour | Rung::Light => |s| s.colour(),
            Rung::Surface => |s| s.indirect(),
        },
    );
    let light = (rung == Rung::Light && textured).then(|| Patch::of(known, |s| s.irradiance()));
    for base in (0..count.div_ceil(8)).map(|i| 8 * i) {
        let place = |lane: usize| {
            let i = base + lane;
            (i & (cell.size - 1), i >> shift)
        };
        let index = splat_u(base as u32) + LANE_INDEX;
        let x = small(index & splat_u(cell.size as u32 - 1));
        let y = small(index >> shift);
        let between = patch.at(x * scale, y * scale);
        let px = x + splat(number(corner.0 + cell.x) + 0.5);
        let py = y + splat(number(corner.1 + cell.y) + 0.5);
        let colour = match (rung, &light) {
            (Rung::Surface, _) => between + known_surface(stage, first, px, py, counters),
            (_, Some(light)) => {
                between + light.at(x * scale, y * scale) * albedo(stage, first, px, py, counters)
            }
            _ => between,
        };
        if cell.size >= 8 {
            let (x, y) = place(0);
            let at = (cell.y + y) * TILE + cell.x + x;
            for (plane, c) in tile.rgb.iter_mut().zip([colour.x, colour.y, colour.z]) {
                plane[at..at + 8].copy_from_slice(c.as_array());
            }
            tile.record[at..at + 8].fill(record);
        } else {
            for lane in 0..count.min(8) {
                let (x, y) = place(lane);
                tile.set(cell.x + x, cell.y + y, colour.lane(lane), record);
            }
        }
    }
    counters.watch.enter(Phase::Sampling);
}

/// Depths between the corners: over a plane, one over the depth is linear on the screen.
fn fill_nearness(cell: Cell, known: &Known, tile: &mut Tile) {
    let [a, b, c, d, _] = known.samples.map(|s| 1.0 / s.depth());
    for i in 0..cell.size * cell.size {
        let (column, row) = (i % cell.size, i / cell.size);
        let (x, y) = (number(column) / number(cell.size), number(row) / number(cell.size));
        let (upper, lower) = (a + (b - a) * x, c + (d - c) * x);
        tile.nearness[(cell.y + row) * TILE + cell.x + column] = upper + (lower - upper) * y;
    }
}

/// Whole numbers under 2^23 as f32: in the low bits of 2^23, which is then taken off.
fn small(i: U) -> F {
    F::from_bits(i | splat_u(0x4b00_0000)) - splat(8_388_608.0)
}

/// Rays through pixels, and where they meet the shape of `first` (at its depth where they don't).
#[inline(never)]
fn meet(stage: &Stage, first: Sample, px: F, py: F, counters: &mut Counters) -> (Rays8, F) {
    let rays = Rays8 { origin: V3::splat(stage.scene.camera.position), direction: stage.directions(px, py) };
    if first.id() < 0.0 {
        return (rays, splat(f32::INFINITY));
    }
    let (shape, part) = (whole(first.id()) >> 2, whole(first.id()) & 3);
    if first.voxels(stage).is_some() {
        // All samples lie on one plane.
        let (way, d) = (V3::splat(first.point()) - rays.origin, rays.direction);
        return (rays, [way.x / d.x, way.y / d.y, way.z / d.z, F::ZERO][part]);
    }
    let span = stage.scene.shape(shape).span(&rays, splat(f32::INFINITY), &stage.quality, counters);
    let (t, _) = span.first();
    (rays, t.simd_gt(F::ZERO).select(t, splat(first.depth())))
}

/// Albedo of the known shape at pixels.
fn albedo(stage: &Stage, first: Sample, px: F, py: F, counters: &mut Counters) -> V3 {
    counters.add(Counter::KnownSurfaces, 8);
    let (rays, t) = meet(stage, first, px, py, counters);
    let s = surface(stage.scene, &stage.quality, &rays, t, splat(first.id()), splat(stage.pixel));
    s.count(counters);
    s.colour(Channel::Colour)
}

/// Light from the known shape, or background, at pixels but for mirrors and glass: the visibility
/// of the lamps is that of the sample `first`.
#[inline(never)]
fn known_surface(stage: &Stage, first: Sample, px: F, py: F, counters: &mut Counters) -> V3 {
    counters.add(Counter::KnownSurfaces, 8);
    let (rays, t) = meet(stage, first, px, py, counters);
    let spread = splat(stage.pixel);
    let light = if first.id() <= NONE {
        counters.add(Counter::DiscTests, 8 * stage.scene.background.discs.len());
        counters.add(Counter::Glows, 8 * stage.scene.background.glows.len());
        shade::background(&stage.scene.background, &rays, spread, soft(stage, spread), F::ZERO).0
    } else {
        let s = surface(stage.scene, &stage.quality, &rays, t, splat(first.id()), spread);
        s.count(counters);
        let mut codes = first.codes();
        let view = -rays.direction;
        let all = F::ZERO.simd_gt(splat(-1.0));
        let lit = shade::direct(stage, &s, view, all, Visibility::Known, &mut codes, counters);
        let split = shade::split(stage.scene.shading, &s, rays.direction);
        let bounces = scatter::bounces(stage, splat_u(0), &s, 0);
        let local = shade::local(stage, &s, &split, lit, (all, bounces), counters);
        local.irradiance * s.colour(Channel::Colour) + local.rest
    };
    match &stage.scene.fog {
        Some(fog) => {
            counters.add(Counter::FogSegments, 8);
            let (through, scattered) = shade::fog(fog, &rays, t);
            light * through + scattered
        }
        None => light,
    }
}
