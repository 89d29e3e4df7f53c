//! Numbers side by side, so that the model asks several contexts at once.
//!
//! With AVX2 [`Words`] and [`Reals`] are eight numbers in a register, elsewhere each is one number:
//! what a processor without gathers does fastest, and in the least code. [`Eight`] is eight numbers everywhere.
//! All results have equal bits: every operation rounds by itself, and sums are made in one order.

#![allow(
    clippy::missing_transmute_annotations,
    clippy::useless_transmute,
    reason = "one rule makes registers of numbers for all instructions, and some take a number as it is"
)]

#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::mem::transmute;
use core::ops::{Add, BitAnd, BitOr, BitXor, Mul, Shl, Shr, Sub};

/// Numbers in [`Words`] and [`Reals`].
pub const LANES: usize = if cfg!(target_feature = "avx2") { 8 } else { 1 };

/// Words, one for each context.
#[derive(Clone, Copy)]
#[cfg_attr(target_feature = "avx2", repr(C, align(32)))]
#[cfg_attr(not(target_feature = "avx2"), repr(C))]
pub struct Words(pub [i32; LANES]);

/// Real numbers, one for each context.
#[derive(Clone, Copy)]
#[cfg_attr(target_feature = "avx2", repr(C, align(32)))]
#[cfg_attr(not(target_feature = "avx2"), repr(C))]
pub struct Reals(pub [f32; LANES]);

/// What the instruction makes of registers and numbers, or else the function of the lane.
macro_rules! lanes {
    ($instruction:ident($($operand:expr),*), $lane:ident: $each:expr) => {{
        #[cfg(target_feature = "avx2")]
        // SAFETY: the instruction exists, and the types are 32 bytes like its registers.
        unsafe { transmute($instruction($(transmute($operand)),*)) }
        #[cfg(not(target_feature = "avx2"))]
        // SAFETY: as many numbers.
        unsafe { transmute(core::array::from_fn::<_, LANES, _>(|$lane| $each)) }
    }};
}

macro_rules! operators {
    ($($operator:ident::$name:ident for $type:ident is $instruction:ident, $a:ident, $b:ident: $each:expr;)*) => {$(
        impl $operator for $type {
            type Output = $type;
            #[inline(always)]
            fn $name(self, other: $type) -> $type {
                lanes!($instruction(self, other), lane: {
                    let ($a, $b) = (self.0[lane], other.0[lane]);
                    $each
                })
            }
        }
    )*};
}

operators! {
    Add::add for Words is _mm256_add_epi32, a, b: a.wrapping_add(b);
    Sub::sub for Words is _mm256_sub_epi32, a, b: a.wrapping_sub(b);
    Mul::mul for Words is _mm256_mullo_epi32, a, b: a.wrapping_mul(b);
    BitAnd::bitand for Words is _mm256_and_si256, a, b: a & b;
    BitOr::bitor for Words is _mm256_or_si256, a, b: a | b;
    BitXor::bitxor for Words is _mm256_xor_si256, a, b: a ^ b;
}

impl Shl<u32> for Words {
    type Output = Words;
    #[inline(always)]
    fn shl(self, by: u32) -> Words {
        lanes!(_mm256_sll_epi32(self, counted(by)), lane: self.0[lane] << by)
    }
}

/// Shifts in zeros.
impl Shr<u32> for Words {
    type Output = Words;
    #[inline(always)]
    fn shr(self, by: u32) -> Words {
        lanes!(_mm256_srl_epi32(self, counted(by)), lane: (self.0[lane] as u32 >> by) as i32)
    }
}

/// As the instructions take it.
#[cfg(target_feature = "avx2")]
#[inline(always)]
fn counted(by: u32) -> __m128i {
    // SAFETY: all x86-64 processors have the instruction.
    unsafe { _mm_cvtsi32_si128(by as i32) }
}

impl Words {
    /// 0, 1, 2 and so on.
    pub const ORDER: Words = {
        let mut order = [0; LANES];
        let mut lane = 0;
        while lane < LANES {
            order[lane] = lane as i32;
            lane += 1;
        }
        Words(order)
    };

    /// The same in all lanes.
    #[inline(always)]
    pub fn all(word: i32) -> Words {
        lanes!(_mm256_set1_epi32(word), _lane: word)
    }

    /// `self / 2^by`, rounded down.
    #[inline(always)]
    pub fn halved(self, by: u32) -> Words {
        lanes!(_mm256_sra_epi32(self, counted(by)), lane: self.0[lane] >> by)
    }

    /// The lesser of both.
    #[inline(always)]
    pub fn min(self, other: Words) -> Words {
        lanes!(_mm256_min_epi32(self, other), lane: self.0[lane].min(other.0[lane]))
    }

    /// All ones where both are equal, else 0.
    #[inline(always)]
    pub fn equals(self, other: Words) -> Words {
        lanes!(_mm256_cmpeq_epi32(self, other), lane: -i32::from(self.0[lane] == other.0[lane]))
    }

    /// What isn't in `mask`.
    #[inline(always)]
    pub fn without(self, mask: Words) -> Words {
        lanes!(_mm256_andnot_si256(mask, self), lane: !mask.0[lane] & self.0[lane])
    }

    /// `then` where this is all ones, `other` where it is 0.
    #[inline(always)]
    pub fn choose(self, then: Words, other: Words) -> Words {
        lanes!(_mm256_blendv_epi8(other, then, self), lane: if self.0[lane] != 0 { then.0[lane] } else { other.0[lane] })
    }

    /// The same bits as real numbers.
    #[inline(always)]
    pub fn as_reals(self) -> Reals {
        // SAFETY: all bits are reals.
        unsafe { transmute(self) }
    }

    /// Two halves of a word each from `table`, the low one at these places.
    ///
    /// # Safety
    /// Both halves must be in the table.
    #[inline(always)]
    pub unsafe fn pairs(table: &[u16], places: Words) -> Words {
        let table = table.as_ptr();
        #[cfg(target_feature = "avx2")]
        // SAFETY: the caller's; the instruction reads at any address.
        unsafe {
            transmute(_mm256_i32gather_epi32::<2>(table.cast(), transmute(places)))
        }
        #[cfg(not(target_feature = "avx2"))]
        // SAFETY: the caller's.
        Words(places.0.map(|place| unsafe {
            let low = table.add(place as usize);
            i32::from(*low) | i32::from(*low.add(1)) << 16
        }))
    }
}

impl Reals {
    /// The same bits as words.
    #[inline(always)]
    pub fn as_words(self) -> Words {
        // SAFETY: all bits are words.
        unsafe { transmute(self) }
    }

    /// From `table`, at these places.
    ///
    /// # Safety
    /// All must be in the table.
    #[inline(always)]
    pub unsafe fn picked(table: &[f32], places: Words) -> Reals {
        let table = table.as_ptr();
        #[cfg(target_feature = "avx2")]
        // SAFETY: the caller's.
        unsafe {
            transmute(_mm256_i32gather_ps::<4>(table, transmute(places)))
        }
        #[cfg(not(target_feature = "avx2"))]
        // SAFETY: the caller's.
        Reals(places.0.map(|place| unsafe { *table.add(place as usize) }))
    }
}

/// Eight real numbers.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub struct Eight(pub [f32; 8]);

impl Eight {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(number: f32) -> Eight {
        #[cfg(target_feature = "avx2")]
        // SAFETY: the instruction exists, and the types are the same 32 bytes.
        return unsafe { transmute(_mm256_set1_ps(number)) };
        #[cfg(not(target_feature = "avx2"))]
        Eight([number; 8])
    }

    /// `self + a * b`, rounded twice.
    #[inline(always)]
    pub fn plus_product(self, a: Eight, b: Eight) -> Eight {
        #[cfg(target_feature = "avx2")]
        // SAFETY: all are 32 bytes of eight numbers.
        unsafe {
            let [sum, a, b] = transmute::<[Eight; 3], [__m256; 3]>([self, a, b]);
            transmute(_mm256_add_ps(sum, _mm256_mul_ps(a, b)))
        }
        #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
        // SAFETY: all are 32 bytes of eight numbers, and all x86-64 processors have the instructions.
        unsafe {
            let [[s, t], [a, b], [c, d]] = transmute::<[Eight; 3], [[__m128; 2]; 3]>([self, a, b]);
            transmute([_mm_add_ps(s, _mm_mul_ps(a, c)), _mm_add_ps(t, _mm_mul_ps(b, d))])
        }
        #[cfg(not(target_arch = "x86_64"))]
        Eight(core::array::from_fn(|lane| self.0[lane] + a.0[lane] * b.0[lane]))
    }

    /// The sum of all lanes.
    #[inline(always)]
    pub fn sum(self) -> f32 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_is_that_of_plain_numbers() {
        let sum =
            Eight::all(1.0).plus_product(Eight::all(2.0), Eight([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0]));
        assert_eq!(sum.0, [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        assert_eq!(sum.sum(), 44.0);
    }
}
