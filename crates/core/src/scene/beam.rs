//! Light that is seen on its way: beams in thin haze, and round glows where they end.

use crate::math::Vec3;

/// Light along a straight line; both ends may be the same, for a round glow.
///
/// A ray that passes the line at distance r and angle a gets
/// `colour exp(-(r / width)²) exp(-fade s) / max(sin a, 0.01)`, with s the distance along the line
/// from `from`; see [`crate::shade::beam`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beam {
    /// Where the light comes from, world.
    pub from: Vec3,
    /// Where it ends, world.
    pub to: Vec3,
    /// Distance from the line at which it is down to 1/e, world units, over 0.
    pub width: f32,
    /// Radiance across the line at `from`, linear RGB.
    pub colour: Vec3,
    /// Loss per world unit along the line, 0 for none.
    pub fade: f32,
}

impl Beam {
    /// Distance from the line at which its light ends, in widths.
    pub const END: f32 = 3.0;

    /// Unit vector from the first end to the second, or 0 if they are the same; and their distance.
    pub fn along(&self) -> (Vec3, f32) {
        let length = (self.to - self.from).length();
        ((self.to - self.from).normalize_or_zero(), length)
    }
}
