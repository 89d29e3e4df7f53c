//! Textures of surfaces: a pattern as a factor on the albedo, and as relief under the normal.
//!
//! Relief (Blinn 1978): the surface moved out by b h(p), with h the pattern, has the normal
//! n - b ∇h without ∇h's part along n. Patterns fade as their cells get smaller than the ray's
//! footprint; relief, which mirrors magnify, fades from eight footprints on the surface in a cell
//! on, is gone at four, and its slopes become roughness (Toksvig 2005).

use super::Surface;
use crate::features;
use crate::math::lanes::{F, V3, splat};
use crate::math::noise::value_noise;
use crate::scene::{Channel, Texture};

/// Footprints in a cell of the pattern under which relief isn't shown.
const FINEST_RELIEF: f32 = 4.0;

/// Mean square slope of value noise along a surface, cells of side 1: 2 · 1.2 · ⅔ · 0.743².
const SLOPE2: f32 = 0.88;

/// Applies the textures of `s`, where rays of unit direction `d` have footprints `width` wide, world
/// units.
pub fn texture(s: &mut Surface, d: V3, width: F) {
    let (grain, bump) = (s.value(Channel::Grain), s.value(Channel::Bump));
    let relief = bump.simd_gt(F::ZERO);
    if !(grain.simd_gt(F::ZERO) | relief).any() {
        return;
    }
    let scale = s.value(Channel::Scale);
    let (value, gradient) = value_noise(s.point * scale);
    let fade = |footprint: F, finest: f32| {
        (splat(2.0) - footprint * scale * splat(2.0 * finest)).fast_max(F::ZERO).fast_min(F::ONE)
    };
    let factor = F::ONE + grain * fade(width, 1.0) * value;
    for channel in 0..3 {
        s.material[channel] *= factor;
    }
    if features::BUMPS && relief.any() {
        let long = width / s.normal.dot(d).abs().fast_max(splat(1e-3));
        let (shown, steep) = (fade(long, FINEST_RELIEF), bump * scale);
        let slope = gradient * (steep * shown);
        s.normal = (s.normal - (slope - s.normal * slope.dot(s.normal))).normalize();
        let m = s.value(Channel::Roughness);
        let rough = (m * m * m * m + steep * steep * (F::ONE - shown) * splat(SLOPE2)).sqrt().sqrt();
        let roughness = &mut s.material[Channel::Roughness as usize];
        *roughness = relief.select(rough.fast_min(F::ONE), m);
    }
}

/// Whether relief that still shows has smaller cells than `side` px, where a pixel's footprint on
/// the surface is `footprint` world units.
pub fn relief_within(texture: &Texture, footprint: f32, side: f32) -> bool {
    let cells = footprint * texture.scale;
    features::BUMPS && texture.bump > 0.0 && cells * side > 1.0 && cells * FINEST_RELIEF < 1.0
}
