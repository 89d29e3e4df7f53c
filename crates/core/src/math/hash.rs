//! Random numbers as a pure function of their position: no state, so any pixel of any frame can be
//! computed alone, in any order, on any thread.
//!
//! The mixer is the 32-bit xorshift–multiply permutation `lowbias32` of C. Wellons' Hash Prospector, with
//! the key entering twice: before the first round and between the two multiplications. Entering once, at
//! the start, would make two streams the same numbers in an order permuted by an exclusive or.

use super::lanes::{F, U, splat, splat_u};

const GOLDEN: u32 = 0x9e37_79b9;
const MULTIPLY: [u32; 2] = [0x7feb_352d, 0x846c_a68b];

/// Mixes `a` under the key `b`: for each key a permutation of all u32.
#[inline(always)]
pub fn mix(a: u32, b: u32) -> u32 {
    let mut h = a ^ b;
    h ^= h >> 16;
    h = h.wrapping_mul(MULTIPLY[0]).wrapping_add(b);
    h ^= h >> 15;
    h = h.wrapping_mul(MULTIPLY[1]);
    h ^ (h >> 16)
}

/// Hashes two numbers; every bit of both reaches every bit of the result.
#[inline]
pub fn hash2(a: u32, b: u32) -> u32 {
    mix(a, mix(b, GOLDEN))
}

/// The random bits of a dimension (which decision: lens, light, …) of a pixel in a frame.
#[inline]
pub fn hash(pixel: u32, frame: u32, dimension: u32) -> u32 {
    mix(pixel, hash2(frame, dimension))
}

/// Uniform in [0, 1): the upper 24 bits, each value exact, 1 never reached.
#[inline(always)]
pub fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Eight [`mix`] at once, bit for bit.
#[inline(always)]
pub fn mix_x8(a: U, b: U) -> U {
    let mut h = a ^ b;
    h ^= h >> 16u32;
    h = h * splat_u(MULTIPLY[0]) + b;
    h ^= h >> 15u32;
    h *= splat_u(MULTIPLY[1]);
    h ^ (h >> 16u32)
}

/// Eight [`hash2`] at once, bit for bit.
#[inline]
pub fn hash2_x8(a: U, b: U) -> U {
    mix_x8(a, mix_x8(b, splat_u(GOLDEN)))
}

/// Eight pixels' [`hash`] at once, bit for bit; frame and dimension are hashed once for all.
#[inline]
pub fn hash_x8(pixel: U, frame: u32, dimension: u32) -> U {
    mix_x8(pixel, splat_u(hash2(frame, dimension)))
}

/// Eight [`unit()`] at once, bit for bit.
#[inline(always)]
pub fn unit_x8(bits: U) -> F {
    // 24 bits fit into the signed conversion, which is exact.
    F::from_i32x8((bits >> 8u32).cast_signed()) * splat(1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::check::Fingerprint;

    /// Each input bit of `f` must flip each output bit in half of the cases.
    fn avalanche(name: &str, f: impl Fn(u32, u32) -> u32) {
        const CASES: u32 = 20_000;
        for flip in 0..32 {
            let mut counts = [0u32; 32];
            for i in 0..CASES {
                // Small counters as in use, not random words, which would hide weaknesses.
                let changed = f(i, 1 << flip);
                (0..32).for_each(|bit| counts[bit] += changed >> bit & 1);
            }
            for (bit, count) in counts.into_iter().enumerate() {
                let p = f64::from(count) / f64::from(CASES);
                assert!((p - 0.5).abs() < 0.02, "{name}: input bit {flip} flips output bit {bit} with {p}");
            }
        }
    }

    #[test]
    fn every_input_bit_flips_every_output_bit_half_of_the_time() {
        avalanche("a", |i, flip| hash2(i, 7) ^ hash2(i ^ flip, 7));
        avalanche("b", |i, flip| hash2(7, i) ^ hash2(7, i ^ flip));
        avalanche("pixel", |i, flip| hash(i, 3, 2) ^ hash(i ^ flip, 3, 2));
        avalanche("frame", |i, flip| hash(5, i, 2) ^ hash(5, i ^ flip, 2));
        avalanche("dimension", |i, flip| hash(5, 3, i) ^ hash(5, 3, i ^ flip));
    }

    /// Mean of x, mean of (x − ½)², mean product of x − ½ at distance `(dp, df, dd)`, over a 256² image.
    fn moments(dp: u32, df: u32, dd: u32) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for pixel in 0..65_536 {
            let x = f64::from(unit(hash(pixel, 11, 4))) - 0.5;
            let y = f64::from(unit(hash(pixel + dp, 11 + df, 4 + dd))) - 0.5;
            sums[0] += x + 0.5;
            sums[1] += x * x;
            sums[2] += x * y;
        }
        sums.map(|sum| sum / 65_536.0)
    }

    #[test]
    fn numbers_are_uniform_and_neighbours_uncorrelated() {
        // Four standard deviations of each mean.
        for (dp, df, dd) in [(1, 0, 0), (2, 0, 0), (256, 0, 0), (257, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 2)]
        {
            let [mean, variance, product] = moments(dp, df, dd);
            assert!((mean - 0.5).abs() < 4.0 * 0.2887 / 256.0, "mean {mean}");
            assert!((variance - 1.0 / 12.0).abs() < 4.0 * 0.0745 / 256.0, "variance {variance}");
            assert!(product.abs() < 4.0 / 12.0 / 256.0, "correlation at {dp} {df} {dd}: {product}");
        }
    }

    #[test]
    fn cells_of_a_dimension_pair_are_filled_evenly() {
        let mut cells = [0u32; 256];
        for pixel in 0..65_536 {
            let (u, v) = (unit(hash(pixel, 0, 0)), unit(hash(pixel, 0, 1)));
            cells[(u * 16.0) as usize * 16 + (v * 16.0) as usize] += 1;
        }
        let deviation = |n: u32| f64::from(n) - 256.0;
        let chi2: f64 = cells.iter().map(|&n| deviation(n) * deviation(n) / 256.0).sum();
        // 255 degrees of freedom: mean 255, standard deviation 22.6.
        assert!((165.0..345.0).contains(&chi2), "chi² {chi2}");
    }

    #[test]
    fn streams_are_not_permutations_of_each_other() {
        // The first numbers of frame 0 must not appear in frame 1.
        let set: std::collections::BTreeSet<u32> = (0..65_536).map(|p| hash(p, 0, 0)).collect();
        assert_eq!(set.len(), 65_536);
        let common = (0..65_536).filter(|&p| set.contains(&hash(p, 1, 0))).count();
        assert!(common < 8, "{common} numbers in common, 1 expected");
    }

    #[test]
    fn unit_stays_below_one() {
        assert_eq!((unit(0), unit(255), unit(256)), (0.0, 0.0, f32::EPSILON / 2.0));
        assert_eq!(unit(u32::MAX), 1.0f32.next_down());
    }

    #[test]
    fn lanes_equal_scalars() {
        for i in 0..10_000u32 {
            let a: [u32; 8] = core::array::from_fn(|lane| hash2(i, lane as u32) >> (i % 32));
            let b: [u32; 8] = core::array::from_fn(|lane| hash2(lane as u32, i) >> (i % 29));
            let (ax, bx) = (U::new(a), U::new(b));
            assert_eq!(hash2_x8(ax, bx).to_array(), core::array::from_fn(|l| hash2(a[l], b[l])));
            assert_eq!(hash_x8(ax, i, 3).to_array(), core::array::from_fn(|l| hash(a[l], i, 3)));
            assert_eq!(unit_x8(ax).to_array(), core::array::from_fn(|l| unit(a[l])));
        }
    }

    #[test]
    fn bits_are_the_same_in_every_build() {
        let mut sum = Fingerprint::new();
        (0..100_000).for_each(|i| sum.add_bits(hash(i, i / 7, i / 1000)));
        assert_eq!(sum.value(), 0x406b965b368bd087, "{:#x}", sum.value());
    }
}
