//! Lamps and shining rectangles.

use crate::math::{Vec3, cross};

/// What shape a lamp's light has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines evenly in all directions.
    Point,
    /// As a point, but nothing casts a shadow in its light.
    Fill,
    /// Shines in a cone: full inside `inner`, none outside `outer` (cosines, inner > outer).
    Spot {
        /// Unit direction of the cone's axis.
        direction: Vec3,
        /// Cosine of the angle up to which the light is full.
        inner: f32,
        /// Cosine of the angle from which on there is none.
        outer: f32,
    },
}

/// A lamp of no extent. Diffuse radiance of what it lights is `albedo * colour * cos / d²`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position, world.
    pub position: Vec3,
    /// Intensity, linear RGB times strength.
    pub colour: Vec3,
    /// Point, fill or spot.
    pub kind: LightKind,
}

/// One of up to 512 small lights. It lights like a [`Light`] without shadow, but ends at a distance:
/// `colour / d² * (1 - (d / radius)^4)²`. To be seen it needs a [`crate::scene::Beam`] without length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Position, world.
    pub position: Vec3,
    /// Distance from which on its light is exactly 0, world units.
    pub radius: f32,
    /// Intensity, linear RGB times strength.
    pub colour: Vec3,
}

/// A rectangle that shines to one side. Surfaces are lit by one sample in its middle, as by a
/// lamp of intensity `radiance * area / pi` with a cosine; mirrors and glass see the rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitter {
    /// Middle, world.
    pub centre: Vec3,
    /// Unit vector along the width.
    pub u: Vec3,
    /// Unit vector along the height.
    pub v: Vec3,
    /// Half width and half height, world units.
    pub half: [f32; 2],
    /// Radiance of the bright side, linear RGB.
    pub radiance: Vec3,
}

impl Emitter {
    /// A rectangle of `width` by `height` whose bright side faces `target`, sides level.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn facing(centre: Vec3, target: Vec3, width: f32, height: f32, radiance: Vec3) -> Self {
        let n = (target - centre).normalize_or(Vec3::NEG_Y);
        let u = cross(Vec3::Y, n).normalize_or(Vec3::X);
        Self { centre, u, v: cross(n, u), half: [width * 0.5, height * 0.5], radiance }
    }

    /// Unit normal of the bright side.
    pub fn normal(&self) -> Vec3 {
        cross(self.u, self.v)
    }
}
