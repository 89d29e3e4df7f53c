//! Lamps as shading sees them: points, spots and shining rectangles in one form.

use crate::counters::Counter;
use crate::features;
use crate::math::Vec3;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::sampling::spread;
use crate::scene::{LightKind, Material, Scene};
use std::f32::consts::PI;

/// A source of direct light without extent.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// Position, world.
    pub position: Vec3,
    /// Intensity, linear RGB.
    pub colour: Vec3,
    /// Unit direction of most light.
    axis: Vec3,
    /// The cosine c to the axis gives (c - outer) * gain, kept in 0..1.
    outer: f32,
    gain: f32,
    /// Half of the sides of the rectangle that the lamp stands for, 0 for lamps without extent.
    sides: [Vec3; 2],
    /// The lamp stands for a rectangle, whose highlight mirrors show by themselves.
    pub is_emitter: bool,
    /// Nothing casts a shadow in its light.
    pub is_fill: bool,
}

/// All lamps of a scene: its lights, then one in the middle of each shining rectangle; in place of what `out`
/// held.
#[cfg_attr(luc_size, optimize(size))]
pub fn lamps(scene: &Scene, out: &mut Vec<Lamp>) {
    let count = scene.lights.len();
    let lamp = |i: usize| {
        let (position, colour, axis, sides, inner, outer) = if i < count {
            let light = &scene.lights[i];
            let (axis, inner, outer) = match light.kind {
                LightKind::Point | LightKind::Fill => (Vec3::ZERO, -1.0, -2.0),
                LightKind::Spot { direction, inner, outer } => (direction, inner, outer),
            };
            (light.position, light.colour, axis, [Vec3::ZERO; 2], inner, outer)
        } else {
            let e = &scene.emitters[i - count];
            let colour = e.radiance * (e.half[0] * e.half[1] * 4.0 / PI);
            (e.centre, colour, e.normal(), [e.u * e.half[0], e.v * e.half[1]], 1.0, 0.0)
        };
        let gain = 1.0 / (inner - outer).max(1e-6);
        let is_fill = features::FILL && i < count && scene.lights[i].kind == LightKind::Fill;
        Lamp { position, colour, axis, outer, gain, sides, is_emitter: i >= count, is_fill }
    };
    out.clear();
    out.extend((0..count + scene.emitters.len()).map(lamp));
}

impl Lamp {
    /// From the middle of the rectangle to one of its points; the first is the middle itself. The same
    /// for all places that are lit: steps of so few rays are finer to look at than their noise, and
    /// what runs smoothly can be interpolated.
    pub fn aside(&self, sample: u32) -> Vec3 {
        let at = spread(sample) * 2.0 - 1.0;
        self.sides[0] * at.x + self.sides[1] * at.y
    }

    /// Whether a material shows this lamp's direct light at all. Mirrors show shining rectangles
    /// themselves, in place of a highlight.
    pub fn lights(&self, material: &Material) -> bool {
        let highlight = material.specular.max_element() > 0.0;
        material.diffuse > 0.0 || (highlight && !(self.is_emitter && material.reflection > 0.0))
    }

    /// The counter of its kind.
    pub fn counter(&self) -> Counter {
        match (self.is_emitter, self.is_fill) {
            (true, _) => Counter::RectangleLights,
            (_, true) => Counter::FillLights,
            _ if self.axis == Vec3::ZERO => Counter::PlainLights,
            _ => Counter::SpotLights,
        }
    }

    /// Share of the lamp's light that goes in unit direction `d` away from it.
    #[inline(always)]
    pub fn lobe(&self, d: V3) -> F {
        let c = d.dot(V3::splat(self.axis));
        let x = ((c - splat(self.outer)) * splat(self.gain)).at_least(F::ZERO).at_most(F::ONE);
        // Spots ease in.
        if self.is_emitter { x } else { x * x * (splat(3.0) - (x + x)) }
    }
}
