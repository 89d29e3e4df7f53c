//! Hard cases by chance, for tests and studies: numbers of uniform exponent, and rays that graze, run along
//! axes, or begin on the surface. `LUC_SALT=n cargo test -p luc-core --lib` draws other cases in every law.

use super::hash::{hash2, unit};
use crate::math::Vec3;

/// Reproducible random numbers: a counter under a hash.
pub struct Random(u32, u32);

impl Random {
    /// The stream of this number.
    pub fn new(stream: u32) -> Self {
        #[cfg(test)]
        let stream = stream ^ salt() << 20;
        Self(0, stream)
    }

    /// 32 random bits.
    pub fn bits(&mut self) -> u32 {
        self.0 += 1;
        hash2(self.0, self.1)
    }

    /// Whether a case of one in `n` happens.
    pub fn one_in(&mut self, n: u32) -> bool {
        self.bits().is_multiple_of(n)
    }

    /// Uniform in `lo..hi`.
    pub fn range(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * unit(self.bits())
    }

    /// Positive, of uniform exponent in `lo..hi`.
    pub fn size(&mut self, lo: i32, hi: i32) -> f32 {
        let exponent = lo + (self.bits() % (hi - lo) as u32) as i32;
        f32::from_bits(((127 + exponent) as u32) << 23 | self.bits() >> 9)
    }

    /// Like [`Random::size`], of either sign, now and then ±0.
    pub fn signed(&mut self, lo: i32, hi: i32) -> f32 {
        let size = if self.one_in(16) { 0.0 } else { self.size(lo, hi) };
        if self.one_in(2) { -size } else { size }
    }

    /// A cosine 0..=1, dense at both ends.
    pub fn cosine(&mut self) -> f32 {
        match self.bits() % 3 {
            0 => self.range(0.0, 1.0),
            1 => 1.0 - self.size(-24, 0),
            _ => self.size(-20, 0),
        }
    }

    /// A unit vector, one in eight along a coordinate axis.
    pub fn direction(&mut self) -> Vec3 {
        if self.one_in(8) {
            return [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z][self.bits() as usize % 6];
        }
        loop {
            let v = Vec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            if (0.01..1.0).contains(&v.length_squared()) {
                // By the reciprocal, so that a stream keeps its cases.
                return v * (1.0 / v.length());
            }
        }
    }

    /// A vector of uniform exponent.
    pub fn vector(&mut self, lo: i32, hi: i32) -> Vec3 {
        self.direction() * self.size(lo, hi)
    }

    /// A ray through about `target`, a point on a surface with this normal, of a body about this
    /// large around this axis: any, grazing, along the axis or across it; from afar, from near,
    /// from the surface itself.
    pub fn ray(&mut self, target: Vec3, normal: Vec3, axis: Vec3, size: f32) -> (Vec3, Vec3) {
        let tilt = self.direction() * self.signed(-30, -1);
        let any = self.direction();
        let direction = match self.bits() % 8 {
            0 => (any - normal * any.dot(normal)).normalize_or(any) + normal * self.signed(-30, -2),
            1 => axis + tilt,
            2 => -axis,
            3 => (any - axis * any.dot(axis)).normalize_or(any),
            4 => any + tilt,
            _ => any,
        };
        let direction = direction * if self.one_in(4) { self.size(-8, 8) } else { 1.0 };
        let back = if self.one_in(8) { 0.0 } else { size * self.signed(-8, 14) };
        (target - direction.normalize_or(any) * back, direction)
    }
}

/// What sets a run's streams apart from the usual ones: `LUC_SALT`, 1..4096, else 0.
#[cfg(test)]
fn salt() -> u32 {
    let given = std::env::var("LUC_SALT").unwrap_or_else(|_| "0".into());
    given
        .parse()
        .ok()
        .filter(|&salt| salt < 4096)
        .unwrap_or_else(|| panic!("LUC_SALT={given} is not 0..4096"))
}
