//! Smoke that moves: the state of the air after so many steps, and what light makes of it.
//!
//! The state is a pure function of the [`Rules`] and the number of steps: always the same steps from
//! still air on, each a fixed order of plain operations. [`Simulation`] only remembers the latest, so that
//! the next frame costs a step. Tools, which go back and forth, also have every 120th; the intro, which
//! doesn't, begins anew.

mod grid;
mod light;
mod state;

#[cfg(test)]
mod tests;

pub use grid::{Eight, Grid};
pub use light::{Room, Volume};
pub use state::{DARK, DENSITY, FASTEST, HEAT, SOLID, State};

use crate::counters::Counters;
use crate::scene::{Rules, Smoke};

/// Remembers how far smoke has come.
#[derive(Default)]
pub struct Simulation {
    of: Option<&'static Rules>,
    step: u32,
    state: State,
    /// The states after each [`APART`] steps.
    #[cfg(any(test, feature = "study"))]
    kept: Vec<State>,
}

/// Steps between two states that are kept.
#[cfg(any(test, feature = "study"))]
const APART: u32 = 120;

impl Simulation {
    /// Brings the state to that of `smoke`.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn run(&mut self, smoke: &Smoke, counters: &mut Counters) {
        let is_other = !self.of.is_some_and(|of| std::ptr::eq(of, smoke.rules));
        #[cfg(any(test, feature = "study"))]
        if !is_other && self.seek(smoke.steps) {
            return self.go_on(smoke, counters);
        }
        #[cfg(any(test, feature = "study"))]
        if is_other {
            self.kept.clear();
        }
        if is_other || self.step > smoke.steps {
            (self.of, self.step, self.state) = (Some(smoke.rules), 0, State::new(smoke.rules));
        }
        self.go_on(smoke, counters);
    }

    /// Takes the steps that are missing.
    fn go_on(&mut self, smoke: &Smoke, counters: &mut Counters) {
        while self.step < smoke.steps {
            self.step += 1;
            self.state.step(smoke.rules, self.step, counters);
            #[cfg(any(test, feature = "study"))]
            if self.step == APART * (self.kept.len() as u32 + 1) {
                self.kept.push(self.state.clone());
            }
        }
    }

    /// Goes to the last state kept before `step`, if that is nearer; whether there is one.
    #[cfg(any(test, feature = "study"))]
    fn seek(&mut self, step: u32) -> bool {
        let Some(last) = (step / APART).min(self.kept.len() as u32).checked_sub(1) else { return false };
        let at = (last + 1) * APART;
        if !(at..=step).contains(&self.step) {
            (self.state, self.step) = (self.kept[last as usize].clone(), at);
        }
        true
    }

    /// The air after the last step.
    pub fn state(&self) -> &State {
        &self.state
    }
}
