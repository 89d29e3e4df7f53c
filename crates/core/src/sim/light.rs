//! What rays see of smoke: they march through it, where there is some, and it dims the light of lamps.

use super::grid::{Eight, Grid, lanes};
use super::{DENSITY, Simulation, State};
use crate::counters::{Counter, Counters};
use crate::features;
use crate::math::lanes::{Bound, F, V3, least, splat};
use crate::math::lanes_fn::exp;
use crate::math::number;
use crate::render::Stage;
use crate::scene::{Rules, Smoke, Voxels};
use crate::shade::{MAX_LAMPS, tinted};
use crate::trace::{Rays8, Suspects, occlusion, voxels};

/// Side of the bricks by which empty space is skipped, cells.
const BRICK: usize = 4;

/// A ray ends where less light than this comes through: what it leaves out is at most this share of
/// the brightest smoke.
pub const OPAQUE: f32 = 1.0 / 512.0;

/// Steps of a ray, at most.
const MOST_STEPS: usize = 4096;

/// Smoke made ready for rays.
pub struct Volume<'a> {
    smoke: &'a Rules,
    grid: Grid,
    /// The cells as they are shown.
    shown: &'a [Eight],
    /// A cell for each brick of places: solid if there is smoke between any of them and the next.
    full: &'a Voxels,
}

/// Room for what is made ready, which lives from frame to frame.
#[derive(Default)]
pub struct Room {
    shown: Vec<Eight>,
    full: Voxels,
}

impl<'a> Volume<'a> {
    /// The smoke of a simulation.
    #[inline(never)]
    pub fn new(now: &Smoke, simulation: &'a Simulation, room: &'a mut Room, counters: &mut Counters) -> Self {
        let smoke = now.rules;
        let grid = Grid { size: smoke.size };
        counters.add(Counter::SmokeShown, grid.size.iter().product());
        let State { cells, before, .. } = simulation.state();
        let mut shown = cells;
        // Also where a frame is at a step: the next one isn't.
        room.shown.clear();
        room.shown.reserve(cells.len());
        if now.behind > 0.0 {
            room.shown.extend(cells);
            grid.each(&mut room.shown, 1, &|_: [usize; 3], i: usize, row: &mut [Eight]| {
                for (i, out) in (i..).zip(row) {
                    let last = F::new(*out);
                    *out = (last + (F::new(before[i]) - last) * splat(now.behind)).to_array();
                }
            });
            shown = &room.shown;
        }
        // Places count from half a cell before the corner.
        let lo = smoke.lo - 0.5 * smoke.cell;
        let full = &mut room.full;
        full.reset(lo, smoke.cell * BRICK as f32, grid.size.map(|n| n / BRICK + 1));
        let [_, row, slice] = grid.steps();
        full.edit_all_by(&mut |at, _| {
            let first = grid.index(at.map(|i| BRICK * i as usize));
            let side = BRICK + 1;
            (0..side * side * side).any(|k| {
                let cell = first + k % side + k / side % side * row + k / (side * side) * slice;
                shown.get(cell).is_some_and(|cell| cell[DENSITY] > 0.0)
            }) as u8
        });
        Volume { smoke, grid, shown, full }
    }

    /// Density, temperature, and how much light of the first two lamps is lost on its way to points, where the
    /// mask says so; elsewhere 0.
    #[inline(never)]
    fn at(&self, p: V3, mask: F) -> [F; 4] {
        let mut found = [F::ZERO; 4];
        let places = self.full.in_cells(p) * splat(BRICK as f32);
        let mut todo = mask.to_bitmask();
        while todo != 0 {
            let lane = todo.trailing_zeros() as usize & 7;
            todo &= todo - 1;
            let value = self.grid.sample(self.shown, lanes(places.lane(lane).into())).to_array();
            for (found, value) in found.iter_mut().zip(&value[DENSITY..]) {
                found.as_mut_array()[lane] = *value;
            }
        }
        found
    }

    /// Share of what lies behind that rays with unit directions see through the smoke up to `end`, and
    /// the light that the smoke adds. Steps are `pace` cells long.
    #[inline(never)]
    pub fn march(&self, stage: &Stage, rays: &Rays8, end: F, pace: f32, counters: &mut Counters) -> (F, V3) {
        let smoke = self.smoke;
        let (mut through, mut light) = (F::ONE, V3::ZERO);
        let is_full = |p: V3| self.full.values(self.full.in_cells(p)).simd_gt(F::ZERO);
        // A brick that a ray begins in is not come to.
        let enter = voxels(rays, self.full, end, counters).enter;
        let enter = enter & !is_full(rays.origin);
        let [lo, hi] = self.full.bounds();
        let (_, exit) = rays.in_box(lo, hi, end);
        let met = enter.simd_ge(F::ZERO);
        let length = pace * smoke.cell;
        // Steps are counted from the eye, so that they stay where they are when smoke comes nearer.
        let first = least(met.select(enter, splat(f32::INFINITY))).as_array()[0] / length;
        for k in 0..MOST_STEPS {
            let from = splat((first.floor() + number(k)) * length);
            let left = exit - from;
            let live = met & left.simd_gt(F::ZERO) & through.simd_gt(splat(OPAQUE));
            if !live.any() {
                break;
            }
            let step = left.at_most(splat(length));
            let t = from + step * splat(0.5);
            let p = rays.origin + rays.direction * t;
            let busy = live & t.simd_ge(enter) & is_full(p);
            if !busy.any() {
                continue;
            }
            counters.add(Counter::SmokeMarched, busy.to_bitmask().count_ones() as usize);
            let [density, heat, dark @ ..] = self.at(p, busy);
            let mut source = V3::splat(smoke.ambient) + V3::splat(smoke.glow) * heat;
            for (i, lamp) in stage.lamps.iter().enumerate() {
                let way = V3::splat(lamp.position) - p;
                let d2 = way.dot(way).at_least(splat(smoke.cell * smoke.cell));
                let l = way * (F::ONE / d2.sqrt());
                let cos = l.dot(rays.direction);
                let [weight, a, b] = smoke.phase;
                let lobe = |k: f32| {
                    let d = F::ONE - cos * splat(k);
                    splat(1.0 - k * k) / (d * d)
                };
                let turned = lobe(a) * splat(weight) + lobe(b) * splat(1.0 - weight);
                let share = F::ONE - dark.get(i).copied().unwrap_or(F::ZERO);
                let colour = self.lamp(stage, i, &Rays8 { origin: p, direction: way }, busy, counters);
                source += colour * (lamp.lobe(-l) * turned * share / d2);
            }
            let next = through * exp(-(density * splat(smoke.extinction) * step));
            light += (source * V3::splat(smoke.albedo) * (through - next)) & busy;
            through = busy.select(next, through);
        }
        (through, light)
    }

    /// Colour of a lamp's light where it comes to points from which `way` runs to it: what bodies leave of it,
    /// if they cast shadows on this smoke.
    #[inline(always)]
    fn lamp(&self, stage: &Stage, i: usize, way: &Rays8, wanted: F, counters: &mut Counters) -> V3 {
        let (lamp, gain) = (&stage.lamps[i], self.smoke.gain);
        if !features::SMOKE_SHADOWS || !self.smoke.shaded || lamp.is_fill || i >= MAX_LAMPS {
            return V3::splat(lamp.colour * gain);
        }
        let count = wanted.to_bitmask().count_ones() as usize;
        counters.add(Counter::SmokeShadowRays, count);
        counters.add_rays(count);
        let code = occlusion(
            stage.scene,
            &stage.quality,
            stage.bits,
            way,
            (wanted, 0.0),
            &Suspects::new(u64::MAX),
            counters,
        );
        tinted(stage, lamp, code) * (splat(gain) + splat(gain) * code.at_most(F::ZERO))
    }

    /// Share of a lamp's light that the smoke leaves on its way from `from + way`, where the lamp is,
    /// to `from`.
    #[inline(never)]
    pub fn shadow(&self, lamp: usize, from: V3, way: V3) -> F {
        // What comes to where the way enters the box around the smoke, between the middles of cells.
        let [lo, hi] = self.full.bounds();
        let half = 0.5 * self.smoke.cell;
        let (lo, hi) = (lo.max(self.smoke.lo + half), hi.min(self.smoke.hi() - half));
        let (enter, exit) = Rays8 { origin: from, direction: way }.in_box(lo, hi, F::ONE);
        let [.., a, b] = self.at(from + way * enter, enter.simd_lt(exit));
        F::ONE - [a, b].get(lamp).copied().unwrap_or(F::ZERO)
    }
}

#[cfg(test)]
impl Volume<'_> {
    /// The cells as they are shown.
    pub fn shown(&self) -> &[Eight] {
        self.shown
    }

    /// Which bricks of them are full.
    pub fn full(&self) -> &Voxels {
        self.full
    }
}
