//! What a ray sees when it hits nothing: a vertical gradient, glows, and flat discs far away.
//!
//! Gradient: linear between stops over the y component of the unit direction. Glow:
//! `colour exp(sharpness (d·g - 1))`. Discs are background objects: hit only if nothing else is,
//! they cast no shadow and light nothing.

use crate::math::Vec3;

/// One stop of a gradient; the sky's runs over the height of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Where: for the sky the y component of the unit direction, -1 to 1; ascending from stop to stop.
    pub y: f32,
    /// Linear RGB.
    pub colour: Vec3,
}

/// A soft light in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// Unit direction of its middle.
    pub direction: Vec3,
    /// Linear RGB at the middle.
    pub colour: Vec3,
    /// Exponent: larger is narrower.
    pub sharpness: f32,
}

/// A flat disc that faces along z, with a colour that runs linearly over world y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Middle of the disc, world.
    pub centre: Vec3,
    /// Radius, world units.
    pub radius: f32,
    /// Linear RGB at `centre.y - radius`.
    pub low: Vec3,
    /// Linear RGB at `centre.y + radius`.
    pub high: Vec3,
}

/// All that lies behind the shapes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Background {
    /// Sky gradient, ascending in y; empty is black.
    pub stops: Vec<Stop>,
    /// Glows, added to the gradient.
    pub glows: Vec<Glow>,
    /// Discs, nearest first.
    pub discs: Vec<Disc>,
}
