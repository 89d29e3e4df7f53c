//! The air and smoke of a grid, and one step of their motion.
//!
//! A cell's values stand side by side in the lanes of one vector, so the eight neighbours that a point lies
//! between are eight loads for all of them. A step:
//! - Transport along the velocity (semi-Lagrangian, Stam 1999), mended in one pass: going there and back
//!   changes a value by t (1 - t) of its second difference along each axis, where t is the part of a cell
//!   that is gone; about half of that is taken back, within the values around. That is MacCormack's method (Selle
//!   et al. 2008) but for products of axes, without its two more transports. Then forces and losses.
//! - Light, which comes to a cell from a point nearer to the lamp, less what the cell takes. So it goes on
//!   by a few cells a step, faster than smoke, and costs the same however deep the smoke is.
//! - The pressure that takes the divergence away, by a fixed number of Jacobi sweeps that begin where the
//!   last step's ended. Solid cells stay still, and the pressure learns of it by their divergence.
//!
//! Velocities are in cells per step.

use super::grid::{Eight, Grid, lanes};
use crate::counters::{Counter, Counters};
use crate::features;
use crate::math::lanes::{Bound, F, load, splat};
use crate::math::{Vec3, cross};
use crate::scene::{Rules, Voxels};
use std::mem::swap;

/// Lanes of a cell's values; the first three are the velocity.
pub const DENSITY: usize = 3;
/// Temperature, see [`DENSITY`].
pub const HEAT: usize = 4;
/// Share of the light of the first lamp that is lost on its way, see [`DENSITY`]; that of the second follows.
pub const DARK: usize = 5;
/// 1 for a solid cell, see [`DENSITY`].
pub const SOLID: usize = 7;

/// Greatest velocity along an axis, cells per step.
pub const FASTEST: f32 = 4.0;

/// Values nearer to 0 are 0: no motion to be seen, no smoke, and never a subnormal number.
const LEAST: f32 = 1e-4;

/// One over the neighbours of a cell, and a little less, so that pressure can't drift in closed rooms, where
/// nothing determines it.
const SHARE: f32 = 0.99 / 6.0;

/// Share of its bend that is taken back from a value. Of velocities less than the half that would be exact:
/// whirls of two cells, which the pressure doesn't see, would stay for ever and weave the smoke.
const MEND: Eight = [0.375, 0.375, 0.375, 0.5, 0.5, 0.0, 0.0, 0.0];

/// Cells that light goes on by at a time.
const REACH: f32 = 2.0;

/// All that moves.
#[derive(Clone, Default)]
pub struct State {
    /// The values of each cell.
    pub cells: Vec<Eight>,
    /// Those of the step before.
    pub before: Vec<Eight>,
    /// Pressure, eight cells to an element, as in those that follow: most of their memory is never touched.
    pub pressure: Vec<Eight>,
    next: Vec<Eight>,
    divergence: Vec<Eight>,
    /// What is in the way, and what smokes.
    figure: Voxels,
}

impl State {
    /// Still air.
    pub fn new(smoke: &Rules) -> Self {
        let field = || vec![[0.0; 8]; Grid { size: smoke.size }.len()];
        State {
            cells: field(),
            before: field(),
            pressure: field(),
            next: field(),
            divergence: field(),
            figure: Voxels::default(),
        }
    }

    /// Takes the step with this number.
    #[inline(never)]
    pub fn step(&mut self, smoke: &Rules, number: u32, counters: &mut Counters) {
        counters.add(Counter::SmokeCells, smoke.size.iter().product());
        let grid = Grid { size: smoke.size };
        let steps = grid.steps();
        (smoke.figure)(number, &mut self.figure);
        let figure = &self.figure;
        let air = &smoke.air;
        let most = F::new([FASTEST, FASTEST, FASTEST, f32::MAX, f32::MAX, 0.0, 0.0, 0.0]);
        // From places to the figure's cells.
        let scale = splat(smoke.cell / figure.cell);
        let shift = lanes(((smoke.lo - 0.5 * smoke.cell - figure.lo) / figure.cell).into());
        // One lamp a step.
        let lamp = number as usize & 1;
        let thickness = smoke.extinction * smoke.depth * smoke.cell * REACH;
        let at_lamp = lanes(((smoke.lamps[lamp] - smoke.lo) / smoke.cell + 0.5).into());

        let cells = &self.cells;
        grid.each(&mut self.before, 1, &|[first, y, z]: [usize; 3], i: usize, row: &mut [Eight]| {
            for (x, out) in row.iter_mut().enumerate() {
                let (place, i) = ([first + x, y, z], i + x);
                let cell = |i: usize| F::new(cells[i]);
                let old = cell(i);
                let at = lanes(place.map(|x| x as f32));
                let [x, y, z, ..] = *(at * scale + shift).floor().fast_trunc_int().as_array();
                let kind = figure.get([x, y, z]);
                let solid = Voxels::is_solid(kind);
                let way = at_lamp - at;
                let [x, y, z, ..] = (way * way).to_array();
                let nearer = at + way * splat(REACH / (x + y + z).sqrt());
                let taken = old.as_array()[DENSITY] * thickness;
                let came = grid.sample(cells, nearer).as_array()[DARK + lamp];
                // 1 - (1 - came) exp(-taken), nearly.
                let taken = taken + 0.5 * taken * taken;
                let dark = (came + taken) / (1.0 + taken);
                let mut new = F::ZERO;
                if !solid && (kind != Voxels::EMPTY || ((old * most).simd_ne(F::ZERO)).any()) {
                    let from = at - old;
                    new = grid.sample(cells, from);
                    let within = from - from.floor();
                    let halves = within * (F::ONE - within);
                    let (mut low, mut high) = (new.at_most(old), new.at_least(old));
                    let mut bend = F::ZERO;
                    for (axis, step) in steps.into_iter().enumerate() {
                        let (a, b) = (cell(i - step), cell(i + step));
                        low = low.at_most(a).at_most(b);
                        high = high.at_least(a).at_least(b);
                        bend += (a + b - (old + old)) * splat(halves.as_array()[axis]);
                    }
                    new = (new - bend * F::new(MEND)).at_least(low).at_most(high) * F::new(air.keep);
                    let [.., density, heat, _, _, _] = new.to_array();
                    new += F::new(air.by_density) * splat(density) + F::new(air.by_heat) * splat(heat);
                    if kind != Voxels::EMPTY {
                        new = new.at_least(F::new(air.source));
                    }
                    new = quiet(new.at_least(-most).at_most(most));
                }
                *out = new.to_array();
                out[DARK..SOLID].copy_from_slice(&old.as_array()[DARK..SOLID]);
                out[DARK + lamp] = dark;
                out[SOLID] = f32::from(solid);
            }
        });
        swap(&mut self.cells, &mut self.before);
        if features::SWIRL && air.swirl > 0.0 {
            counters.add(Counter::SmokeSwirled, smoke.size.iter().product());
            self.swirl(&grid, air.swirl);
        }

        let cells = &self.cells;
        grid.each(&mut self.divergence, 8, &|_: [usize; 3], i: usize, row: &mut [Eight]| {
            for (i, out) in (i..).zip(row.as_flattened_mut()) {
                *out = 0.0;
                for (axis, step) in steps.into_iter().enumerate() {
                    *out += 0.5 * (cells[i + step][axis] - cells[i - step][axis]);
                }
            }
        });
        let divergence = self.divergence.as_flattened();
        for _ in 0..air.sweeps {
            let pressure = self.pressure.as_flattened();
            grid.each(&mut self.next, 8, &|_: [usize; 3], i: usize, row: &mut [Eight]| {
                for (i, out) in (i..).step_by(8).zip(row) {
                    let mut sum = -load(&divergence[i..]);
                    for step in steps {
                        sum += load(&pressure[i - step..]) + load(&pressure[i + step..]);
                    }
                    *out = quiet(sum * splat(SHARE)).to_array();
                }
            });
            swap(&mut self.pressure, &mut self.next);
        }
        let pressure = self.pressure.as_flattened();
        grid.each(&mut self.cells, 1, &|_: [usize; 3], i: usize, row: &mut [Eight]| {
            for (i, out) in (i..).zip(row) {
                let mut slope = [0.0; 3];
                for (slope, step) in slope.iter_mut().zip(steps) {
                    *slope = 0.5 * (1.0 - out[SOLID]) * (pressure[i + step] - pressure[i - step]);
                }
                *out = quiet(F::new(*out) - lanes(slope)).to_array();
            }
        });
    }

    /// Turns whirls faster that transport has slowed: confinement of vorticity (Fedkiw, Stam and Jensen 2001). A
    /// cell is pushed by `share` of N × ω, where ω is the curl of the velocity and N points to where it is
    /// greater.
    fn swirl(&mut self, grid: &Grid, share: f32) {
        let steps = grid.steps();
        // What it held is made anew afterwards, and of its border nothing is read but here.
        let (cells, curl) = (&self.cells, &mut self.divergence);
        curl.fill([0.0; 8]);
        grid.each(curl, 1, &|_: [usize; 3], i: usize, row: &mut [Eight]| {
            for (i, out) in (i..).zip(row) {
                let across = |axis: usize, of: usize| {
                    let step = steps[axis];
                    0.5 * (cells[i + step][of] - cells[i - step][of])
                };
                let w = [0, 1, 2].map(|k| {
                    let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                    across(a, b) - across(b, a)
                });
                out[..3].copy_from_slice(&w);
                out[3] = Vec3::from_array(w).length();
            }
        });
        let curl = &self.divergence;
        let most = lanes([FASTEST; 3]);
        let lane = lanes([1.0; 3]).simd_gt(F::ZERO);
        grid.each(&mut self.cells, 1, &|_: [usize; 3], i: usize, row: &mut [Eight]| {
            for (i, out) in (i..).zip(row) {
                let slope = Vec3::from_array(steps.map(|step| 0.5 * (curl[i + step][3] - curl[i - step][3])));
                let [x, y, z, ..] = curl[i];
                // The small number of the paper, which keeps even air from being pushed.
                let push = cross(slope / (slope.length() + 1e-5), Vec3::new(x, y, z)) * share;
                if out[SOLID] == 0.0 {
                    let old = F::new(*out);
                    let new = quiet((old + lanes(push.into())).at_least(-most).at_most(most));
                    *out = lane.select(new, old).to_array();
                }
            }
        });
    }
}

/// The values, or 0 for those that are next to nothing.
#[inline(always)]
fn quiet(v: F) -> F {
    v & v.abs().simd_gt(splat(LEAST))
}
