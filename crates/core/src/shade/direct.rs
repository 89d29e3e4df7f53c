//! Light that comes straight from the lamps, by the scene's reflection model.
//!
//! Radiance of a lamp of intensity I at distance d: `I lobe / d² * (diffuse + highlight)`, without
//! 1/pi, so a white surface that faces a lamp of I = 1 at d = 1 has radiance 1.

use super::fresnel::{Split, schlick};
use super::ggx::ggx;
use super::lamps::Lamp;
use crate::counters::{Counter, Counters};
use crate::features;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::lanes_fn::{exp, pow};
use crate::math::{Vec3, whole};
use crate::render::Stage;
use crate::scene::{Channel, Scene, Shading};
use crate::study::Phase;
use crate::trace::{BLOCKED, Rays8, Surface, Suspects, ambient_share, occlusion};

/// Lamps that may cast shadows; those after them light without.
pub const MAX_LAMPS: usize = 8;

/// Visibility codes of a packet, per lamp: see [`occlusion`]. Between 0 and [`BLOCKED`] stands the
/// hidden share of a shining rectangle, by which its light is less.
pub type Codes = [F; MAX_LAMPS];

/// Rays of a soft shadow that must agree, for the others to be spared.
const AGREE: u32 = 4;

/// Where the visibility of the lamps comes from.
pub enum Visibility<'a> {
    /// Shadow rays against what may hide each lamp; all may hide one that casts soft shadows.
    Trace(&'a [Suspects; MAX_LAMPS]),
    /// Codes known from neighbouring samples.
    Known,
}

/// Light that the lamps bring to surfaces.
pub struct Lit {
    /// What falls on the surface, by the cosine.
    pub irradiance: V3,
    /// What the highlights send to the eye.
    pub highlight: V3,
}

/// What surfaces send to the eye but for mirrors and glass.
pub struct Local {
    /// To be multiplied with the albedo.
    pub irradiance: V3,
    /// Highlights and the surface's own light.
    pub rest: V3,
    /// Share of the light that falls in which is not mirrored.
    pub kept: V3,
}

/// Mean light from the half space around a unit direction, by its height.
#[inline(never)]
pub fn ambient(stage: &Stage, direction: V3) -> V3 {
    let [below, above] = stage.scene.ambient;
    let x = direction.y * splat(0.5) + splat(0.5);
    V3::splat(below) + V3::splat(above - below) * x
}

/// Adds the light from all around (by the normal's height; in lanes `bounces` rays find it) and the
/// surface's own to that of the lamps; what a mirror takes away is missing from the diffuse part. Under GGX that is all that
/// the microfacets reflect: the share that isn't traced is the mean light from there.
#[inline(never)]
pub fn local(
    stage: &Stage,
    s: &Surface,
    split: &Split,
    lit: Lit,
    (active, bounces): (F, F),
    counters: &mut Counters,
) -> Local {
    let mut ambient = ambient(stage, s.normal);
    if features::FIELD_OCCLUSION && stage.scene.occlusion > 0.0 {
        let Scene { fields, occlusion, .. } = stage.scene;
        ambient = ambient * ambient_share(fields, *occlusion, s.point, s.normal, active, counters);
    }
    ambient = ambient & !bounces;
    let mut mirrored = split.reflectance * s.value(Channel::Reflection);
    let mut rest = lit.highlight + s.colour(Channel::Emission);
    if features::GGX && stage.scene.shading == Shading::Ggx {
        rest += (split.reflectance - mirrored) * self::ambient(stage, split.mirrored);
        mirrored = split.reflectance;
    }
    let kept = (V3::splat(Vec3::ONE) - mirrored) * s.value(Channel::Diffuse);
    Local { irradiance: (lit.irradiance + ambient) * kept, rest, kept }
}

/// Phong's highlight (r·v)^n with r·v = 2 (n·l)(n·v) - l·v, over the cosine's weight.
#[inline(never)]
fn phong(s: &Surface, l: V3, v: V3, n_l: F) -> V3 {
    let rv = (n_l + n_l) * s.normal.dot(v) - l.dot(v);
    s.colour(Channel::Specular) * pow(rv.at_least(F::ZERO), s.value(Channel::Exponent))
}

/// pi D of microfacets whose normals have this cosine, over 0, and squared sine, to the surface's, for an rms
/// slope of `m`. Error at most 4 + 6 x ulp for the exponent x = tan² / m². Beckmann and Spizzichino 1963.
#[inline(always)]
pub fn beckmann(sine2: F, cos: F, m: F) -> F {
    let c2 = cos * cos;
    let m2 = m * m;
    exp(-(sine2 / (c2 * m2))) / (m2 * c2 * c2)
}

/// Cook and Torrance's highlight pi D F G / (4 n·v), the cosine n·l included and cancelled.
///
/// Beckmann: D = exp(-tan²/m²) / (pi m² c⁴), 0 at grazing; V-cavities:
/// G = min(1, 2 c n·v / v·h, 2 c n·l / v·h), taken as G / n·v so that nothing is divided by 0.
#[inline(never)]
fn cook_torrance(s: &Surface, l: V3, v: V3, n_l: F) -> V3 {
    let n = s.normal;
    // For unit vectors v·h = l·h = |l + v| / 2, which is the same both ways, bit for bit.
    let sum = l + v;
    let length = sum.length();
    let h = sum * (F::ONE / length);
    let n_v = n.dot(v).at_least(splat(1e-4));
    let n_h = n.dot(h).at_least(splat(1e-4));
    let v_h = (length * splat(0.5)).at_least(splat(1e-4));
    let m = s.value(Channel::Roughness).at_least(splat(1e-3));
    let d = beckmann(n.cross(h).dot(n.cross(h)), n_h, m);
    let two_c = n_h + n_h;
    let g = (F::ONE / n_v).at_most(two_c / v_h).at_most(two_c * n_l / (v_h * n_v));
    schlick(s.colour(Channel::F0), splat(1.0), v_h) * s.colour(Channel::Specular) * (d * g * splat(0.25))
}

/// Direct light at surfaces seen from the unit direction `v`, in lanes `active`.
///
/// `codes` receives the visibility of each shadowed lamp, or holds it when it is known. It is 0,
/// as for a lamp in plain view, where a surface faces away or lies outside the lamp's cone.
#[inline(never)]
pub fn direct(
    stage: &Stage,
    s: &Surface,
    v: V3,
    active: F,
    visibility: Visibility,
    codes: &mut Codes,
    counters: &mut Counters,
) -> Lit {
    let zero = F::ZERO;
    let mut sum = Lit { irradiance: V3::ZERO, highlight: V3::ZERO };
    let specular = s.colour(Channel::Specular);
    let shiny = (specular.x + specular.y + specular.z).simd_gt(zero);
    let diffuse = s.value(Channel::Diffuse).simd_gt(zero);
    // The inner side of glass has no highlights of lamps: they would be seen through itself.
    let behind = s.inside & s.value(Channel::Transparency).simd_gt(zero);
    let active = active & (diffuse | shiny) & !behind;
    if !active.any() {
        return sum;
    }
    let mirrors = s.value(Channel::Reflection).simd_gt(zero);
    let start = s.point + s.facing * s.clearance;
    for (k, lamp) in stage.lamps.iter().enumerate() {
        if cfg!(feature = "counters") {
            counters.add(lamp.counter(), 8);
        }
        let aim = Aim::at(lamp.position, s, start);
        let reach = lamp.lobe(-aim.l);
        // Mirrors show shining rectangles themselves, in place of a highlight.
        let plain = if lamp.is_emitter { diffuse | (shiny & !mirrors) } else { diffuse | shiny };
        let wanted = active & plain & aim.faces & reach.simd_gt(zero);
        if let (Some(code), Visibility::Trace(suspects)) = (codes.get_mut(k), &visibility) {
            *code = zero;
            let samples = stage.shadow_rays(k);
            let radius = stage.penumbra(k);
            let suspects = &suspects[k];
            if (suspects.shapes != 0 || !stage.scene.meshes.is_empty()) && wanted.any() {
                counters.watch.enter(Phase::Tracing);
                let (mut hidden, mut open) = (zero, wanted);
                for sample in 0..samples {
                    if sample == AGREE {
                        open &= hidden.simd_lt(zero) & hidden.simd_gt(splat(-(AGREE as f32)));
                    }
                    if !open.any() {
                        break;
                    }
                    let count = open.to_bitmask().count_ones() as usize;
                    counters.add(Counter::ShadowRays, count);
                    counters.add_rays(count);
                    counters.add(Counter::SoftShadowRays, usize::from(samples > 1));
                    let to_point = V3::splat(lamp.position + lamp.aside(sample)) - start;
                    let rays = Rays8 { origin: start, direction: to_point };
                    let found = occlusion(
                        stage.scene,
                        &stage.quality,
                        stage.bits,
                        &rays,
                        (open, radius),
                        suspects,
                        counters,
                    );
                    hidden += found.at_most(zero) & open;
                    *code = code.at_least(found & open);
                }
                // Of lanes that agreed none or all of the rays are hidden.
                let settled = hidden.simd_lt(zero) & !open;
                let share = settled.select(splat(BLOCKED), hidden * splat(1.0 / samples as f32));
                *code = share.simd_lt(zero).select(share, *code);
                counters.watch.enter(Phase::Shading);
            }
        }
        let code = codes.get(k).copied().unwrap_or(zero);
        let lit = wanted & !code.simd_eq(splat(BLOCKED));
        if !lit.any() {
            continue;
        }
        counters.add(Counter::LightEvaluations, 8);
        let open = F::ONE + code.at_most(zero);
        let mut light = tinted(stage, lamp, code) * (lit & (reach * open / aim.d2));
        if let Some(volume) = stage.volume.filter(|_| features::SMOKE) {
            light = light * volume.shadow(k, start, aim.way);
        }
        let hidden = if lamp.is_emitter { mirrors } else { zero };
        sum.add(stage, s, v, &aim, (light, hidden), counters);
    }
    if let Some(points) = stage.points.as_ref().filter(|_| features::POINTS) {
        points.near(start, active, stage.quality.cull, |index| {
            let Some(light) = stage.scene.points.get(index) else { return };
            counters.add(Counter::PointLights, 8);
            let aim = Aim::at(light.position, s, start);
            let x = aim.d2 * splat(1.0 / (light.radius * light.radius));
            let window = (F::ONE - x * x).at_least(zero);
            let light = V3::splat(light.colour) * (active & aim.faces & (window * window / aim.d2));
            sum.add(stage, s, v, &aim, (light, zero), counters);
        });
    }
    sum
}

/// The way from surfaces to a lamp.
struct Aim {
    way: V3,
    /// Its square length.
    d2: F,
    /// Its direction.
    l: V3,
    /// Cosine to the normal.
    n_l: F,
    /// Surfaces that face the lamp.
    faces: F,
}

impl Aim {
    #[inline(never)]
    fn at(position: Vec3, s: &Surface, start: V3) -> Aim {
        let way = V3::splat(position) - start;
        let d2 = way.dot(way).at_least(splat(1e-8));
        let l = way * (F::ONE / d2.sqrt());
        let n_l = s.normal.dot(l);
        let faces = n_l.simd_gt(F::ZERO) & s.facing.dot(l).simd_gt(F::ZERO);
        Aim { way, d2, l, n_l, faces }
    }
}

impl Lit {
    /// Adds the light of a lamp; its highlight is not seen in lanes `hidden`.
    #[inline(never)]
    fn add(
        &mut self,
        stage: &Stage,
        s: &Surface,
        v: V3,
        aim: &Aim,
        (light, hidden): (V3, F),
        counters: &mut Counters,
    ) {
        self.highlight += (light * highlight(stage, s, aim.l, v, aim.n_l, counters)) & !hidden;
        self.irradiance += light * aim.n_l;
    }
}

/// The highlight of a lamp in unit direction `l`, by the scene's reflection model.
#[inline(always)]
fn highlight(stage: &Stage, s: &Surface, l: V3, v: V3, n_l: F, counters: &mut Counters) -> V3 {
    match stage.scene.shading {
        Shading::Phong => {
            counters.add(Counter::Phong, 8);
            phong(s, l, v, n_l)
        }
        Shading::CookTorrance => {
            counters.add(Counter::CookTorrance, 8);
            cook_torrance(s, l, v, n_l)
        }
        Shading::Ggx if features::GGX => {
            counters.add(Counter::Ggx, 8);
            ggx(s, l, v) * n_l
        }
        Shading::Ggx => V3::ZERO,
    }
}

/// The lamp's colour behind the transparent shapes of each lane's code.
pub fn tinted(stage: &Stage, lamp: &Lamp, code: F) -> V3 {
    let colour = V3::splat(lamp.colour);
    if !code.simd_gt(F::ZERO).any() {
        return colour;
    }
    let lanes = code.to_array().map(|c| {
        let bits = whole(c);
        let tints = stage.tints.iter().enumerate();
        tints.fold(Vec3::ONE, |sum, (i, &tint)| if bits >> i & 1 == 1 { sum * tint } else { sum })
    });
    colour * V3::from_fn(|i| lanes[i])
}

#[cfg(test)]
mod tests;
