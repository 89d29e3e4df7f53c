//! Deterministic mathematics: the same bits on every processor, build and thread.
//!
//! The standard library's transcendental functions differ between platforms, and even between a value
//! folded by the compiler and one computed at run time. Nothing here calls them. Everything is made of
//! IEEE operations that have one right answer (+ − × ÷ √, comparisons, integer work), without fused
//! multiply-add and without reciprocal estimates.
//!
//! * [`scalar`]: `sin`, `exp`, `pow`, … for one number, computed in f64 and rounded once.
//! * [`lanes`]: eight numbers side by side ([`lanes::F`]), and vectors of them ([`lanes::V3`]).
//! * [`lanes_f64`]: formulas for eight numbers in f64, rounded once.
//! * [`lanes_fn`]: the elementary functions for eight numbers, in f32.
//! * [`hash`]: random numbers as a pure function of pixel, frame and dimension.

use glam::swizzles::Vec3Swizzles;

/// Three numbers in a register of four: one instruction for three, and 1,880 bytes less in the packed file than
/// three numbers apart. (glam's, under the name that it has everywhere else.)
pub use glam::Vec3A as Vec3;

/// Three of them.
pub use glam::Mat3A as Mat3;

/// The vector product, of products that are rounded each; glam's are fused where the processor can.
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    (a.zxy() * b - b.zxy() * a).zxy()
}

/// v / |v|; glam's multiplies by 1 / |v| on some processors, which rounds once more.
#[inline(always)]
pub fn normalize(v: Vec3) -> Vec3 {
    v / v.length()
}

/// A count below 2^31 as a number: one instruction, where any unsigned word would take a branch.
#[inline(always)]
pub const fn number(count: usize) -> f32 {
    count as i32 as f32
}

/// The whole part of a number from 0 to less than 2^31: one instruction or two, where `as` would also see to what lies
/// outside. There the answer is some word, not the same one on all processors.
#[inline(always)]
pub fn whole(x: f32) -> usize {
    #[cfg(target_arch = "x86_64")]
    return {
        use safe_arch::{get_i32_from_m128i_s, set_m128_s, truncate_m128_to_m128i};
        get_i32_from_m128i_s(truncate_m128_to_m128i(set_m128_s(x))) as u32 as usize
    };
    #[cfg(not(target_arch = "x86_64"))]
    return x as i32 as u32 as usize;
}

pub mod fingerprint;
pub mod hash;
pub mod lanes;
pub mod lanes_f64;
pub mod lanes_fn;
pub mod noise;
pub mod quadratic;
#[cfg(any(test, feature = "study"))]
pub mod random;
pub mod sampling;
pub mod scalar;

#[cfg(test)]
pub(crate) mod check;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_parts_are_those_of_the_language_and_counts_come_back() {
        for i in 0..1 << 24 {
            let x = f32::from_bits(i << 7 | i & 127);
            if (0.0..2_147_483_648.0).contains(&x) {
                assert_eq!(whole(x), x as usize, "{x:e}");
            }
        }
        for n in (0..1 << 24).step_by(999) {
            assert_eq!(whole(number(n)), n);
        }
    }
}
