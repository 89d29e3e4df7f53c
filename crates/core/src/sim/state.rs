//! The air and smoke of a grid, and one step of their motion.
//!
//! A cell's values stand side by side and are loaded into the lanes of one vector, so the eight
//! neighbours that a point lies between are eight loads for all of them. A step: forces and transport
//! along the velocity (semi-Lagrangian, Stam 1999; mended by half of what going there and back changes,
//! within the values it came from: MacCormack's method, Selle et al. 2008), with vorticity confinement
//! (Fedkiw, Stam and Jensen 2001); then the pressure that takes the divergence away, by a fixed number
//! of Jacobi sweeps that begin where the last step's ended. Velocities are in cells per step.

use super::grid::Grid;
use crate::counters::{Counter, Counters};
use crate::math::lanes::{F, load, splat};
use crate::math::scalar::exp;
use crate::scene::{Air, Smoke, Voxels};

/// Lanes of a cell's values; the first three are the velocity.
pub const DENSITY: usize = 3;
/// See [`DENSITY`].
pub const TEMPERATURE: usize = 4;

/// A cell's values: velocity, density, temperature.
pub type Cell = [f32; 5];

/// Nothing at all.
const STILL: Cell = [0.0; 5];

/// Greatest velocity along an axis, cells per step.
pub const FASTEST: f32 = 4.0;

/// Values nearer to 0 are 0: no motion to be seen, no smoke, and never a subnormal number.
const LEAST: f32 = 1e-4;

/// Share of the last step's pressure that the next begins with. Under 1, so that it can't drift in
/// closed rooms, whose pressure nothing determines.
const KEPT: f32 = 0.9;

/// Whirls slower than this, per step, are left alone.
const CALM: f32 = 1e-3;

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// Full of air.
    Air,
    /// Solid.
    Solid,
    /// Where smoke comes from.
    Source,
}

/// All that moves.
#[derive(Clone, Default)]
pub struct State {
    /// The values of each cell.
    pub cells: Vec<Cell>,
    /// Pressure.
    pub pressure: Vec<f32>,
}

/// What steps need room for.
#[derive(Default)]
pub struct Room {
    /// The step before.
    pub before: Vec<Cell>,
    /// What transport brings before it is mended.
    first: Vec<Cell>,
    /// What each cell is.
    pub kinds: Vec<Kind>,
    figure: Voxels,
    fresh: bool,
    /// One over the number of neighbours that aren't solid, 0 in solid cells; 1 beyond open borders.
    share: Vec<f32>,
    /// Strength of whirls, then divergence.
    scalars: Vec<f32>,
    pressure: Vec<f32>,
}

impl State {
    /// Still air.
    pub fn new(grid: Grid) -> Self {
        State { cells: vec![STILL; grid.len()], pressure: vec![0.0; grid.len()] }
    }

    /// Goes one step on, among `figure`.
    #[inline(never)]
    pub fn step(
        &mut self,
        grid: Grid,
        smoke: &Smoke,
        figure: Voxels,
        room: &mut Room,
        counters: &mut Counters,
    ) {
        counters.add(Counter::SmokeCells, grid.size.iter().product());
        room.fit(grid, smoke, figure);
        let [_, row, slice] = grid.steps();
        let air = &smoke.air;
        let (cells, kinds) = (&self.cells, &room.kinds);

        grid.rows(&mut room.scalars, &|_, at, out| {
            for (i, out) in out.iter_mut().enumerate() {
                let [x, y, z] = curl(cells, [1, row, slice], at + i);
                *out = (x * x + y * y + z * z).sqrt();
            }
        });
        grid.rows(&mut room.first, &|place, at, out| {
            for (i, out) in out.iter_mut().enumerate() {
                if cells[at + i] == STILL {
                    *out = STILL;
                    continue;
                }
                let place = [place[0] + i, place[1], place[2]];
                *out = cut(transport(cells, values(cells, at + i), F::ONE, grid, place).0);
            }
        });
        let (whirls, first, motion) = (&room.scalars, &room.first, Motion::of(air, smoke.cell));
        grid.rows(&mut room.before, &|place, at, out| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = match kinds[at + i] {
                    Kind::Solid => STILL,
                    // What the formulas below would give, too.
                    Kind::Air if cells[at + i] == STILL && whirls[at + i] < CALM => STILL,
                    kind => {
                        let place = [place[0] + i, place[1], place[2]];
                        let old = values(cells, at + i);
                        let (_, least, most) = transport(cells, old, F::ONE, grid, place);
                        let (back, ..) = transport(first, old, -F::ONE, grid, place);
                        let mended = values(first, at + i) + (old - back) * splat(0.5);
                        let force = motion.confine(cells, whirls, [1, row, slice], at + i);
                        motion.apply(mended.fast_max(least).fast_min(most), force, kind)
                    }
                };
            }
        });
        std::mem::swap(&mut self.cells, &mut room.before);

        let cells = &self.cells;
        grid.rows(&mut room.scalars, &|_, at, out| {
            let speed = |i: usize, axis: usize| cells[i][axis];
            for (i, out) in (at..).zip(out) {
                let x = speed(i + 1, 0) - speed(i - 1, 0);
                let y = speed(i + row, 1) - speed(i - row, 1);
                let z = speed(i + slice, 2) - speed(i - slice, 2);
                *out = 0.5 * (x + y + z);
            }
        });
        for value in &mut self.pressure {
            *value *= KEPT;
        }
        let (divergence, share) = (&room.scalars, &room.share);
        for _ in 0..air.sweeps {
            let from = &self.pressure;
            grid.rows(&mut room.pressure, &|_, at, out| {
                for (k, out) in out.chunks_exact_mut(8).enumerate() {
                    let i = at + 8 * k;
                    let near = |step: usize| load(&from[i - step..]) + load(&from[i + step..]);
                    let sum = near(1) + near(row) + near(slice) - load(&divergence[i..]);
                    out.copy_from_slice(quiet(sum * load(&share[i..])).as_array());
                }
            });
            std::mem::swap(&mut self.pressure, &mut room.pressure);
        }
        let pressure = &self.pressure;
        grid.rows(&mut self.cells, &|_, at, out| {
            for (i, out) in (at..).zip(out) {
                if share[i] == 0.0 {
                    continue;
                }
                // A wall has the pressure of the cell beside it.
                let at = |j: usize| if share[j] == 0.0 { pressure[i] } else { pressure[j] };
                let slope = |step: usize| 0.5 * (at(i + step) - at(i - step));
                for (speed, step) in out.iter_mut().zip([1, row, slice]) {
                    let new = *speed - slope(step);
                    *speed = if new.abs() > LEAST { new } else { 0.0 };
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

/// The values of a cell; in the lanes after them are others.
#[inline(always)]
fn values(cells: &[Cell], i: usize) -> F {
    load(&cells.as_flattened()[5 * i..])
}

/// The lanes that are a cell's values.
#[inline(always)]
fn cut(v: F) -> Cell {
    v.as_array().first_chunk().copied().unwrap_or_default()
}

/// Rotation of the velocity about a cell, times two.
#[inline(always)]
fn curl(cells: &[Cell], [x, y, z]: [usize; 3], i: usize) -> [f32; 3] {
    let across = |step: usize, axis: usize| cells[i + step][axis] - cells[i - step][axis];
    [across(y, 2) - across(z, 1), across(z, 0) - across(x, 2), across(x, 1) - across(y, 0)]
}

/// What `field` is where the air of the cell at `place` was a step ago (or will be after `time` steps less
/// one), and the least and greatest of the values it lies between.
#[inline(always)]
fn transport(field: &[Cell], speed: F, time: F, grid: Grid, place: [usize; 3]) -> (F, F, F) {
    let [_, row, slice] = grid.steps();
    let lanes = |[x, y, z]: [usize; 3]| F::new([x as f32, y as f32, z as f32, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let (place, size) = (lanes(place) + F::ONE, lanes(grid.size));
    // Bounded before it becomes a whole number.
    let from = (place - speed * time).fast_max(F::ZERO).fast_min(size + F::ONE);
    let below = from.fast_min(size).fast_trunc_int();
    let within = from - F::from_i32x8(below);
    let below = below.as_array();
    let base = grid.bordered([below[0] as usize, below[1] as usize, below[2] as usize]);
    let within = within.as_array();
    let within = [splat(within[0]), splat(within[1]), splat(within[2])];
    let line = |i: usize| {
        let (a, b) = (values(field, base + i), values(field, base + i + 1));
        (a + (b - a) * within[0], a.fast_min(b), a.fast_max(b))
    };
    let (a, b, c, d) = (line(0), line(row), line(slice), line(row + slice));
    let between = |a: F, b: F, t: F| a + (b - a) * t;
    (
        between(between(a.0, b.0, within[1]), between(c.0, d.0, within[1]), within[2]),
        a.1.fast_min(b.1).fast_min(c.1.fast_min(d.1)),
        a.2.fast_max(b.2).fast_max(c.2.fast_max(d.2)),
    )
}

/// What the air's constants make of a step, in cells and steps.
struct Motion {
    keep: F,
    most: F,
    least: F,
    lift: f32,
    weight: f32,
    wind: [f32; 3],
    whirl: f32,
    source: [f32; 2],
}

impl Motion {
    fn of(air: &Air, cell: f32) -> Self {
        let rate = |loss: f32| exp(-loss * Air::SECONDS);
        let (d, f, c) = (rate(air.drag), rate(air.fade), rate(air.cool));
        let pace = Air::SECONDS * Air::SECONDS / cell;
        Motion {
            keep: F::new([d, d, d, f, c, 0.0, 0.0, 0.0]),
            most: F::new([FASTEST, FASTEST, FASTEST, f32::MAX, f32::MAX, 0.0, 0.0, 0.0]),
            least: F::new([-FASTEST, -FASTEST, -FASTEST, 0.0, 0.0, 0.0, 0.0, 0.0]),
            lift: air.lift * pace,
            weight: air.weight * pace,
            wind: (air.wind * pace).to_array(),
            whirl: air.whirl * Air::SECONDS,
            source: [air.density, air.heat],
        }
    }

    /// Push that keeps a whirl turning: across the way to where it is stronger.
    #[inline(always)]
    fn confine(&self, cells: &[Cell], whirls: &[f32], steps: [usize; 3], i: usize) -> [f32; 3] {
        if self.whirl == 0.0 || whirls[i] < CALM {
            return [0.0; 3];
        }
        let [x, y, z] = steps.map(|step| whirls[i + step] - whirls[i - step]);
        let [a, b, c] = curl(cells, steps, i);
        let scale = self.whirl / ((x * x + y * y + z * z).sqrt() + 1e-5);
        [(y * c - z * b) * scale, (z * a - x * c) * scale, (x * b - y * a) * scale]
    }

    /// The values of a cell after forces, losses and sources.
    #[inline(always)]
    fn apply(&self, values: F, force: [f32; 3], kind: Kind) -> Cell {
        let mut v = (values * self.keep).to_array();
        if kind == Kind::Source {
            v[DENSITY] = v[DENSITY].max(self.source[0]);
            v[TEMPERATURE] = v[TEMPERATURE].max(self.source[1]);
        }
        let (density, heat) = (v[DENSITY], v[TEMPERATURE]);
        for axis in 0..3 {
            v[axis] += force[axis] + self.wind[axis] * density;
        }
        v[1] += self.lift * heat - self.weight * density;
        cut(quiet(F::new(v).fast_max(self.least).fast_min(self.most)))
    }
}

impl Room {
    /// For a grid full of air.
    pub fn new(grid: Grid) -> Self {
        let still = State::new(grid);
        Room {
            kinds: vec![Kind::Air; grid.len()],
            share: vec![1.0; grid.len()],
            scalars: still.pressure.clone(),
            first: still.cells.clone(),
            before: still.cells,
            pressure: still.pressure,
            figure: Voxels::default(),
            fresh: true,
        }
    }

    /// Makes room for a grid, and finds out what its cells are.
    #[inline(never)]
    fn fit(&mut self, grid: Grid, smoke: &Smoke, figure: Voxels) {
        if self.figure == figure && !self.fresh {
            return;
        }
        self.fresh = false;
        let [_, row, slice] = grid.steps();
        self.kinds.clear();
        self.kinds.resize(grid.len(), Kind::Air);
        self.share.clear();
        self.share.resize(grid.len(), 1.0);
        let place = |i: usize, axis: usize| {
            let middle = smoke.lo[axis] + (i as f32 + 0.5) * smoke.cell;
            ((middle - figure.lo[axis]) / figure.cell).floor() as i32
        };
        grid.rows(&mut self.kinds, &|[_, y, z], _, out| {
            let (y, z) = (place(y, 1), place(z, 2));
            for (x, kind) in out.iter_mut().enumerate() {
                let value = figure.get([place(x, 0), y, z]);
                if value != Voxels::EMPTY {
                    *kind = if Voxels::is_solid(value) { Kind::Solid } else { Kind::Source };
                }
            }
        });
        let kinds = &self.kinds;
        grid.rows(&mut self.share, &|[_, y, _], at, out| {
            for (i, share) in (at..).zip(out) {
                let open = |j: usize| u32::from(kinds[j] != Kind::Solid);
                // The ground is solid too; all other borders are open.
                let below = if y == 0 { 0 } else { open(i - row) };
                let sides = open(i - 1) + open(i + 1) + open(i - slice) + open(i + slice);
                let count = sides + below + open(i + row);
                *share = if count * open(i) == 0 { 0.0 } else { 1.0 / count as f32 };
            }
        });
        for z in 0..=grid.size[2] + 1 {
            self.share[z * slice..z * slice + row].fill(0.0);
        }
        self.figure = figure;
    }
}
