//! Smoke that moves: the state of the air after so many steps, and what light makes of it.
//!
//! The state is a pure function of the [`Rules`] and the number of steps: always the same steps from
//! still air on, each a fixed order of plain operations. [`Simulation`] only remembers the latest, so that
//! the next frame costs a step; earlier ones are found from the start.

mod grid;
mod light;
mod state;

#[cfg(test)]
mod tests;

pub use grid::{Eight, Grid};
pub use light::Volume;
pub use state::{DARK, DENSITY, FASTEST, HEAT, SOLID, State};

use crate::counters::Counters;
use crate::scene::{Rules, Smoke};

/// Remembers how far smoke has come.
#[derive(Default)]
pub struct Simulation {
    of: Option<&'static Rules>,
    step: u32,
    state: State,
}

impl Simulation {
    /// Brings the state to that of `smoke`.
    #[inline(never)]
    pub fn run(&mut self, smoke: &Smoke, counters: &mut Counters) {
        if self.step > smoke.steps || !self.of.is_some_and(|of| std::ptr::eq(of, smoke.rules)) {
            *self = Simulation { of: Some(smoke.rules), step: 0, state: State::new(smoke.rules) };
        }
        while self.step < smoke.steps {
            self.step += 1;
            self.state.step(smoke.rules, self.step, counters);
        }
    }

    /// The air after the last step.
    pub fn state(&self) -> &State {
        &self.state
    }
}
