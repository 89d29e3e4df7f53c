//! How cases are drawn, and exact numbers.

use dashu_ratio::RBig;
use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, RngSeed};

/// Half an ulp of 1.
pub const U: f64 = 1.0 / 16_777_216.0;

/// Cases of each law, the same in every run; failures are kept. `PROPTEST_CASES` and `PROPTEST_RNG_SEED` draw
/// more, or others.
pub fn config(cases: u32) -> ProptestConfig {
    const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/kernels.regressions");
    let given = ProptestConfig::default();
    let set = |name| std::env::var_os(name).is_some();
    ProptestConfig {
        cases: if set("PROPTEST_CASES") { given.cases } else { cases },
        rng_seed: if set("PROPTEST_RNG_SEED") { given.rng_seed } else { RngSeed::Fixed(64) },
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(FILE))),
        ..given
    }
}

/// Positive, of uniform exponent in `lo..hi`.
pub fn size(lo: i32, hi: i32) -> impl Strategy<Value = f32> + Clone {
    (lo..hi, 0_u32..1 << 23)
        .prop_map(|(exponent, bits)| f32::from_bits(((127 + exponent) as u32) << 23 | bits))
}

/// The same of either sign, now and then ±0.
pub fn signed(lo: i32, hi: i32) -> impl Strategy<Value = f32> + Clone {
    let size = prop_oneof![1 => Just(0.0_f32), 15 => size(lo, hi)];
    (size, any::<bool>()).prop_map(|(size, minus)| if minus { -size } else { size })
}

/// Evenly spread in `lo..hi`, in 2^24 steps.
pub fn range(lo: f32, hi: f32) -> impl Strategy<Value = f32> + Clone {
    (0_u32..1 << 24).prop_map(move |i| lo + (hi - lo) * (i as f32 / 16_777_216.0))
}

/// 0..=1, dense at both ends.
pub fn share() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![0.0_f32..1.0, size(-24, 0).prop_map(|x| 1.0 - x), size(-40, 0), Just(0.0_f32), Just(1.0_f32)]
}

/// A vector whose coordinates have exponents of their own.
pub fn vector(lo: i32, hi: i32) -> impl Strategy<Value = Vec3> + Clone {
    [signed(lo, hi), signed(lo, hi), signed(lo, hi)].prop_map(Vec3::from_array)
}

/// A unit vector, often along an axis or nearly so.
pub fn direction() -> impl Strategy<Value = Vec3> + Clone {
    let tilt = vector(-30, 0);
    let axis = prop::sample::select(vec![Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z]);
    prop_oneof![
        2 => (axis.clone(), tilt).prop_map(|(a, t)| (a + t).normalize_or(a)),
        1 => axis,
        4 => vector(-3, 0).prop_map(|v| v.normalize_or(Vec3::Z)),
    ]
}

/// Anything that a float can be.
pub fn odd() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![
        any::<u32>().prop_map(f32::from_bits),
        prop::sample::select(vec![
            0.0,
            -0.0,
            1.0,
            -1.0,
            1e-45,
            -1e-40,
            f32::MIN_POSITIVE,
            1e-20,
            1e19,
            f32::MAX,
            f32::MIN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
        ]),
        signed(-20, 20),
    ]
}

/// A vector of such.
pub fn odd_vector() -> impl Strategy<Value = Vec3> + Clone {
    [odd(), odd(), odd()].prop_map(Vec3::from_array)
}

/// The exact value of a finite number.
pub fn exact(x: f32) -> RBig {
    RBig::try_from(x).expect("finite")
}

/// The same of three coordinates.
pub fn exact3(v: Vec3) -> [RBig; 3] {
    v.to_array().map(exact)
}

/// The exact scalar product.
pub fn dot(a: &[RBig; 3], b: &[RBig; 3]) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// a - b, exactly.
pub fn minus(a: &[RBig; 3], b: &[RBig; 3]) -> [RBig; 3] {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// An f64 as an exact number.
pub fn wide(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

/// The f64 next to it.
pub fn near(x: &RBig) -> f64 {
    x.to_f64().value()
}
