//! Textures of surfaces: a pattern as a factor on the albedo, and as relief under the normal.
//!
//! Relief (Blinn 1978): the surface moved out by b h(p), with h the pattern, has the normal
//! n - b ∇h without ∇h's part along n. Patterns fade as their finest detail gets smaller than the
//! ray's footprint; relief, which mirrors magnify, fades from eight footprints on the surface in a
//! detail on, is gone at four, and its slopes become roughness (Toksvig 2005).

use super::Surface;
use super::pattern::{self, Height};
use crate::features;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::noise::value_noise;
use crate::scene::{Channel, Pattern, Texture};

/// Footprints in the pattern's finest detail under which relief isn't shown.
const FINEST_RELIEF: f32 = 4.0;

/// Mean square slope along a surface, cells of side 1, of value noise: 2 · 1.2 · ⅔ · 0.743². It
/// serves for all patterns.
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
    let p = s.point * scale;
    let (mut value, mut gradient, mut details) = (F::ZERO, V3::ZERO, F::ONE);
    let (kind, n) = (s.value(Channel::Pattern), s.outward());
    let mut draw = |pattern: Pattern, height: fn(V3, V3) -> Height| {
        let own = kind.simd_eq(splat(pattern as u32 as f32));
        if own.any() {
            let (height, slope) = height(p, n);
            value = own.select(height, value);
            gradient = V3::select(own, slope, gradient);
            details = own.select(splat(1.0 / pattern.finest()), details);
        }
    };
    draw(Pattern::Noise, |p, _| value_noise(p));
    if features::CELLS {
        draw(Pattern::Cells, |p, _| pattern::cells(p));
    }
    if features::STRIPES {
        draw(Pattern::Stripes, |p, _| pattern::stripes(p));
    }
    if features::BRICK {
        draw(Pattern::Brick, pattern::brick);
    }
    if features::SCRATCHES {
        draw(Pattern::Scratches, pattern::scratches);
    }
    let fade = |footprint: F, finest: f32| {
        let details = footprint * scale * details;
        (splat(2.0) - details * splat(2.0 * finest)).at_least(F::ZERO).at_most(F::ONE)
    };
    let factor = F::ONE + grain * fade(width, 1.0) * value;
    for channel in 0..3 {
        s.material[channel] *= factor;
    }
    if features::BUMPS && relief.any() {
        let long = width / s.normal.dot(d).abs().at_least(splat(1e-3));
        let (shown, steep) = (fade(long, FINEST_RELIEF), bump * scale);
        let slope = gradient * (steep * shown);
        s.normal = (s.normal - (slope - s.normal * slope.dot(s.normal))).normalize();
        let m = s.value(Channel::Roughness);
        let rough = (m * m * m * m + steep * steep * (F::ONE - shown) * splat(SLOPE2)).sqrt().sqrt();
        let roughness = &mut s.material[Channel::Roughness as usize];
        *roughness = relief.select(rough.at_most(F::ONE), m);
    }
}

/// Whether relief that still shows has finer details than `side` px, where a pixel's footprint on
/// the surface is `footprint` world units.
pub fn relief_within(texture: &Texture, footprint: f32, side: f32) -> bool {
    let details = footprint * texture.scale / texture.pattern.finest();
    features::BUMPS && texture.bump > 0.0 && details * side > 1.0 && details * FINEST_RELIEF < 1.0
}
