//! Light that a medium takes from a ray: Bouguer's, Lambert's and Beer's law, exp(-τ) over the optical depth τ.
//!
//! Depths of steps are added with the rounding of each sum kept (Knuth, TAOCP 2, 4.2.2), so a thousand
//! steps are as exact as one, and thin media don't vanish; 1 - exp(-τ) never cancels.

use crate::math::lanes::{Bound, F, INFINITY, splat};
use crate::math::lanes_fn::{exp, exp_m1};

/// Optical depth along rays: extinction per unit of length, times length, summed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Depth {
    /// The sum.
    sum: F,
    /// What rounding has left out of it.
    rest: F,
}

impl Depth {
    /// Adds the depth of a step, at least 0: within 2 u² per step of the exact sum.
    #[inline(always)]
    pub fn add(&mut self, step: F) {
        let sum = self.sum + step;
        let before = sum - step;
        self.rest += (self.sum - before) + (step - (sum - before));
        self.sum = sum;
    }

    /// τ, rounded.
    #[inline(always)]
    pub fn depth(&self) -> F {
        // Beyond infinity there is no rest.
        self.sum.simd_lt(INFINITY).select(self.sum + self.rest, self.sum)
    }

    /// Share of the light that comes through, exp(-τ). Error at most 3 ulp; 0 from τ = 87.3 on.
    #[inline(always)]
    pub fn through(&self) -> F {
        let depth = self.depth();
        // What is left after one more rounding is at most half an ulp of τ, so its exponential is linear.
        let rest = self.rest - (depth - self.sum);
        exp(-depth) * (F::ONE - rest.at_least(splat(-0.5)).at_most(splat(0.5)))
    }

    /// Share that is lost on the way, 1 - exp(-τ). Error at most 3 ulp.
    #[inline(always)]
    pub fn lost(&self) -> F {
        -exp_m1(-self.depth())
    }
}

/// Share of the light that comes through a depth of `tau`: exp(-τ). Error at most 1.4 ulp.
#[inline(always)]
pub fn through(tau: F) -> F {
    exp(-tau)
}

/// Length that light would have to run through a clear medium to be scattered as much as over
/// `length` in one of this extinction (per unit of length): (1 - exp(-σ t)) / σ, which is t for σ = 0.
/// Error at most 4 ulp.
#[inline(always)]
pub fn reach(extinction: F, length: F) -> F {
    let tau = extinction * length;
    let some = tau.simd_gt(F::ZERO);
    some.select(-exp_m1(-tau) / extinction, length)
}

#[cfg(test)]
mod tests;
