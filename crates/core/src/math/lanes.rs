//! Eight rays side by side: numbers [`F`], integers [`U`] and vectors [`V3`] of eight lanes.
//!
//! One AVX2 register holds a lane set; without AVX2 two SSE2 registers do, with the same bits. Only plain
//! IEEE operations are used: no fused multiply-add, no reciprocal or root estimates, no sums across
//! lanes. So a lane's result depends on that lane alone and equals the scalar computation.
//!
//! A *mask* is an [`F`] whose lanes are all ones (true) or all zeros (false), as comparisons return it;
//! combine masks with `&`, `|`, `^`, `!`.

use crate::math::Vec3;
use core::ops::{Add, AddAssign, BitAnd, Mul, Neg, Sub, SubAssign};

/// Eight f32.
pub type F = wide::f32x8;
/// Eight u32.
pub type U = wide::u32x8;

/// Lanes in a packet.
pub const LANES: usize = 8;
/// 0 in all lanes; as a mask, false.
pub const ZERO: F = F::splat(0.0);
/// 1 in all lanes.
pub const ONE: F = F::splat(1.0);
/// +∞ in all lanes.
pub const INFINITY: F = F::splat(f32::INFINITY);
/// The mask that is true in all lanes.
pub const TRUE: F = F::splat(f32::from_bits(u32::MAX));
/// The mask that is false in all lanes.
pub const FALSE: F = ZERO;
/// 0, 1, …, 7.
pub const LANE_INDEX: U = U::new([0, 1, 2, 3, 4, 5, 6, 7]);
/// The same as numbers.
pub const RAMP: F = F::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);

/// The first eight of `numbers`; zeros if there are fewer.
#[inline(always)]
pub fn load(numbers: &[f32]) -> F {
    F::new(numbers.first_chunk().copied().unwrap_or_default())
}

/// Eight copies of `v`.
///
/// In constants use [`F::splat`]: at run time, compiled for size, that writes eight numbers in a
/// loop.
#[inline(always)]
pub fn splat(v: f32) -> F {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
    return F::from(safe_arch::set_splat_m256(v).0);
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
    return F::splat(v);
}

/// Eight copies of `v`; see [`splat`].
#[inline(always)]
pub fn splat_u(v: u32) -> U {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
    return U::from(safe_arch::set_splat_i32_m256i(v as i32).0);
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
    return U::splat(v);
}

/// `a` where the mask is true, `b` elsewhere.
#[inline(always)]
pub fn select(mask: F, a: F, b: F) -> F {
    mask.select(a, b)
}

/// [`select`] for integers.
#[inline(always)]
pub fn select_u(mask: F, a: U, b: U) -> U {
    mask.select(a, b)
}

/// Whether a mask is true in some lane.
#[inline(always)]
pub fn any(mask: F) -> bool {
    mask.any()
}

/// Whether a mask is true in every lane.
#[inline(always)]
pub fn all(mask: F) -> bool {
    mask.all()
}

/// A mask as bits, lane 0 lowest.
#[inline(always)]
pub fn bitmask(mask: F) -> u8 {
    mask.to_bitmask() as u8
}

/// The mask whose lane i is bit i of `bits`.
#[inline(always)]
pub fn from_bits(bits: u8) -> F {
    let bit = U::new([1, 2, 4, 8, 16, 32, 64, 128]);
    F::from_bits((U::splat(bits.into()) & bit).simd_eq(bit))
}

/// Minima and maxima that are the same on all processors.
pub trait Bound {
    /// The smaller of each pair; `most` where either is NaN.
    fn at_most(self, most: Self) -> Self;
    /// The larger of each pair; `least` where either is NaN.
    fn at_least(self, least: Self) -> Self;
}

impl Bound for F {
    #[inline(always)]
    fn at_most(self, most: F) -> F {
        // The x86 instruction does just this; others treat NaN differently.
        if cfg!(target_arch = "x86_64") {
            self.fast_min(most)
        } else {
            select(self.simd_lt(most), self, most)
        }
    }

    #[inline(always)]
    fn at_least(self, least: F) -> F {
        if cfg!(target_arch = "x86_64") {
            self.fast_max(least)
        } else {
            select(self.simd_gt(least), self, least)
        }
    }
}

/// Lane `index[i]` of `v`, modulo 8, in each lane i.
#[inline(always)]
pub fn pick(v: F, index: U) -> F {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
    return F::from(safe_arch::shuffle_av_f32_all_m256(v.to_array().into(), index.to_array().into()).0);
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
    return F::new(index.to_array().map(|i| v.as_array()[i as usize % LANES]));
}

/// |magnitude| with the sign bit of `sign`, also of −0.
#[inline(always)]
pub fn copysign(magnitude: F, sign: F) -> F {
    let bit = splat(-0.0);
    (magnitude & !bit) | (sign & bit)
}

/// What `both` makes of all lanes, in all lanes; it takes the greater of a pair, or the lesser.
#[inline(always)]
fn reduce(v: F, both: impl Fn(F, F) -> F) -> F {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
    {
        use safe_arch::{m256, permute_m256, permute2z_m256};
        let both = |a: m256, b: m256| both(F::from(a.0), F::from(b.0));
        let v = m256(v.into());
        let v = m256(both(v, permute2z_m256::<1>(v, v)).into());
        let v = m256(both(v, permute_m256::<0b01_00_11_10>(v)).into());
        both(v, permute_m256::<0b10_11_00_01>(v))
    }
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
    v.to_array().into_iter().map(F::splat).reduce(both).unwrap_or(v)
}

/// The greatest lane, in all lanes; lanes must not be NaN.
#[inline(always)]
pub fn greatest(v: F) -> F {
    reduce(v, F::fast_max)
}

/// The least lane, in all lanes; lanes must not be NaN.
#[inline(always)]
pub fn least(v: F) -> F {
    reduce(v, F::fast_min)
}

/// Four numbers, twice.
#[inline(always)]
pub fn twice(v: &[f32; 4]) -> F {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
    return F::from(safe_arch::load_m128_splat_m256(&safe_arch::m128::from(*v)).0);
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
    return F::new([v[0], v[1], v[2], v[3], v[0], v[1], v[2], v[3]]);
}

/// a·b − c·d from the exact products, rounded to f64 and then to f32.
///
/// Products of f32 are exact in f64, so nothing cancels but what cancels in the exact values: the error
/// is at most 0.5001 ulp of the result.
#[inline(always)]
pub fn difference_of_products(a: F, b: F, c: F, d: F) -> F {
    // Written out, as the compiler packs the loop below only at some optimisation levels.
    #[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
    {
        use safe_arch::*;
        let (a, b, c, d) = (m256(a.into()), m256(b.into()), m256(c.into()), m256(d.into()));
        let low = difference_of_products_x4(
            cast_to_m128_from_m256(a),
            cast_to_m128_from_m256(b),
            cast_to_m128_from_m256(c),
            cast_to_m128_from_m256(d),
        );
        let high = difference_of_products_x4(
            extract_m128_from_m256::<1>(a),
            extract_m128_from_m256::<1>(b),
            extract_m128_from_m256::<1>(c),
            extract_m128_from_m256::<1>(d),
        );
        F::from(set_m128_m256(high, low).0)
    }
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
    {
        let wide = |v: F| v.to_array().map(f64::from);
        let (a, b, c, d) = (wide(a), wide(b), wide(c), wide(d));
        F::new(core::array::from_fn(|i| (a[i] * b[i] - c[i] * d[i]) as f32))
    }
}

#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
#[inline(always)]
fn difference_of_products_x4(
    a: safe_arch::m128,
    b: safe_arch::m128,
    c: safe_arch::m128,
    d: safe_arch::m128,
) -> safe_arch::m128 {
    use safe_arch::convert_to_m256d_from_m128 as wide;
    // Packed operators on f64: one rounding each.
    safe_arch::convert_to_m128_from_m256d(wide(a) * wide(b) - wide(c) * wide(d))
}

/// Eight vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct V3 {
    /// First coordinates.
    pub x: F,
    /// Second coordinates.
    pub y: F,
    /// Third coordinates.
    pub z: F,
}

impl V3 {
    /// The zero vector in all lanes.
    pub const ZERO: V3 = V3::new(ZERO, ZERO, ZERO);

    /// From coordinates.
    #[inline(always)]
    pub const fn new(x: F, y: F, z: F) -> V3 {
        V3 { x, y, z }
    }

    /// Eight copies of `v`.
    #[inline(always)]
    pub fn splat(v: impl Into<Vec3>) -> V3 {
        let v = v.into();
        V3::new(splat(v.x), splat(v.y), splat(v.z))
    }

    /// Eight vectors, lane by lane.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> Vec3) -> V3 {
        let v: [Vec3; LANES] = core::array::from_fn(f);
        V3::new(F::new(v.map(|v| v.x)), F::new(v.map(|v| v.y)), F::new(v.map(|v| v.z)))
    }

    /// The vector of lane `i`, modulo 8.
    #[inline(always)]
    pub fn lane(self, i: usize) -> Vec3 {
        let i = i % LANES;
        Vec3::new(self.x.as_array()[i], self.y.as_array()[i], self.z.as_array()[i])
    }

    /// Replaces the vector of lane `i`, modulo 8.
    #[inline(always)]
    pub fn set_lane(&mut self, i: usize, v: Vec3) {
        let i = i % LANES;
        self.x.as_mut_array()[i] = v.x;
        self.y.as_mut_array()[i] = v.y;
        self.z.as_mut_array()[i] = v.z;
    }

    /// `a` where the mask is true, `b` elsewhere.
    #[inline(always)]
    pub fn select(mask: F, a: V3, b: V3) -> V3 {
        V3::new(select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z))
    }

    /// Scalar product, summed as (x + y) + z, the order of glam.
    #[inline(always)]
    pub fn dot(self, b: V3) -> F {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Vector product with each coordinate rounded three times, as glam; see [`V3::cross_exact`].
    #[inline(always)]
    pub fn cross(self, b: V3) -> V3 {
        V3::new(self.y * b.z - b.y * self.z, self.z * b.x - b.z * self.x, self.x * b.y - b.x * self.y)
    }

    /// Vector product by [`difference_of_products`]: accurate also for nearly parallel vectors.
    #[inline(always)]
    pub fn cross_exact(self, b: V3) -> V3 {
        V3::new(
            difference_of_products(self.y, b.z, self.z, b.y),
            difference_of_products(self.z, b.x, self.x, b.z),
            difference_of_products(self.x, b.y, self.y, b.x),
        )
    }

    /// The greatest size of a coordinate; a NaN among them may show or not.
    #[inline(never)]
    pub fn max_abs(self) -> F {
        self.x.abs().at_least(self.y.abs()).at_least(self.z.abs())
    }

    /// |v|², without overflow for |v| < 1.8e19.
    #[inline(always)]
    pub fn length_squared(self) -> F {
        self.dot(self)
    }

    /// |v|, the root correctly rounded.
    #[inline(always)]
    pub fn length(self) -> F {
        self.length_squared().sqrt()
    }

    /// v·(1/|v|) as glam: length within 1.2·2⁻²⁴ of 1. Not for |v| below 1e-18 or above 1e19; the zero
    /// vector gives NaN.
    #[inline(always)]
    pub fn normalize(self) -> V3 {
        self * (ONE / self.length())
    }
}

impl Add for V3 {
    type Output = V3;
    #[inline(always)]
    fn add(self, b: V3) -> V3 {
        V3::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl AddAssign for V3 {
    #[inline(always)]
    fn add_assign(&mut self, b: V3) {
        *self = *self + b;
    }
}

impl Sub for V3 {
    type Output = V3;
    #[inline(always)]
    fn sub(self, b: V3) -> V3 {
        V3::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl SubAssign for V3 {
    #[inline(always)]
    fn sub_assign(&mut self, b: V3) {
        *self = *self - b;
    }
}

impl Mul<F> for V3 {
    type Output = V3;
    #[inline(always)]
    fn mul(self, s: F) -> V3 {
        V3::new(self.x * s, self.y * s, self.z * s)
    }
}

/// Coordinate by coordinate, as colours need it.
impl Mul for V3 {
    type Output = V3;
    #[inline(always)]
    fn mul(self, b: V3) -> V3 {
        V3::new(self.x * b.x, self.y * b.y, self.z * b.z)
    }
}

impl Neg for V3 {
    type Output = V3;
    #[inline(always)]
    fn neg(self) -> V3 {
        V3::new(-self.x, -self.y, -self.z)
    }
}

/// v where the mask is true, the zero vector elsewhere.
impl BitAnd<F> for V3 {
    type Output = V3;
    #[inline(always)]
    fn bitand(self, mask: F) -> V3 {
        V3::new(self.x & mask, self.y & mask, self.z & mask)
    }
}

#[cfg(test)]
mod tests;
