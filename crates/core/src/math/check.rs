//! Shared by the tests of this module: error in ulp, sweeps over all floats, fingerprints of bits.

use super::fingerprint;
use crate::math::hash::hash2;

/// Every 1009th float bit pattern: all signs and exponents, infinities and NaNs.
pub fn every_1009th() -> impl Iterator<Item = f32> {
    (0..=u32::MAX).step_by(1009).map(f32::from_bits)
}

/// Random bits for test case `i` of kind `kind`.
pub fn bits_spread(i: u32, kind: u32) -> u32 {
    hash2(i, kind)
}

/// Distance of `got` from `exact` in units of the f32 spacing at `exact`; 0 for equal infinities and for
/// two NaNs, infinite where only one side is special.
pub fn ulp_error(got: f32, exact: f64) -> f64 {
    let rounded = exact as f32;
    if exact.is_nan() || rounded.is_infinite() || !got.is_finite() {
        return if got == rounded || got.is_nan() && exact.is_nan() { 0.0 } else { f64::INFINITY };
    }
    let exponent = ((exact.to_bits() >> 52) as i64 & 2047) - 1023;
    let spacing = f64::from_bits(((exponent.max(-126) - 23 + 1023) as u64) << 52);
    (f64::from(got) - exact).abs() / spacing
}

/// The worst case seen, printed when it is read.
pub struct Worst<'a> {
    name: &'a str,
    ulp: f64,
    at: f32,
}

impl<'a> Worst<'a> {
    pub fn new(name: &'a str) -> Self {
        Worst { name, ulp: 0.0, at: 0.0 }
    }

    /// Counts `got` for argument `at` against the exact value.
    pub fn add(&mut self, at: f32, got: f32, exact: f64) {
        let ulp = ulp_error(got, exact);
        if ulp > self.ulp {
            (self.ulp, self.at) = (ulp, at);
        }
    }

    pub fn ulp(&self) -> f64 {
        println!("{:24} max {:.4} ulp at {:e} ({:#010x})", self.name, self.ulp, self.at, self.at.to_bits());
        self.ulp
    }
}

/// Fingerprint of the bits of results; all NaNs count as one, since their payload is unspecified.
pub struct Fingerprint(fingerprint::Fingerprint);

impl Fingerprint {
    pub fn new() -> Self {
        Fingerprint(fingerprint::Fingerprint::default())
    }

    pub fn add(&mut self, v: f32) {
        self.add_bits(if v.is_nan() { f32::NAN.to_bits() } else { v.to_bits() });
    }

    pub fn add_bits(&mut self, bits: u32) {
        self.0.add(bits.to_le_bytes());
    }

    pub fn value(&self) -> u64 {
        self.0.value()
    }
}
