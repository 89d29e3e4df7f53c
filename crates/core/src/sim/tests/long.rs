//! A million steps, nine hours of smoke: what drifts shows in a small grid as it does in a large one.

use super::*;

const SMALL: [usize; 3] = [4, 5, 3];
const STEPS: u32 = 1_000_000;

/// A wall, and a source that burns for half of each 1,000 steps, in the last quarter no more.
fn on_and_off(step: u32, figure: &mut Voxels) {
    figure.reset(Vec3::ZERO, 0.1, SMALL);
    figure.edit(Edit::Add(1), [0, 0, 0], [1, 2, 3]);
    if step % 1000 < 500 && step < STEPS / 4 * 3 {
        figure.edit(Edit::Overwrite(Voxels::SMOKE), [2, 0, 1], [4, 1, 3]);
    }
}

/// Never out of bounds, never a subnormal number; air that clears when nothing burns, and no quarter unlike another.
#[test]
fn a_million_steps_stay_finite_and_bounded_and_drift_nowhere() {
    let air = Air { fade: 0.5, swirl: 0.3, sweeps: 3, ..AIR };
    let lamps = [Vec3::new(0.8, 1.0, -6.0), Vec3::new(-3.0, 4.0, 2.0)];
    let rules = Rules { cell: 0.1, size: SMALL, air: air.motion(0.1), lamps, ..Rules::new(on_and_off) };
    let mut state = State::new(&rules);
    let mut counters = Counters::default();
    let total = |state: &State, lane: usize| state.cells.iter().map(|c| f64::from(c[lane])).sum::<f64>();
    let (mut burning, mut clearest) = ([0.0; 3], 0.0_f64);
    // On this thread alone: so small a grid isn't worth handing on.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        for step in 1..=STEPS {
            state.step(&rules, step, &mut counters);
            if step % 250 != 249 {
                continue;
            }
            for (lane, v) in state.cells.iter().flat_map(|c| c.iter().copied().enumerate()) {
                assert!(v.is_finite() && !v.is_subnormal(), "{v} in lane {lane} at step {step}");
                let speed = FASTEST + 60.0;
                let most = [speed, speed, speed, 0.9, 1.2, 1.0, 1.0, 1.0][lane];
                assert!(v.abs() <= most, "{v} in lane {lane} at step {step}");
            }
            assert!(
                state.pressure.iter().flatten().all(|p| p.is_finite() && !p.is_subnormal()),
                "step {step}"
            );
            let smoke = total(&state, DENSITY);
            match step % 1000 {
                499 if step < STEPS / 4 * 3 => burning[(step / (STEPS / 4)) as usize] += smoke,
                999 => clearest = clearest.max(smoke),
                _ => {}
            }
        }
    });
    // Each quarter burns as the first did, each fire goes out, and at last nothing is left, not even next to nothing.
    let mean = burning[0] / 250.0;
    assert!(mean > 1.0 && burning.iter().all(|sum| (sum / burning[0] - 1.0).abs() < 0.2), "{burning:?}");
    assert!(clearest < 0.05 * mean, "{clearest} of {mean} is left");
    assert_eq!(total(&state, DENSITY), 0.0);
}
