//! The stream: sections of a score as sound, from any sample on, in blocks of any size.
//!
//! The tune is a loop. A stream that is to begin at a sample begins [`LEAD`] before it, from silence, and
//! plays that unheard: so long that every note and every echo of it which is still to be heard is there
//! (what is missing lies 130 dB below full scale). On reaching the loop's end for the first time the
//! stream keeps its state, tails and all, and takes it back each later time: every round has the same
//! bits, and the seam no step that could be heard. A stream from sample 0 passes the end in its lead, so
//! its first round is already that of all others.

use super::effects::Effects;
use super::score::{Score, Section};
use super::voice::{self, BUSES, Packet};
use super::{BAR, STEPS, sample_of};
use crate::math::lanes::{F, LANES, ZERO};

/// Samples that are played unheard before the first: eight bars.
pub const LEAD: u32 = 8 * BAR;

/// Samples rendered at once.
const BLOCK: usize = 64;

/// Sections of a score, one after the other, round and round.
#[derive(Clone, Copy, Debug)]
pub struct Tune {
    /// The tables.
    pub score: &'static Score,
    /// What is played.
    pub sections: &'static [&'static Section],
}

impl Tune {
    /// Length of a round, samples.
    pub fn samples(&self) -> u32 {
        self.sections.iter().map(|section| section.harmony.len() as u32 * BAR).sum()
    }

    /// The section of a sixteenth of the round, and the sixteenth within it.
    fn find(&self, step: u32) -> Option<(&'static Section, u32)> {
        let mut local = step;
        for section in self.sections {
            let steps = section.harmony.len() as u32 * STEPS;
            if local < steps {
                return Some((section, local));
            }
            local -= steps;
        }
        None
    }
}

/// Everything that sounds at a moment.
#[derive(Clone, Debug, Default)]
struct State {
    packets: Vec<Packet>,
    effects: Effects,
    duck: Duck,
}

/// A tune being played.
#[derive(Clone, Debug)]
pub struct Stream {
    tune: Tune,
    state: State,
    /// What sounded when the loop's end was first reached after the lead.
    home: Option<Box<State>>,
    /// Whether the lead is over.
    heard: bool,
    /// The next sample of the round, and the next sixteenth to begin.
    now: u32,
    step: u32,
}

impl Stream {
    /// Begins at a sample of the round.
    pub fn new(tune: Tune, sample: u32) -> Stream {
        let samples = tune.samples();
        let mut stream = Stream { tune, state: State::default(), home: None, heard: false, now: 0, step: 0 };
        // Rounds may be shorter than the lead.
        let mut ahead = LEAD;
        stream.now = (sample + samples - LEAD % samples) % samples;
        while sample_of(stream.step) < stream.now {
            stream.step += 1;
        }
        while ahead > 0 {
            let count = ahead.min(BLOCK as u32);
            stream.render(&mut [[0.0; 2]; BLOCK][..count as usize]);
            ahead -= count;
        }
        stream.heard = true;
        stream
    }

    /// Writes the next samples, left and right.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn render(&mut self, mut out: &mut [[f32; 2]]) {
        while !out.is_empty() {
            if self.now == self.tune.samples() {
                match &self.home {
                    Some(home) => self.state = (**home).clone(),
                    None if self.heard => self.home = Some(Box::new(self.state.clone())),
                    None => {}
                }
                (self.now, self.step) = (0, 0);
            }
            if self.now == sample_of(self.step) {
                self.strike();
                self.step += 1;
            }
            let room = (sample_of(self.step) - self.now) as usize;
            let (block, rest) = out.split_at_mut(out.len().min(room).min(BLOCK));
            self.now += block.len() as u32;
            self.state.render(block);
            out = rest;
        }
    }

    /// Begins the notes of a sixteenth.
    fn strike(&mut self) {
        let Some((section, step)) = self.tune.find(self.step) else { return };
        let State { packets, duck, .. } = &mut self.state;
        self.tune.score.notes(section, step, |instrument, note| {
            if instrument == 0 {
                duck.press(note.level);
            }
            voice::start(packets, note, 0.01 * f32::from(section.gain));
        });
    }
}

impl State {
    /// The next samples, within one sixteenth and at most [`BLOCK`].
    fn render(&mut self, out: &mut [[f32; 2]]) {
        let mut duck = [0.0; BLOCK];
        let mut buses = [[ZERO; BUSES]; BLOCK];
        let (duck, buses) = (&mut duck[..out.len()], &mut buses[..out.len()]);
        duck.fill_with(|| self.duck.next());
        for packet in &mut self.packets {
            packet.render(duck, buses);
        }
        self.packets.retain(Packet::sounds);
        for (out, bus) in out.iter_mut().zip(buses) {
            let mut sums = [0.0; BUSES];
            for (sum, lanes) in sums.iter_mut().zip(bus) {
                *sum = add_up(*lanes);
            }
            *out = self.effects.sample(&sums);
        }
    }
}

/// All lanes together, in a fixed order.
fn add_up(v: F) -> f32 {
    let v: &[f32; LANES] = v.as_array();
    ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]))
}

/// How far a kick presses the other voices down: a function of the time since it, with no detector.
#[derive(Clone, Debug, Default)]
struct Duck {
    /// Samples since the last kick.
    age: u32,
    level: f32,
    /// What was left of the kick before.
    held: f32,
}

impl Duck {
    /// Samples of the way down, and of all of it: 0.28 s.
    const DOWN: u32 = 88;
    const ALL: u32 = 12_348;

    fn press(&mut self, level: f32) {
        self.held = self.value();
        self.level = (1.1 * level).min(1.0);
        self.age = 0;
    }

    fn value(&self) -> f32 {
        if self.age < Self::DOWN {
            return (self.level * self.age as f32 / Self::DOWN as f32).max(self.held);
        }
        let left = 1.0 - (self.age - Self::DOWN) as f32 / (Self::ALL - Self::DOWN) as f32;
        let left = left.max(0.0);
        self.level * left * left.sqrt()
    }

    fn next(&mut self) -> f32 {
        let value = self.value();
        self.age = (self.age + 1).min(Self::ALL);
        value
    }
}

#[cfg(test)]
mod tests;
