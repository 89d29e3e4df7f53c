//! What a shape is made of.

use super::{Stop, Texture};
use crate::math::Vec3;

/// Fire that spreads in a body: light over the distance from where it began, as a share of a
/// radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fire {
    /// Where it began, world.
    pub centre: Vec3,
    /// How far it has come, world units, over 0.
    pub radius: f32,
    /// Factor on the colours.
    pub strength: f32,
    /// Light given off, from 0 in the middle to 1 at the radius.
    pub stops: &'static [Stop],
}

/// Optical properties of a surface and of the body under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Albedo of the diffuse part, linear RGB.
    pub colour: Vec3,
    /// Weight of the diffuse part, 0 to 1.
    pub diffuse: f32,
    /// Weight of the highlight of lamps, linear RGB.
    pub specular: Vec3,
    /// Exponent of Phong's highlight, at least 1.
    pub exponent: f32,
    /// Mirror reflectance at normal incidence, linear RGB; also the F0 of Cook-Torrance and GGX.
    pub f0: Vec3,
    /// Root mean square slope of the microfacets (Beckmann m), 0 to 1; GGX takes its square as α.
    /// Widens mirrored lights.
    pub roughness: f32,
    /// Share of the mirrored light that is traced, 0 (no mirror) to 1.
    pub reflection: f32,
    /// Share of light that enters the body, 0 (opaque) to 1 (glass).
    pub transparency: f32,
    /// Index of refraction of the body.
    pub ior: f32,
    /// Factor on light that crosses the surface, linear RGB.
    pub tint: Vec3,
    /// Light given off, linear RGB.
    pub emission: Vec3,
    /// Light given off in place of `emission` where fire has come.
    pub fire: Option<Fire>,
    /// Factor on a lamp's light that crosses the whole body, linear RGB.
    pub shadow: Vec3,
    /// How albedo and normal vary over the surface.
    pub texture: Texture,
}

impl Default for Material {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Where each property stands in [`Material::channels`]; colours take three places.
#[derive(Clone, Copy)]
#[repr(usize)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Channel {
    Colour = 0,
    Diffuse = 3,
    Specular = 4,
    Exponent = 7,
    F0 = 8,
    Roughness = 11,
    Reflection = 12,
    Transparency = 13,
    Ior = 14,
    Tint = 15,
    Emission = 18,
    Pattern = 21,
    Scale = 22,
    Grain = 23,
    Bump = 24,
}

impl Material {
    /// A black, matt, opaque body.
    pub const DEFAULT: Self = Self {
        colour: Vec3::ZERO,
        diffuse: 1.0,
        specular: Vec3::ZERO,
        exponent: 1.0,
        f0: Vec3::ZERO,
        roughness: 0.0,
        reflection: 0.0,
        transparency: 0.0,
        ior: 1.0,
        tint: Vec3::ONE,
        emission: Vec3::ZERO,
        fire: None,
        shadow: Vec3::ZERO,
        texture: Texture::NONE,
    };

    /// Number of values in [`Material::channels`].
    pub const CHANNELS: usize = 25;

    /// The properties that shading reads, flat, so that packets can mix materials lane by lane.
    pub fn channels(&self) -> [f32; Self::CHANNELS] {
        let Self { colour: c, specular: s, f0: f, tint: t, emission: e, texture: x, .. } = self;
        [
            c.x,
            c.y,
            c.z,
            self.diffuse,
            s.x,
            s.y,
            s.z,
            self.exponent,
            f.x,
            f.y,
            f.z,
            self.roughness,
            self.reflection,
            self.transparency,
            self.ior,
            t.x,
            t.y,
            t.z,
            e.x,
            e.y,
            e.z,
            x.pattern as u32 as f32,
            x.scale,
            x.grain,
            x.bump,
        ]
    }

    /// True if light passes through the body.
    pub fn is_transparent(&self) -> bool {
        self.transparency > 0.0
    }
}
