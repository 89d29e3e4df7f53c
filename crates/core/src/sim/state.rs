//! The air and smoke of a grid, and one step of their motion.
//!
//! A cell's values are the lanes of one vector, so the eight neighbours that a point lies between are
//! eight loads for all of them. A step: forces and transport along the velocity (semi-Lagrangian, Stam
//! 1999), with vorticity confinement (Fedkiw, Stam and Jensen 2001); then the pressure that takes the
//! divergence away, by a fixed number of Jacobi sweeps that begin where the last step's ended.
//! Velocities are in cells per step.

use super::grid::Grid;
use crate::counters::{Counter, Counters};
use crate::math::lanes::{F, load, splat};
use crate::math::scalar::exp;
use crate::scene::{Air, Smoke, Voxels};

/// Lanes of a cell's values; the first three are the velocity.
pub const DENSITY: usize = 3;
/// See [`DENSITY`].
pub const TEMPERATURE: usize = 4;

/// Greatest velocity along an axis, cells per step.
pub const FASTEST: f32 = 4.0;

/// Values nearer to 0 are 0: no motion to be seen, no smoke, and never a subnormal number.
const LEAST: f32 = 1e-7;

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
    pub cells: Vec<F>,
    /// Pressure.
    pub pressure: Vec<f32>,
}

/// What steps need room for.
#[derive(Default)]
pub struct Room {
    /// The step before.
    pub before: Vec<F>,
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
        State { cells: vec![F::ZERO; grid.len()], pressure: vec![0.0; grid.len()] }
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
        let (whirls, motion) = (&room.scalars, Motion::of(air, smoke.cell));
        grid.rows(&mut room.before, &|place, at, out| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = match kinds[at + i] {
                    Kind::Solid => F::ZERO,
                    kind => {
                        let place = [place[0] + i, place[1], place[2]];
                        let force = motion.confine(cells, whirls, [1, row, slice], at + i);
                        motion.apply(transport(cells, grid, place, at + i), force, kind)
                    }
                };
            }
        });
        std::mem::swap(&mut self.cells, &mut room.before);

        let cells = &self.cells;
        grid.rows(&mut room.scalars, &|_, at, out| {
            let speed = |i: usize, axis: usize| cells[i].as_array()[axis];
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
                let push = F::new([slope(1), slope(row), slope(slice), 0.0, 0.0, 0.0, 0.0, 0.0]);
                *out = quiet(*out - push);
            }
        });
    }
}

/// The values, or 0 for those that are next to nothing.
#[inline(always)]
fn quiet(v: F) -> F {
    v & v.abs().simd_gt(splat(LEAST))
}

/// Rotation of the velocity about a cell, times two.
#[inline(always)]
fn curl(cells: &[F], [x, y, z]: [usize; 3], i: usize) -> [f32; 3] {
    let across = |step: usize| cells[i + step] - cells[i - step];
    let (dx, dy, dz) = (across(x), across(y), across(z));
    let (dx, dy, dz) = (dx.as_array(), dy.as_array(), dz.as_array());
    [dy[2] - dz[1], dz[0] - dx[2], dx[1] - dy[0]]
}

/// What comes to the cell at `place` from where it was a step ago.
#[inline(always)]
fn transport(cells: &[F], grid: Grid, place: [usize; 3], i: usize) -> F {
    let speed = cells[i].to_array();
    let [_, row_step, slice] = grid.steps();
    let from = |axis: usize| (place[axis] + 1) as f32 - speed[axis];
    let (cell, within) = grid.corner([from(0), from(1), from(2)]);
    let (base, within) = (grid.bordered(cell), within.map(splat));
    let between = |a: F, b: F, t: F| a + (b - a) * t;
    let row = |i: usize| between(cells[i], cells[i + 1], within[0]);
    let sheet = |i: usize| between(row(i), row(i + row_step), within[1]);
    between(sheet(base), sheet(base + slice), within[2])
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
    fn confine(&self, cells: &[F], whirls: &[f32], steps: [usize; 3], i: usize) -> [f32; 3] {
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
    fn apply(&self, values: F, force: [f32; 3], kind: Kind) -> F {
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
        quiet(F::new(v).fast_max(self.least).fast_min(self.most))
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
