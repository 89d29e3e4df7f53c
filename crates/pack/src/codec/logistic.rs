//! The logistic domain, where probabilities are mixed.
//!
//! `stretch(p) = ln(p / (1 - p))`, and [`squash`] is its inverse. Added there, opinions count by
//! their certainty.
//!
//! Source: Matt Mahoney, Data Compression Explained, section 4.3.2.

use super::lanes::{Reals, Words};

/// The largest stretched value, either way.
const LIMIT: f32 = 11.5;

/// The probability whose logarithmic odds are `x`: `1 / (1 + exp(-x))`.
///
/// `exp(-x)` is `(1 - x / 256)` to the power 256, by eight squarings: off by up to a quarter at the
/// ends, which doesn't matter, and the same on every machine, which does.
#[cfg(not(luc_part = "main"))]
#[inline(never)]
#[cfg_attr(luc_part = "opener", unsafe(no_mangle))]
pub extern "C" fn luc_squash(x: f32) -> f32 {
    let mut power = 1.0 - x.clamp(-LIMIT, LIMIT) * (1.0 / 256.0);
    for _ in 0..8 {
        power *= power;
    }
    1.0 / (1.0 + power)
}
#[cfg(not(luc_part = "main"))]
pub use luc_squash as squash;

// The launcher's main part calls that of the opener.
#[cfg(luc_part = "main")]
unsafe extern "C" {
    #[link_name = "luc_squash"]
    pub safe fn squash(x: f32) -> f32;
}

/// Steps of the table that inverts [`squash`].
const STEPS: usize = 4096;

/// `stretch` for probabilities in 16 bits.
pub struct Stretch([f32; STEPS]);

impl Stretch {
    /// Fills the table by going along the curve of [`squash`].
    pub fn fill(&mut self) {
        let mut x = -LIMIT;
        for (step, value) in self.0.iter_mut().enumerate() {
            let middle = (step as f32 + 0.5) * (1.0 / STEPS as f32);
            while squash(x) < middle {
                x += 0.005;
            }
            *value = x;
        }
    }

    /// The logarithmic odds of probabilities of 16 bits.
    #[inline(always)]
    pub fn of_all(&self, probabilities: Words) -> Reals {
        // SAFETY: there are as many steps as 12 bits tell apart.
        unsafe { Reals::picked(&self.0, probabilities >> 4 & Words::all(STEPS as i32 - 1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_inverts_squash() {
        let mut stretch = Box::new(Stretch([0.0; STEPS]));
        stretch.fill();
        for probability in (64..65472u32).step_by(7) {
            let back = squash(stretch.of_all(Words::all(probability as i32)).0[0]) * 65536.0;
            assert!((back - probability as f32).abs() < 100.0, "{probability} became {back}");
        }
        assert!(squash(0.0) == 0.5 && squash(-99.0) > 0.0 && squash(99.0) < 1.0);
    }
}
