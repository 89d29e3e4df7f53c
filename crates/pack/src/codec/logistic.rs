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
#[inline(never)]
pub fn squash(x: f32) -> f32 {
    let mut power = 1.0 - x.clamp(-LIMIT, LIMIT) * (1.0 / 1024.0);
    for _ in 0..10 {
        power *= power;
    }
    1.0 / (1.0 + power)
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
            while x < LIMIT && squash(x) < middle {
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

#[cfg(target_arch = "x86_64")]
mod lanes {
    use super::Four;
    use core::arch::x86_64::*;

    impl Four {
        /// `self + a * b`, rounded twice.
        #[inline(always)]
        pub fn plus_product(self, a: Four, b: Four) -> Four {
            // SAFETY: `Four` and `__m128` are both 16 bytes of four floats.
            unsafe {
                let [sum, a, b] = core::mem::transmute::<[Four; 3], [__m128; 3]>([self, a, b]);
                core::mem::transmute(_mm_add_ps(sum, _mm_mul_ps(a, b)))
            }
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Four {
    /// `self + a * b`, rounded twice.
    pub fn plus_product(self, a: Four, b: Four) -> Four {
        Four(core::array::from_fn(|lane| self.0[lane] + a.0[lane] * b.0[lane]))
    }
}

impl Four {
    /// The same number in all lanes.
    pub fn all(x: f32) -> Four {
        Four([x; 4])
    }

    fn sum(self) -> f32 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }
}

/// Up to `4 * N` opinions, or their weights.
#[derive(Clone, Copy)]
pub struct Vector<const N: usize>(pub [Four; N]);

impl<const N: usize> Vector<N> {
    /// The inner product.
    pub fn dot(&self, other: &Vector<N>) -> f32 {
        let mut sum = Four::all(0.0);
        for (a, b) in self.0.iter().zip(&other.0) {
            sum = sum.plus_product(*a, *b);
        }
        sum.sum()
    }

    /// `self + factor * other`, in place.
    pub fn add_scaled(&mut self, factor: f32, other: &Vector<N>) {
        let factor = Four::all(factor);
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a = a.plus_product(factor, *b);
        }
    }

    /// The numbers one by one.
    pub fn numbers_mut(&mut self) -> &mut [[f32; 4]; N] {
        // SAFETY: `Four` is `repr(C)` around four floats and at least as aligned as they are.
        unsafe { &mut *(&raw mut self.0).cast() }
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
        let mut a = Vector::<2>([Four::all(0.5); 2]);
        let b = Vector::<2>([Four([1.0, 2.0, 3.0, 4.0]), Four([5.0, 6.0, 7.0, 8.0])]);
        assert_eq!(a.dot(&b), 18.0);
        a.add_scaled(2.0, &b);
        assert_eq!(a.numbers_mut()[1], [10.5, 12.5, 14.5, 16.5]);
    }
}
