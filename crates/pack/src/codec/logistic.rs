//! The logistic domain, where probabilities are mixed, and the mixer.
//!
//! `stretch(p) = ln(p / (1 - p))`, and [`squash`] is its inverse. Added there, opinions count by
//! their certainty. A mixer is one neuron: the weighted sum of the stretched opinions,
//! squashed; after each bit the weights move along `error * input`, which is the gradient of the
//! bit's coding cost.
//!
//! Source: Matt Mahoney, Adaptive Weighing of Context Models for Lossless Data Compression
//! (2005), and Data Compression Explained, section 4.3.2.

/// The largest stretched value, either way.
const LIMIT: f32 = 11.5;

/// The probability whose logarithmic odds are `x`: `1 / (1 + exp(-x))`.
///
/// `exp(-x)` is `(1 - x / 1024)` to the power 1024, by ten squarings: off by up to 6 % at the
/// ends, which doesn't matter, and the same on every machine, which does.
#[cfg(not(luc_part = "main"))]
#[inline(never)]
#[cfg_attr(luc_part = "opener", unsafe(no_mangle))]
pub extern "C" fn luc_squash(x: f32) -> f32 {
    let mut power = 1.0 - x.clamp(-LIMIT, LIMIT) * (1.0 / 1024.0);
    for _ in 0..10 {
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

    /// The logarithmic odds of `probability`, in 16 bits.
    pub fn of(&self, probability: u16) -> f32 {
        self.0[(usize::from(probability) * STEPS) >> 16]
    }
}

/// Four numbers side by side: on x86-64 one SSE register, which every such processor has. The
/// lanes are added in the same order everywhere, so all machines get equal bits.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub struct Four([f32; 4]);

impl Four {
    /// These numbers.
    pub fn of(numbers: [f32; 4]) -> Four {
        Four(numbers)
    }

    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(x: f32) -> Four {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Four` and `__m128` are both 16 bytes of four floats.
        unsafe {
            core::mem::transmute(core::arch::x86_64::_mm_set1_ps(x))
        }
        #[cfg(not(target_arch = "x86_64"))]
        Four([x; 4])
    }

    /// `self + a * b`, rounded twice.
    #[inline(always)]
    fn plus_product(self, a: Four, b: Four) -> Four {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Four` and `__m128` are both 16 bytes of four floats.
        unsafe {
            use core::arch::x86_64::{__m128, _mm_add_ps, _mm_mul_ps};
            let [sum, a, b] = core::mem::transmute::<[Four; 3], [__m128; 3]>([self, a, b]);
            core::mem::transmute(_mm_add_ps(sum, _mm_mul_ps(a, b)))
        }
        #[cfg(not(target_arch = "x86_64"))]
        Four(core::array::from_fn(|lane| self.0[lane] + a.0[lane] * b.0[lane]))
    }
}

/// The inner product.
pub fn dot<const N: usize>(a: &[Four; N], b: &[Four; N]) -> f32 {
    let mut sum = Four::all(0.0);
    for (a, b) in a.iter().zip(b) {
        sum = sum.plus_product(*a, *b);
    }
    let [a, b, c, d] = sum.0;
    (a + b) + (c + d)
}

/// `to + factor * along`, in place.
pub fn move_along<const N: usize>(to: &mut [Four; N], factor: f32, along: &[Four; N]) {
    let factor = Four::all(factor);
    for (to, along) in to.iter_mut().zip(along) {
        *to = to.plus_product(factor, *along);
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
            let back = squash(stretch.of(probability as u16)) * 65536.0;
            assert!((back - probability as f32).abs() < 100.0, "{probability} became {back}");
        }
        assert!(squash(0.0) == 0.5 && squash(-99.0) > 0.0 && squash(99.0) < 1.0);
    }

    #[test]
    fn the_product_is_that_of_plain_numbers() {
        let mut a = [Four::all(0.5); 2];
        let b = [Four::of([1.0, 2.0, 3.0, 4.0]), Four::of([5.0, 6.0, 7.0, 8.0])];
        assert_eq!(dot(&a, &b), 18.0);
        move_along(&mut a, 2.0, &b);
        assert_eq!(a[1].0, [10.5, 12.5, 14.5, 16.5]);
    }
}
