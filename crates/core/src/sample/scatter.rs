//! Rays in random directions: bounces of diffuse light, and mirrors of rough surfaces.
//!
//! A bounce draws directions by their cosine, so that each counts as the albedo over their number
//! (Kajiya 1986); it takes the place of the ambient light. A rough mirror draws those of the facets
//! that the eye sees. The numbers are a pure function of the sample's position in the picture, the
//! ray's ancestors and the pattern: a frame averaged over K patterns draws K times as many points
//! of the same sequences.
//!
//! What a scattered ray finds is spread over a wide angle: surfaces look rough to it, the sky's
//! glows soft, mirrors and glass end it; lamps' rectangles and discs it doesn't see, as surfaces
//! are lit by lamps anyway.

use super::rays::Packet;
use crate::counters::Counter;
use crate::features;
use crate::math::hash::mix_x8;
use crate::math::lanes::{F, U, V3, splat, splat_u};
use crate::math::sampling::{cosine, point};
use crate::render::Stage;
use crate::scene::{Channel, Shading};
use crate::shade;
use crate::trace::{Rays8, Surface};

/// Rays that go on from a packet's hits.
pub struct Way {
    /// The rays.
    pub rays: Packet,
    /// Lanes that have such a ray, lane 0 lowest.
    pub which: u32,
    /// What counts them.
    pub counter: Counter,
}

/// Whether any rays are drawn at random.
const RANDOM: bool = features::BOUNCES || features::ROUGH;

/// Bits of a ray's seed that count its bounces.
const BOUNCES: u32 = 3;

/// Bit of a ray's seed: it is one of several drawn at random, or came by such a ray.
const DRAWN: u32 = 4;

/// Roughness over which mirrors are drawn.
pub const ROUGH: f32 = 0.05;

/// The lanes whose bit of `mask` is set.
fn has(seed: U, mask: u32) -> F {
    let bits = seed & splat_u(mask);
    !F::from_bits(bits.simd_eq(splat_u(0)))
}

/// Lanes that came by a bounce.
pub fn scattered(packet: &Packet) -> F {
    if features::BOUNCES { has(packet.seed, BOUNCES) } else { F::ZERO }
}

/// Lanes that were drawn at random.
pub fn drawn(packet: &Packet) -> F {
    if RANDOM { has(packet.seed, DRAWN | BOUNCES) } else { F::ZERO }
}

/// First seed of samples at these positions.
pub fn seed(x: F, y: F) -> U {
    if !RANDOM {
        return splat_u(0);
    }
    mix_x8(x.to_bits(), y.to_bits()) & splat_u(!(BOUNCES | DRAWN))
}

/// The seed of a ray's `i`th offspring, of the same kind.
pub fn offspring(seed: U, i: u32) -> U {
    if !RANDOM {
        return seed;
    }
    let kind = splat_u(BOUNCES | DRAWN);
    (mix_x8(seed, splat_u(i)) & !kind) | (seed & kind)
}

/// Lanes whose diffuse light is drawn at the end of a chain of `level` rays.
pub fn bounces(stage: &Stage, packet_seed: U, s: &Surface, level: u32) -> F {
    let (count, most) = (stage.quality.scatter, stage.scene.bounces.min(BOUNCES));
    if !features::BOUNCES || count == 0 || most == 0 || level >= stage.quality.depth {
        return F::ZERO;
    }
    let done = packet_seed & splat_u(BOUNCES);
    let may = F::from_bits((splat_u(most - 1) - done).simd_lt(splat_u(most)));
    may & s.value(Channel::Diffuse).simd_gt(F::ZERO)
}

/// Lanes whose mirror is drawn.
pub fn rough(stage: &Stage, s: &Surface, level: u32) -> F {
    let drawn = features::ROUGH
        && level == 0
        && stage.scene.rough
        && stage.quality.rough > 0
        && stage.quality.depth > 0
        && stage.scene.shading == Shading::Ggx;
    if !drawn {
        return F::ZERO;
    }
    let mirror = s.value(Channel::Reflection).simd_gt(F::ZERO);
    mirror
        & s.value(Channel::Roughness).simd_gt(splat(ROUGH))
        & s.value(Channel::Transparency).simd_le(F::ZERO)
}

/// Why rays are drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Draw {
    /// A bounce of diffuse light.
    Bounce,
    /// The mirror of a rough surface.
    Mirror,
}

/// Where the rays drawn at `s` in lanes `which` go, whose light counts by `weight`; `level` is the
/// length of the chain so far.
#[inline(never)]
pub fn draw(
    stage: &Stage,
    s: &Surface,
    (kind, level): (Draw, u32),
    (weight, which): (V3, F),
    packet: &Packet,
    ways: &mut Vec<Way>,
) {
    let bounce = kind == Draw::Bounce;
    let count = match kind {
        Draw::Mirror => stage.quality.rough,
        Draw::Bounce if level == 0 => stage.quality.scatter,
        Draw::Bounce => 1,
    };
    let share = splat(1.0 / count as f32);
    let origin = s.point + s.facing * s.clearance;
    let m = s.value(Channel::Roughness);
    // Together they see all around, or all of the lobe.
    let lobe = if bounce { splat(12.0_f32.sqrt()) } else { m * m * splat(6.0) };
    let spread = packet.spread + lobe * share.sqrt();
    // Sequences and offspring of their own for each kind, and the marks that tell them.
    let (turn, mark) = if bounce { (0, 1) } else { (128, DRAWN) };
    for i in 0..count {
        let at = point(packet.seed + splat_u(turn), stage.pattern * count + i);
        let (direction, factor) = if bounce {
            (cosine(s.normal, at), V3::splat(crate::math::Vec3::ONE))
        } else {
            shade::sample(s, -packet.rays.direction, at)
        };
        // About bent normals some lie under the surface.
        let above = which & direction.dot(s.facing).simd_gt(F::ZERO);
        let seed = offspring(packet.seed, turn + i) + splat_u(mark);
        let rays = Packet {
            rays: Rays8 { origin, direction },
            weight: weight * factor * share,
            spread,
            seed,
            ..*packet
        };
        let counter = if bounce { Counter::ScatterRays } else { Counter::RoughRays };
        ways.push(Way { rays, which: above.to_bitmask(), counter });
    }
}
