//! The mixers, which make one probability of all opinions.
//!
//! A mixer is one neuron: the weighted sum of the opinions, which are logarithmic odds, squashed; after each bit its
//! weights move along `error * input`, which is the gradient of the bit's coding cost. It has many sets of weights, one
//! of which a selector chooses. A last mixer adds the others up, each by how far it is to be trusted here.
//!
//! Source: Matt Mahoney, Adaptive Weighing of Context Models for Lossless Data Compression
//! (2005), and Data Compression Explained, section 4.3.2.

use super::lanes::Eight;
use super::logistic::squash;

/// Mixers.
pub const MIXERS: usize = 6;
/// Sets of weights of each mixer, a power of two.
const SETS: usize = 2048;
/// States that the last mixer tells apart, a power of two.
const STATES: usize = 64;

/// Weight of each opinion at the start.
const FIRST_WEIGHT: f32 = 0.03;
/// Learning rate of the mixer of mixers.
const TRUST_RATE: f32 = 0.0008;

/// All mixers of so many times eight opinions; zeros, before [`Mixers::start`].
#[repr(C)]
pub struct Mixers<const INPUTS: usize> {
    /// How far the mixers' own weights are from equal ones, by the state, and by it and the bits of the byte so far.
    trust: [[f32; MIXERS]; STATES],
    trust_so_far: [[f32; MIXERS]; STATES << 8],
    weights: [[[Eight; INPUTS]; SETS]; MIXERS],
}

/// Where in the program the mixers are asked.
pub struct Place {
    /// Each mixer's set of weights.
    pub sets: [u32; MIXERS],
    /// For the last mixer.
    pub state: usize,
    /// The bits of the byte so far, behind a leading one.
    pub byte: usize,
}

impl Place {
    #[inline(always)]
    fn so_far(&self) -> usize {
        (self.state & (STATES - 1)) << 8 | self.byte & 255
    }
}

/// What mixers said.
pub struct Mixed {
    /// The logarithmic odds of each.
    mixed: [f32; MIXERS],
    /// The probability of all.
    pub said: f32,
}

impl<const INPUTS: usize> Mixers<INPUTS> {
    /// Gives all opinions the same weight.
    pub fn start(&mut self) {
        for weights in self.weights.as_flattened_mut().as_flattened_mut() {
            *weights = Eight::all(FIRST_WEIGHT);
        }
    }

    /// What all make of these opinions, at this place.
    #[inline(always)]
    pub fn mix(&self, at: &Place, opinions: &[Eight; INPUTS]) -> Mixed {
        let mut mixed = [0.0; MIXERS];
        let mut mean = 0.0;
        for (i, mixed) in mixed.iter_mut().enumerate() {
            let mut sum = Eight::all(0.0);
            for (weight, opinion) in self.weights[i][at.sets[i] as usize & (SETS - 1)].iter().zip(opinions) {
                sum = sum.plus_product(*weight, *opinion);
            }
            *mixed = sum.sum();
            let trust = self.trust[at.state & (STATES - 1)][i] + self.trust_so_far[at.so_far()][i];
            mean += *mixed * (trust + 1.0 / MIXERS as f32);
        }
        Mixed { mixed, said: squash(mean) }
    }

    /// Moves the weights that were used toward what the bit calls for, at this rate.
    #[inline(always)]
    pub fn learn(&mut self, at: &Place, bit: f32, then: &Mixed, rate: f32, opinions: &[Eight; INPUTS]) {
        let error = (bit - then.said) * TRUST_RATE;
        for i in 0..MIXERS {
            self.trust[at.state & (STATES - 1)][i] += error * then.mixed[i];
            self.trust_so_far[at.so_far()][i] += error * then.mixed[i];
            let error = bit - squash(then.mixed[i]);
            // A mixer that is nearly right has little to learn, and time is short.
            if error.abs() > 0.02 {
                let step = Eight::all(error * rate);
                for (weight, opinion) in
                    self.weights[i][at.sets[i] as usize & (SETS - 1)].iter_mut().zip(opinions)
                {
                    *weight = weight.plus_product(step, *opinion);
                }
            }
        }
    }
}
