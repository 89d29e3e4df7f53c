//! Short forms that the scenes share: motion in seconds, colours, materials.

use luc_core::math::scalar::{sin, sin_cos};
use luc_core::math::{Vec3, number};
use luc_core::scene::{Ease, Grade, Key, Material, Texture};
use std::f32::consts::{PI, TAU};

use super::FPS;

/// Seconds of a local frame.
pub const fn seconds(frame: u64) -> f32 {
    number(frame as usize) / FPS as f32
}

/// `x` with nine binary places after the first, about the three digits that the tables are written with: what
/// more it has would be noise, of which a packer keeps every bit.
pub const fn short(x: f32) -> f32 {
    f32::from_bits((x.to_bits() + 0x2000) & !0x3fff)
}

/// A vector or colour of numbers in a table, [`short`]. What moves or is worked out is a `Vec3::new`.
pub const fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(short(x), short(y), short(z))
}

/// A colour times a strength.
pub const fn times(c: Vec3, k: f32) -> Vec3 {
    let [x, y, z] = c.to_array();
    v(x * k, y * k, z * k)
}

/// sin(2 pi (t / period + phase)): a swing that takes `period` seconds.
pub fn swing(t: f32, period: f32, phase: f32) -> f32 {
    sin((t / period + phase) * TAU)
}

/// Point on a level circle around the y axis at `turn` (1 is once around), from +z towards +x.
pub fn orbit(turn: f32, radius: f32, height: f32) -> Vec3 {
    let (sin, cos) = sin_cos(turn * TAU);
    Vec3::new(sin * radius, height, cos * radius)
}

/// Degrees as radians.
pub const fn degrees(x: f32) -> f32 {
    x * (PI / 180.0)
}

/// Degrees that stand still, as radians.
pub const fn angle(x: f32) -> f32 {
    short(degrees(x))
}

/// A grade of short numbers.
pub const fn graded(grade: Grade) -> Grade {
    Grade {
        exposure: short(grade.exposure),
        bloom: short(grade.bloom),
        bloom_threshold: short(grade.bloom_threshold),
        vignette: short(grade.vignette),
        grain: short(grade.grain),
        ..grade
    }
}

/// A key of a track.
pub const fn key(time: f32, value: f32, ease: Ease) -> Key {
    Key { time, value: short(value), ease }
}

/// A bare metal: no diffuse part, mirrors in its own colour.
pub const fn metal(f0: Vec3, roughness: f32) -> Material {
    Material { diffuse: 0.0, f0, roughness: short(roughness), reflection: 1.0, ..Material::DEFAULT }
}

/// A polished body with a diffuse part under a clear surface.
pub const fn polished(colour: Vec3, roughness: f32, ior: f32) -> Material {
    Material { colour, f0: f0(ior), roughness: short(roughness), reflection: 1.0, ior, ..Material::DEFAULT }
}

/// A surface of microfacets for GGX: mirrors in its colour by the metallic part, as a body of
/// index 1.45 by the rest. Nothing is traced for its mirror; set `reflection` to trace it.
pub const fn surface(colour: Vec3, roughness: f32, metallic: f32) -> Material {
    let rest = 0.034 * (1.0 - metallic);
    let [red, green, blue] = colour.to_array();
    let f0 = v(rest + red * metallic, rest + green * metallic, rest + blue * metallic);
    Material {
        colour,
        diffuse: short(1.0 - metallic),
        specular: Vec3::ONE,
        f0,
        roughness: short(roughness),
        ..Material::DEFAULT
    }
}

/// Albedo that varies by `amount`, with `scale` cells per world unit.
pub const fn grain(scale: f32, amount: f32) -> Texture {
    Texture { scale, grain: amount, ..Texture::NONE }
}

/// Relief `depth` high, of which `strength` shows, with `scale` cells per world unit.
pub const fn bumps(scale: f32, strength: f32, depth: f32) -> Texture {
    Texture { scale: short(scale), bump: short(strength * depth), ..Texture::NONE }
}

/// A clear body: `tint` at each surface, `shadow` on light through all of it.
pub const fn glass(tint: Vec3, shadow: Vec3, ior: f32) -> Material {
    Material {
        diffuse: 0.0,
        f0: f0(ior),
        reflection: 1.0,
        transparency: 1.0,
        ior,
        tint,
        shadow,
        ..Material::DEFAULT
    }
}

/// Reflectance at normal incidence of a body with index of refraction `ior` in air.
const fn f0(ior: f32) -> Vec3 {
    let r = (ior - 1.0) / (ior + 1.0);
    Vec3::splat(short(r * r))
}
