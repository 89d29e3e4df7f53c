//! Laws of the motion of smoke: bounded and finite however long, nothing out of nothing,
//! less divergence with each sweep, the same on any number of threads and by any way to a step.

mod long;
mod sight;

use super::*;
use crate::counters::Counter;
use crate::math::Vec3;
use crate::math::lanes::{F, V3, splat};
use crate::quality::Quality;
use crate::render::{Stage, Tables};
use crate::scene::{Air, Edit, Light, LightKind, Scene, Voxels};
use crate::trace::Rays8;
use crate::trace::check::{Random, packet};

const SIZE: [usize; 3] = [16, 20, 12];

/// A wall to the left, and a source beside it for the first 40 steps.
fn burning(step: u32, figure: &mut Voxels) {
    figure.reset(Vec3::ZERO, 0.1, [16, 20, 12]);
    figure.edit(Edit::Add(1), [3, 0, 2], [5, 6, 9]);
    if step <= 40 {
        figure.edit(Edit::Overwrite(Voxels::SMOKE), [8, 1, 4], [12, 4, 8]);
    }
}

/// Smoke once, at the first step.
fn puff(step: u32, figure: &mut Voxels) {
    figure.reset(Vec3::ZERO, 0.1, [16, 20, 12]);
    if step == 1 {
        figure.edit(Edit::Overwrite(Voxels::SMOKE), [6, 7, 4], [11, 13, 8]);
    }
}

/// Smoke all over.
fn full(_: u32, figure: &mut Voxels) {
    figure.reset(Vec3::ZERO, 0.1, [16, 20, 12]);
    figure.edit_all(Edit::Overwrite(Voxels::SMOKE));
}

/// Lively air.
const AIR: Air = Air {
    density: 0.9,
    heat: 1.2,
    lift: 6.0,
    wind: Vec3::new(0.3, -0.5, -0.2),
    fade: 0.2,
    cool: 0.3,
    drag: 0.2,
    sweeps: 12,
    swirl: 0.0,
};

fn smoke(figure: fn(u32, &mut Voxels), air: Air) -> Smoke {
    let lamps = [Vec3::new(0.8, 1.0, -6.0), Vec3::new(-3.0, 4.0, 2.0)];
    made(Rules { cell: 0.1, size: SIZE, air: air.motion(0.1), lamps, ..Rules::new(figure) })
}

/// Its first moment.
fn made(rules: Rules) -> Smoke {
    Smoke { rules: Box::leak(Box::new(rules)), steps: 0, behind: 0.0 }
}

fn play(smoke: Smoke, steps: u32) -> Simulation {
    let mut simulation = Simulation::default();
    simulation.run(&Smoke { steps, ..smoke }, &mut Counters::default());
    simulation
}

fn values(simulation: &Simulation) -> impl Iterator<Item = f32> {
    let state = simulation.state();
    state.cells.iter().chain(&state.pressure).flatten().copied()
}

fn same(a: &Simulation, b: &Simulation) -> bool {
    let bits = |s: &Simulation| values(s).map(f32::to_bits).collect::<Vec<_>>();
    let before = |s: &Simulation| s.state().before.iter().flatten().map(|c| c.to_bits()).collect::<Vec<_>>();
    bits(a) == bits(b) && before(a) == before(b)
}

fn greatest(simulation: &Simulation, lane: usize) -> f32 {
    simulation.state().cells.iter().fold(0.0, |m, c| m.max(c[lane]))
}

#[test]
fn however_long_it_burns_all_is_finite_bounded_and_never_subnormal() {
    // Nothing is lost but through the borders, and nothing stops the source.
    fn ever(_: u32, figure: &mut Voxels) {
        burning(1, figure);
    }
    let air = Air { fade: 0.0, cool: 0.0, drag: 0.0, lift: 40.0, ..AIR };
    let boiling = Air { swirl: 0.5, ..air };
    for (name, s) in
        [("ever", smoke(ever, air)), ("boiling", smoke(ever, boiling)), ("burning", smoke(burning, AIR))]
    {
        let mut simulation = Simulation::default();
        let mut moved = false;
        for steps in 1..=3_000 {
            simulation.run(&Smoke { steps, ..s }, &mut Counters::default());
            if steps % 50 != 0 && steps > 60 {
                continue;
            }
            for cell in &simulation.state().cells {
                for (lane, v) in cell.iter().copied().enumerate() {
                    assert!(v.is_finite() && !v.is_subnormal(), "{name}: {v} in lane {lane} at step {steps}");
                    // The pressure's push comes after the bound.
                    let speed = FASTEST + 60.0;
                    let most = [speed, speed, speed, 0.9, 1.2, 1.0, 1.0, 1.0][lane];
                    assert!(v.abs() <= most, "{name}: {v} in lane {lane} at step {steps}");
                    moved |= lane == 1 && v > 0.1;
                }
            }
            let pressure = &mut simulation.state().pressure.iter().flatten();
            assert!(pressure.all(|p| p.is_finite() && !p.is_subnormal()));
        }
        assert!(moved, "{name}: the air stands still");
    }
}

#[test]
fn without_a_source_no_maximum_rises_and_at_last_the_air_is_clear() {
    let s = smoke(burning, AIR);
    let mut simulation = play(s, 40);
    let mut last = [DENSITY, HEAT].map(|lane| greatest(&simulation, lane));
    assert!(last[0] > 0.8, "{last:?}");
    for steps in 41..600 {
        simulation.run(&Smoke { steps, ..s }, &mut Counters::default());
        let now = [DENSITY, HEAT].map(|lane| greatest(&simulation, lane));
        assert!(now[0] <= last[0] && now[1] <= last[1], "{now:?} after {last:?} at step {steps}");
        last = now;
    }
    simulation.run(&Smoke { steps: 2_400, ..s }, &mut Counters::default());
    assert_eq!(greatest(&simulation, DENSITY), 0.0, "nothing is left, not even next to nothing");
}

#[test]
fn still_smoke_keeps_its_mass_and_moving_smoke_most_of_it() {
    let still = Air { sweeps: 8, ..Air::DEFAULT };
    let mass = |s: &Simulation| s.state().cells.iter().map(|c| f64::from(c[DENSITY])).sum::<f64>();
    let first = mass(&play(smoke(puff, still), 1));
    assert_eq!(mass(&play(smoke(puff, still), 100)), first);
    // A second of rising: transport by places, not by flow, loses mass where smoke spreads over few cells.
    let rising = Air { lift: 0.8, ..still };
    let drift = mass(&play(smoke(puff, rising), 30)) / first - 1.0;
    assert!(drift.abs() < 0.3, "{:.1} % of the mass", 100.0 * drift);
}

/// Root mean square of the divergence in the air.
fn divergence(simulation: &Simulation) -> f64 {
    let grid = Grid { size: SIZE };
    let [x, y, z] = grid.steps();
    let cells = &simulation.state().cells;
    let mut sum = 0.0;
    for k in 1..SIZE[2] - 1 {
        for j in 1..SIZE[1] - 1 {
            for i in 1..SIZE[0] - 1 {
                let at = grid.index([i + 1, j + 1, k + 1]);
                if cells[at][SOLID] > 0.0 {
                    continue;
                }
                let across = |axis: usize, step: usize| {
                    let [a, b] = [at + step, at - step].map(|i| f64::from(cells[i][axis]));
                    0.5 * (a - b)
                };
                let d = across(0, x) + across(1, y) + across(2, z);
                sum += d * d;
            }
        }
    }
    sum.sqrt()
}

#[test]
fn each_sweep_leaves_less_divergence() {
    let mut last = f64::INFINITY;
    let first = divergence(&play(smoke(burning, Air { sweeps: 0, ..AIR }), 3));
    for sweeps in 0..20 {
        // The same air up to the last step, which begins without pressure.
        let mut simulation = play(smoke(burning, Air { sweeps: 0, ..AIR }), 2);
        let s = smoke(burning, Air { sweeps, ..AIR });
        simulation.state.step(s.rules, 3, &mut Counters::default());
        let now = divergence(&simulation);
        assert!(now < last, "{now} after {last} with {sweeps} sweeps");
        last = now;
    }
    // What is left are whirls of two cells, which differences over two cells don't see.
    assert!(last < 0.6 * first, "{last} of {first}");
}

/// Sum of squares of the velocity's curl.
fn turning(simulation: &Simulation) -> f64 {
    let grid = Grid { size: SIZE };
    let steps = grid.steps();
    let cells = &simulation.state().cells;
    let mut sum = 0.0;
    for i in (0..SIZE.iter().product()).map(|i: usize| [i % 16, i / 16 % 20, i / 320]) {
        let at = grid.index(i.map(|i| i + 1));
        let across = |axis: usize, of: usize| {
            0.5 * f64::from(cells[at + steps[axis]][of] - cells[at - steps[axis]][of])
        };
        for (a, b) in [(1, 2), (2, 0), (0, 1)] {
            let w = across(a, b) - across(b, a);
            sum += w * w;
        }
    }
    sum
}

#[test]
fn swirl_keeps_whirls_turning_and_still_air_still() {
    let with = |figure, swirl, steps| play(smoke(figure, Air { swirl, ..AIR }), steps);
    let mut last = turning(&with(burning, 0.0, 100));
    for swirl in [0.1, 0.2, 0.3] {
        let now = turning(&with(burning, swirl, 100));
        assert!(now > 1.05 * last, "{now} after {last} with a swirl of {swirl}");
        last = now;
    }
    let calm = |swirl| play(smoke(puff, Air { swirl, ..Air::DEFAULT }), 30);
    assert!(same(&calm(0.0), &calm(0.3)), "where nothing moves, nothing begins to");
    // On any number of threads.
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| with(burning, 0.3, 60))
    };
    assert!(same(&on(1), &on(3)));
    // It is counted.
    let mut counters = Counters::default();
    Simulation::default()
        .run(&Smoke { steps: 2, ..smoke(burning, Air { swirl: 0.2, ..AIR }) }, &mut counters);
    let cells = if cfg!(feature = "counters") { 2 * 16 * 20 * 12 } else { 0 };
    assert_eq!(counters.get(Counter::SmokeSwirled), cells);
}

#[test]
fn solid_cells_stay_empty_and_still() {
    let s = smoke(burning, Air { swirl: 0.2, ..AIR });
    let mut simulation = Simulation::default();
    for steps in [1, 5, 20, 40, 80] {
        simulation.run(&Smoke { steps, ..s }, &mut Counters::default());
        let mut count = 0;
        for cell in simulation.state().cells.iter().filter(|cell| cell[SOLID] > 0.0) {
            assert_eq!(cell[..DARK], [0.0; DARK], "step {steps}");
            count += 1;
        }
        assert_eq!(count, 2 * 6 * 7, "as many cells as the wall has");
    }
}

#[test]
fn any_number_of_threads_and_any_way_to_a_step_gives_the_same_bits() {
    let s = smoke(burning, AIR);
    let on = |threads: usize, steps: u32| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| play(s, steps))
    };
    let alone = on(1, 90);
    for threads in [2, 3, 8] {
        assert!(same(&alone, &on(threads, 90)), "{threads} threads");
    }
    // Played, sought back and forth over the states that are kept, and after other smoke.
    let mut simulation = Simulation::default();
    let mut counters = Counters::default();
    for steps in [1, 2, 90, 300, 250, 90, 121, 120, 119, 241, 0, 90, 360, 300] {
        simulation.run(&Smoke { steps, ..s }, &mut counters);
        let mut fresh = Simulation::default();
        fresh.run(&Smoke { steps, ..s }, &mut counters);
        assert!(steps == 0 || same(&simulation, &fresh), "step {steps}");
    }
    // Back from the nearest state that is kept, not from the start; on from where it is if that is nearer.
    assert!(simulation.seek(299) && simulation.step == 240);
    simulation.step = 290;
    assert!(simulation.seek(299) && simulation.step == 290);
    simulation.run(&Smoke { steps: 7, ..smoke(puff, AIR) }, &mut counters);
    simulation.run(&Smoke { steps: 90, ..s }, &mut counters);
    assert!(same(&simulation, &alone), "after other smoke");
}
