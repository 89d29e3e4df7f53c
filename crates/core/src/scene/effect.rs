//! Effects on the finished picture: a scene lists them, in any order.
//!
//! They work on display values, after the grade and before vignette and grain; see [`crate::post`].

use crate::counters::Counter;
use crate::math::Vec3;
use glam::Vec2;

/// What an effect does with a display value v; l is its luminance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// 1/2 + (v - 1/2) times this.
    Contrast(f32),
    /// The share `strength` of v becomes `colour` times l.
    Tint {
        /// Colour of white.
        colour: Vec3,
        /// 0 to 1.
        strength: f32,
    },
    /// A narrow glow around what is over `threshold`, times `intensity`.
    Bloom {
        /// Light over this glows.
        threshold: f32,
        /// How much of it is added.
        intensity: f32,
    },
    /// The same over several octaves, each twice as wide.
    WideBloom {
        /// Light over this glows.
        threshold: f32,
        /// How much of it is added.
        intensity: f32,
        /// 2 to 4.
        octaves: usize,
    },
    /// v plus this times its difference from the mean of its four neighbours.
    Sharpness(f32),
    /// Colour mapping: only so many different values of red, green and blue, at least 2.
    Levels(Vec3),
    /// Chromatic aberration: red lies farther from the middle by this share, blue nearer.
    Fringes(f32),
    /// `colour` is added where l has edges, by Sobel's operator.
    Edges {
        /// How strongly, 1 for all of the colour at a step from black to white.
        strength: f32,
        /// Colour of the lines.
        colour: Vec3,
    },
    /// Left and upper borders of the cells that were filled or interpolated, from 4 px on: v times `shade`
    /// plus `colour`.
    Cells {
        /// Factor on what is there.
        shade: f32,
        /// What is added.
        colour: Vec3,
    },
    /// This share of the way to white; to black if it is under 0.
    Lighten(f32),
    /// v times `base + glow (1 - (r / radius)²)`, but at least `base`, as on a tube; r is 1 in the corners.
    Tube {
        /// Factor at the border.
        base: f32,
        /// More of it in the middle.
        glow: f32,
        /// Where the glow ends.
        radius: f32,
    },
    /// Noise of this half amplitude, drawn anew for each frame.
    Grain(f32),
}

impl Kind {
    /// What counts its passes.
    pub fn counter(&self) -> Counter {
        match self {
            Kind::Contrast(_) => Counter::Contrast,
            Kind::Tint { .. } => Counter::Tint,
            Kind::Bloom { .. } => Counter::Bloom,
            Kind::WideBloom { .. } => Counter::WideBloom,
            Kind::Sharpness(_) => Counter::Sharpness,
            Kind::Levels(_) => Counter::Levels,
            Kind::Fringes(_) => Counter::Fringes,
            Kind::Edges { .. } => Counter::Edges,
            Kind::Cells { .. } => Counter::CellBorders,
            Kind::Lighten(_) => Counter::Lighten,
            Kind::Tube { .. } => Counter::Tube,
            Kind::Grain(_) => Counter::Grain,
        }
    }
}

/// On which part of the picture: a share of `(p · normal - from) / over`, 0 to 1, where p runs from -1 to 1
/// rightwards and upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where it grows to.
    pub normal: Vec2,
    /// Where it begins.
    pub from: f32,
    /// Over what distance it grows to all, over 0.
    pub over: f32,
}

impl Place {
    /// All of the picture.
    pub const ALL: Place = Place { normal: Vec2::ZERO, from: -1.0, over: 1.0 };
}

/// A step of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// What it does.
    pub kind: Kind,
    /// Share of it that is mixed with what it was applied to; at 0 it isn't applied.
    pub amount: f32,
    /// How often in a row.
    pub multipass: u32,
    /// Where.
    pub place: Place,
}

impl Effect {
    /// All of an effect, once, everywhere.
    pub const fn new(kind: Kind) -> Effect {
        Effect { kind, amount: 1.0, multipass: 1, place: Place::ALL }
    }

    /// Whether it is applied at all.
    pub fn runs(&self) -> bool {
        self.amount != 0.0 && self.multipass > 0
    }
}
