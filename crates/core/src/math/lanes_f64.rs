//! Eight lanes computed in f64 and rounded once: for formulas that f32 can't hold to a few ulp.
//!
//! Sums and products of f32 lose nothing visible in f64, so a result is within 0.51 ulp of the exact
//! value wherever the formula cancels less than 2²⁸-fold. [`F`] in and out, so that a lane still
//! depends on itself alone.

use super::lanes::{Bound, F, V3};

/// Four f64.
pub type D = wide::f64x4;

/// Four copies of `v`.
#[inline(always)]
pub fn splat_d(v: f64) -> D {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
    return D::from(safe_arch::set_splat_m256d(v).0);
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
    return D::splat(v);
}

impl Bound for D {
    #[inline(always)]
    fn at_most(self, most: D) -> D {
        if cfg!(target_arch = "x86_64") { self.fast_min(most) } else { self.simd_lt(most).select(self, most) }
    }

    #[inline(always)]
    fn at_least(self, least: D) -> D {
        if cfg!(target_arch = "x86_64") {
            self.fast_max(least)
        } else {
            self.simd_gt(least).select(self, least)
        }
    }
}

impl V3 {
    /// Scalar product of exact products, rounded to f64 and then to f32: right also for nearly upright vectors.
    #[inline(always)]
    pub fn dot_exact(self, b: V3) -> F {
        in_f64([self.x, self.y, self.z, b.x, b.y, b.z], |[x, y, z, bx, by, bz]| x * bx + y * by + z * bz)
    }
}

/// What `f` makes of the lanes in f64, four at a time, rounded once to f32.
#[inline(always)]
pub fn in_f64<const N: usize>(lanes: [F; N], f: impl Fn([D; N]) -> D) -> F {
    // Written out, as the compiler packs loops over lanes only at some optimisation levels.
    #[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
    {
        use safe_arch::*;
        let half = |v: m128| D::from(convert_to_m256d_from_m128(v).0);
        let narrow = |v: D| convert_to_m128_from_m256d(m256d(v.into()));
        let low = narrow(f(lanes.map(|v| half(cast_to_m128_from_m256(m256(v.into()))))));
        let high = narrow(f(lanes.map(|v| half(extract_m128_from_m256::<1>(m256(v.into()))))));
        F::from(set_m128_m256(high, low).0)
    }
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
    {
        let half = |at: usize| {
            let v = lanes.map(|v| D::new(core::array::from_fn(|i| f64::from(v.as_array()[at + i]))));
            f(v).to_array()
        };
        let (low, high) = (half(0), half(4));
        F::new(core::array::from_fn(|i| if i < 4 { low[i] as f32 } else { high[i & 3] as f32 }))
    }
}
