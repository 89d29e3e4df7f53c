//! What light makes of smoke: extinction and light scattered to the eye for each cell, once a frame.
//!
//! From each lamp the light goes through the grid slice by slice, away from the lamp: what comes to a
//! cell is what has come to where its ray crossed the slice before, between four cells, less what the
//! cell takes. This costs the same however far the light has come, and softens it on its way, as
//! scattering more than once does.

use super::Simulation;
use super::grid::Grid;
use super::state::{DENSITY, Kind, TEMPERATURE};
use crate::counters::{Counter, Counters};
use crate::math::Vec3;
use crate::math::lanes::{F, RAMP, V3, load, splat};
use crate::math::scalar;
use crate::parallel;
use crate::scene::Smoke;
use crate::shade::Lamp;
use crate::shade::extinction::Depth;
use crate::shade::phase::phase;
use crate::trace::Rays8;

/// Side of the bricks by which empty space is skipped, cells.
const BRICK: usize = 4;

/// A ray ends where less light than this comes through: what it leaves out is at most this share of
/// the brightest smoke.
pub const OPAQUE: f32 = 1.0 / 512.0;

/// Steps of a ray, at most: more than there are in any grid.
const MOST_STEPS: u32 = 1024;

/// Steradians all around, by which even scattering is 1.
const SPHERE: f32 = 4.0 * std::f32::consts::PI;

/// Light that comes to a cell from a lamp: past the smoke, and past the solid cells too.
type Through = [f32; 2];

/// Smoke made ready for rays.
#[derive(Default)]
pub struct Volume {
    grid: Grid,
    lo: Vec3,
    cell: f32,
    /// Box around all that isn't empty, world.
    bounds: [Vec3; 2],
    density: Vec<f32>,
    /// Per cell the extinction per world unit, and that times the light scattered towards the eye.
    shown: Vec<[f32; 4]>,
    /// Per lamp; empty for one whose light comes from within.
    through: Vec<Vec<Through>>,
    /// Whether there is something between the cells of a brick and their neighbours.
    bricks: Vec<bool>,
}

impl Volume {
    /// Lights the smoke of a simulation for an eye.
    #[inline(never)]
    pub fn light(
        &mut self,
        smoke: &Smoke,
        simulation: &Simulation,
        lamps: &[Lamp],
        eye: Vec3,
        counters: &mut Counters,
    ) {
        let grid = Grid { size: smoke.size };
        (self.grid, self.lo, self.cell) = (grid, smoke.lo, smoke.cell);
        counters.add(Counter::SmokeLight, grid.size.iter().product::<usize>() * lamps.len());
        self.density.resize(grid.len(), 0.0);
        self.shown.resize(grid.len(), [0.0; 4]);
        self.through.resize_with(lamps.len(), Vec::new);
        let (now, before, kinds) = (&simulation.state().cells, simulation.before(), simulation.kinds());
        let behind = if smoke.steps > 0 { smoke.behind } else { 0.0 };
        grid.rows(&mut self.density, &|_, at, out| {
            for (i, out) in (at..).zip(out) {
                let [a, b] = [now, before].map(|cells| cells[i][DENSITY]);
                *out = a + (b - a) * behind;
            }
        });
        let density = &self.density;
        let thickness = smoke.extinction * smoke.depth * smoke.cell;
        parallel::each(self.through.iter_mut().zip(lamps), |_, (out, lamp)| {
            let lamp = (lamp.position - smoke.lo) / smoke.cell - 0.5;
            shine(grid, density, kinds, lamp, thickness, out);
        });
        let through = &self.through;
        let [weight, g, other] = smoke.phase;
        grid.rows(&mut self.shown, &|[_, y, z], at, out| {
            for (k, out) in out.chunks_exact_mut(8).enumerate() {
                let at = at + 8 * k;
                let density = load(&density[at..]);
                if !density.simd_gt(F::ZERO).any() {
                    out.fill([0.0; 4]);
                    continue;
                }
                let along = |i: usize, axis: usize| smoke.lo[axis] + (i as f32 + 0.5) * smoke.cell;
                let x = splat(along(8 * k, 0)) + RAMP * splat(smoke.cell);
                let p = V3::new(x, splat(along(y, 1)), splat(along(z, 2)));
                let to_eye = (V3::splat(eye) - p).normalize();
                let heat = F::new(std::array::from_fn(|i| now[at + i][TEMPERATURE]));
                let mut light = V3::splat(smoke.ambient) + V3::splat(smoke.glow) * heat;
                for (lamp, through) in lamps.iter().zip(through) {
                    let way = V3::splat(lamp.position) - p;
                    let d2 = way.dot(way).fast_max(splat(smoke.cell * smoke.cell));
                    let l = way * (F::ONE / d2.sqrt());
                    let cos = -l.dot(to_eye);
                    let turned = splat(weight) * phase(g, cos) + splat(1.0 - weight) * phase(other, cos);
                    let mut reach = lamp.lobe(-l) * turned * splat(smoke.gain * SPHERE) / d2;
                    if !through.is_empty() {
                        reach *= F::new(std::array::from_fn(|i| through[at + i][1]));
                    }
                    light += V3::splat(lamp.colour) * reach;
                }
                let sigma = density * splat(smoke.extinction);
                let light = light * V3::splat(smoke.albedo) * sigma;
                for (i, out) in out.iter_mut().enumerate() {
                    let [x, y, z] = light.lane(i).to_array();
                    *out = [sigma.as_array()[i], x, y, z];
                }
            }
        });
        self.find_empty();
    }

    /// Bricks along each axis; they begin in the border.
    fn brick_counts(&self) -> [usize; 3] {
        self.grid.size.map(|n| n / BRICK + 1)
    }

    /// Finds the empty bricks, and the box around the others.
    #[inline(never)]
    fn find_empty(&mut self) {
        let [bx, by, bz] = self.brick_counts();
        let (grid, shown) = (self.grid, &self.shown);
        self.bricks.resize(bx * by * bz, false);
        parallel::each(self.bricks.chunks_mut(bx * by), |z, layer| {
            for (i, full) in layer.iter_mut().enumerate() {
                let from = [i % bx, i / bx, z].map(|b| b * BRICK);
                let far = |axis: usize| (from[axis] + BRICK).min(grid.size[axis] + 1);
                *full = (from[2]..=far(2)).any(|z| {
                    (from[1]..=far(1)).any(|y| {
                        let row = |x: usize| grid.bordered([x, y, z]);
                        shown[row(from[0])..=row(far(0))].iter().any(|cell| cell[0] > 0.0)
                    })
                });
            }
        });
        let (mut lo, mut hi) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (i, _) in self.bricks.iter().enumerate().filter(|(_, full)| **full) {
            let corner = [i % bx, i / bx % by, i / (bx * by)].map(|b| (b * BRICK) as f32 - 0.5);
            let corner = Vec3::from_array(corner) * self.cell + self.lo;
            (lo, hi) = (lo.min(corner), hi.max(corner + BRICK as f32 * self.cell));
        }
        self.bounds = [lo, hi];
    }

    /// Box around all the smoke, world; its corners are in the wrong order if there is none.
    pub fn bounds(&self) -> [Vec3; 2] {
        self.bounds
    }

    /// Share of what lies behind that rays with unit directions see through the smoke up to `end`, and
    /// the light that the smoke adds. Steps are `pace` cells long.
    #[inline(never)]
    pub fn march(&self, rays: &Rays8, end: F, pace: f32, counters: &mut Counters) -> (F, V3) {
        let mut seen = (F::ONE, V3::ZERO);
        let [lo, hi] = self.bounds;
        let (enter, exit) = rays.in_box(lo, hi, end);
        let run = exit - enter;
        let scale = splat(1.0 / self.cell);
        let origin = (rays.origin - V3::splat(self.lo)) * scale;
        let direction = rays.direction * scale;
        let step = splat(pace * self.cell);
        let mut depth = Depth::default();
        let [_, row, slice] = self.grid.steps();
        let [bx, by, _] = self.brick_counts();
        for k in 0..MOST_STEPS {
            // Places are counted, not added up.
            let at = step * splat(k as f32);
            let left = run - at;
            let busy = left.simd_gt(F::ZERO) & seen.0.simd_gt(splat(OPAQUE));
            let mut todo = busy.to_bitmask();
            if todo == 0 {
                break;
            }
            let length = left.fast_min(step);
            let p = origin + direction * (enter + at + length * splat(0.5));
            let [x, y, z] = [p.x, p.y, p.z].map(|x| (x + splat(0.5)).to_array());
            let mut found = [F::ZERO; 4];
            while todo != 0 {
                let lane = todo.trailing_zeros() as usize & 7;
                todo &= todo - 1;
                let (cell, within) = self.grid.corner([x[lane], y[lane], z[lane]]);
                let [i, j, k] = cell.map(|c| c / BRICK);
                if !self.bricks[(k * by + j) * bx + i] {
                    continue;
                }
                counters.add(Counter::SmokeMarched, 1);
                let within = within.map(splat);
                let base = self.grid.bordered(cell);
                // Two cells at once, four values each.
                let pair = |i: usize| load(self.shown[i..i + 2].as_flattened());
                let between = |a: F, b: F, t: F| a + (b - a) * t;
                let sheet = |i: usize| between(pair(i), pair(i + row), within[1]);
                let both = between(sheet(base), sheet(base + slice), within[2]);
                let (both, x) = (both.as_array(), within[0].as_array()[0]);
                for (c, found) in found.iter_mut().enumerate() {
                    found.as_mut_array()[lane] = both[c] + (both[c + 4] - both[c]) * x;
                }
            }
            let [sigma, r, g, b] = found;
            let taken = busy & (sigma * length);
            depth.add(taken);
            let through = depth.through();
            // The light of a step as it is dimmed on its way through it.
            let share = (seen.0 - through) / taken.fast_max(splat(1e-9)) * length;
            seen.1 += V3::new(r, g, b) * (busy & share);
            seen.0 = through;
        }
        seen
    }

    /// Share of a lamp's light that the smoke leaves on its way from `from + way`, where the lamp is,
    /// to `from`.
    #[inline(never)]
    pub fn shadow(&self, lamp: usize, from: V3, way: V3) -> F {
        let mut share = F::ONE;
        let Some(through) = self.through.get(lamp).filter(|through| !through.is_empty()) else {
            return share;
        };
        // Between the middles of cells: beyond those of the last there is no shadow yet.
        let [lo, hi] = self.bounds;
        let size = Vec3::from_array(self.grid.size.map(|n| n as f32));
        let (lo, hi) = (lo.max(self.lo + 0.5 * self.cell), hi.min(self.lo + (size - 0.5) * self.cell));
        let (enter, exit) = Rays8 { origin: from, direction: way }.in_box(lo, hi, F::ONE);
        let mut todo = enter.simd_lt(exit).to_bitmask();
        let p = (from + way * enter - V3::splat(self.lo)) * splat(1.0 / self.cell);
        let [_, row, slice] = self.grid.steps();
        while todo != 0 {
            let lane = todo.trailing_zeros() as usize & 7;
            todo &= todo - 1;
            let (cell, [x, y, z]) = self.grid.corner((p.lane(lane) + 0.5).to_array());
            let base = self.grid.bordered(cell);
            let between = |a: f32, b: f32, t: f32| a + (b - a) * t;
            let line = |i: usize| between(through[i][0], through[i + 1][0], x);
            let sheet = |i: usize| between(line(i), line(i + row), y);
            share.as_mut_array()[lane] = between(sheet(base), sheet(base + slice), z);
        }
        share
    }
}

/// Finds what of the light of a lamp at `lamp` (in cells, 0 the middle of the first) comes to each cell.
#[inline(never)]
fn shine(grid: Grid, density: &[f32], kinds: &[Kind], lamp: Vec3, thickness: f32, out: &mut Vec<Through>) {
    out.clear();
    let size = grid.size.map(|n| n as f32);
    let outside = |axis: usize| (-1.0 - lamp[axis]).max(lamp[axis] - size[axis]);
    let along = (0..3).fold(0, |best, axis| if outside(axis) > outside(best) { axis } else { best });
    if outside(along) <= 0.0 {
        return;
    }
    out.resize(grid.len(), [1.0; 2]);
    let (u, v) = ((along + 1) % 3, (along + 2) % 3);
    let steps = grid.steps();
    for k in 0..grid.size[along] {
        let up = lamp[along] < 0.0;
        let mut cell = [0; 3];
        cell[along] = if up { k } else { grid.size[along] - 1 - k };
        for j in 0..grid.size[v] {
            for i in 0..grid.size[u] {
                (cell[u], cell[v]) = (i, j);
                let way = lamp - Vec3::from_array(cell.map(|c| c as f32));
                let slant = 1.0 / way[along].abs();
                let mut at = cell.map(|c| (c + 1) as f32);
                at[u] += way[u] * slant;
                at[v] += way[v] * slant;
                let (mut from, within) = grid.corner(at);
                from[along] = if up { cell[along] } else { cell[along] + 2 };
                let from = grid.bordered(from);
                let own = grid.index(cell);
                let taken = density[own] * thickness * slant;
                let pass = if taken > 0.0 { scalar::exp(-taken * way.length()) } else { 1.0 };
                let mut light = [0.0; 2];
                for (c, light) in light.iter_mut().enumerate() {
                    let line = |i: usize| {
                        let (a, b) = (out[i][c], out[i + steps[u]][c]);
                        a + (b - a) * within[u]
                    };
                    let (a, b) = (line(from), line(from + steps[v]));
                    *light = (a + (b - a) * within[v]) * pass;
                }
                if kinds[own] == Kind::Solid {
                    light[1] = 0.0;
                }
                out[own] = light;
            }
        }
    }
}

#[cfg(test)]
impl Volume {
    /// Holds that an empty brick and its neighbours' first cells have no smoke, and that some are empty.
    pub fn check_bricks(&self) {
        let [bx, by, _] = self.brick_counts();
        let mut empty = 0;
        for (i, _) in self.bricks.iter().enumerate().filter(|(_, full)| !**full) {
            empty += 1;
            let from = [i % bx, i / bx % by, i / (bx * by)].map(|b| b * BRICK);
            for k in 0..125 {
                let cell = [k % 5, k / 5 % 5, k / 25];
                let cell: [usize; 3] =
                    std::array::from_fn(|axis| (from[axis] + cell[axis]).min(self.grid.size[axis] + 1));
                assert_eq!(self.shown[self.grid.bordered(cell)], [0.0; 4], "brick {i}");
            }
        }
        assert!(empty > 0 && empty < self.bricks.len());
    }
}
