//! Smoke that moves: the state of the air after so many steps, and what light makes of it.
//!
//! The state is a pure function of the [`Smoke`] and its number of steps: always the same steps from
//! still air on, each a fixed order of plain operations. [`Simulation`] only remembers states, so that
//! the next frame costs a step and seeking back not all of them.

mod grid;
mod light;
mod state;

#[cfg(test)]
mod tests;

pub use grid::Grid;
pub use light::Volume;
pub use state::{Cell, DENSITY, FASTEST, Kind, Room, State, TEMPERATURE};

use crate::counters::Counters;
use crate::scene::Smoke;

/// Steps between states that are kept.
const KEEP_EVERY: u32 = 120;

/// Remembers how far smoke has come.
#[derive(Default)]
pub struct Simulation {
    of: Option<Smoke>,
    step: u32,
    state: State,
    room: Room,
    kept: Vec<State>,
}

impl Simulation {
    /// Brings the state to that of `smoke`, by as few steps as it can.
    #[inline(never)]
    pub fn run(&mut self, smoke: &Smoke, counters: &mut Counters) {
        let grid = Grid { size: smoke.size };
        if !self.of.is_some_and(|of| of.moves_like(smoke)) {
            *self = Simulation { of: Some(*smoke), kept: vec![State::new(grid)], ..Simulation::default() };
            (self.step, self.state) = (0, State::new(grid));
            self.room = Room::new(grid);
        }
        // The step before is shown too: at least one is taken from what was kept.
        let latest = (smoke.steps.saturating_sub(1) / KEEP_EVERY).min(self.kept.len() as u32 - 1);
        if self.step > smoke.steps || self.step < latest * KEEP_EVERY {
            self.step = latest * KEEP_EVERY;
            self.state.clone_from(&self.kept[latest as usize]);
        }
        while self.step < smoke.steps {
            self.step += 1;
            self.state.step(grid, smoke, (smoke.figure)(self.step), &mut self.room, counters);
            if self.step == self.kept.len() as u32 * KEEP_EVERY {
                self.kept.push(self.state.clone());
            }
        }
    }

    /// The air after the last step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The cells a step before.
    pub fn before(&self) -> &[Cell] {
        &self.room.before
    }

    /// What the cells are.
    pub fn kinds(&self) -> &[Kind] {
        &self.room.kinds
    }
}
