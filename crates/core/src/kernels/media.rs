//! Light in a medium: what is taken from a ray, and where it goes.

use super::first;
use crate::math::lanes::splat;
use crate::shade::{extinction, phase};

/// Henyey and Greenstein's phase function per steradian, for the cosine between the ways before and after and
/// its mean `g`, |g| <= 0.9999. Error at most 1 ulp.
pub fn henyey_greenstein(cos: f32, g: f32) -> f32 {
    first(phase::phase(g, splat(cos)))
}

/// Draws a turn by `u` in 0..=1: cosine, 1 - cosine and sine, each within 1 ulp, the cosine or within 2⁻⁵⁰.
pub fn sample_henyey_greenstein(u: f32, g: f32) -> [f32; 3] {
    let turn = phase::turn(g, splat(u));
    [turn.cos, turn.one_minus_cos, turn.sin].map(first)
}

/// Extinction along a ray, step by step: see [`extinction::Depth`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Extinction(extinction::Depth);

impl Extinction {
    /// Adds a step of optical depth (extinction times length), at least 0.
    pub fn add(&mut self, depth: f32) {
        self.0.add(splat(depth));
    }

    /// Optical depth τ so far. Error at most 1 ulp of the sum, for up to a million steps.
    pub fn depth(&self) -> f32 {
        first(self.0.depth())
    }

    /// Share of the light that comes through, exp(-τ). Error at most 3 ulp; 0 from τ = 87.3 on.
    pub fn through(&self) -> f32 {
        first(self.0.through())
    }

    /// Share that is lost, 1 - exp(-τ). Error at most 3 ulp.
    pub fn lost(&self) -> f32 {
        first(self.0.lost())
    }
}

/// (1 - exp(-σ t)) / σ for a medium of one extinction σ over the length t: see [`extinction::reach`]. Error at
/// most 4 ulp.
pub fn homogeneous(extinction: f32, length: f32) -> f32 {
    first(extinction::reach(splat(extinction), splat(length)))
}
