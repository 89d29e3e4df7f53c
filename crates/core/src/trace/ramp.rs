//! Colours over a number, linear between stops.

use crate::math::lanes::{Bound, F, V3, splat};
use crate::scene::Stop;

/// The colour at `x`; that of the first or last stop beyond them, black without any.
#[inline(never)]
pub fn ramp(stops: &[Stop], x: F) -> V3 {
    let mut colour = V3::splat(stops.first().map_or(crate::math::Vec3::ZERO, |stop| stop.colour));
    for pair in stops.windows(2) {
        let x = (x - splat(pair[0].y)) * splat(1.0 / (pair[1].y - pair[0].y));
        let change = V3::splat(pair[1].colour) - V3::splat(pair[0].colour);
        colour += change * x.at_least(F::ZERO).at_most(F::ONE);
    }
    colour
}
