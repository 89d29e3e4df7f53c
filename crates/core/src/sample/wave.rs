//! Tracing a list of samples as a wavefront: all rays of one length of chain at a time, in packets
//! of eight, without recursion.
//!
//! Contributions of a sample are added in list order, and a sample's own rays keep their order in
//! any list, so its sum doesn't depend on what else is in the list.

use crate::counters::{Counter, Counters};
use crate::cull::{Region, occluders};
use crate::math::hash::mix;
use crate::math::lanes::{self, F, V3};
use crate::render::Stage;
use crate::scene::Channel;
use crate::shade::{self, Codes, MAX_LAMPS, Visibility};
use crate::trace::{Hits, NONE, Rays8, nearest, surface};
use glam::Vec3;

/// What is known of a traced sample.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Linear light.
    pub colour: Vec3,
    /// The share of `colour` that came by mirrors and glass.
    pub indirect: Vec3,
    /// Light that falls on the first surface, before its albedo, as it reaches the eye.
    pub irradiance: Vec3,
    /// Albedo of the first surface.
    pub albedo: Vec3,
    /// `colour` as it will be displayed, 0 to 1.
    pub display: Vec3,
    /// Hash of what the sample saw: shapes hit first, second and (through glass) third, with the
    /// visibility of each lamp there. Samples of equal signature see the same things.
    pub signature: u32,
    /// What the first ray hit, see [`Hits`].
    pub id: f32,
    /// Depth of the first hit along the view axis.
    pub depth: f32,
    /// First hit, world.
    pub point: Vec3,
    /// Shading normal there.
    pub normal: Vec3,
    /// Visibility of the lamps there.
    pub codes: [f32; MAX_LAMPS],
}

const UNTRACED: Sample = Sample {
    colour: Vec3::ZERO,
    indirect: Vec3::ZERO,
    irradiance: Vec3::ZERO,
    albedo: Vec3::ZERO,
    display: Vec3::ZERO,
    signature: 0,
    id: NONE,
    depth: f32::INFINITY,
    point: Vec3::ZERO,
    normal: Vec3::ZERO,
    codes: [0.0; MAX_LAMPS],
};

/// A ray on its way to a sample.
#[derive(Clone, Copy)]
struct Ray {
    origin: Vec3,
    direction: Vec3,
    /// Factor on what the ray finds.
    weight: Vec3,
    /// Width of the footprint per unit of distance.
    spread: f32,
    /// Index of the sample it belongs to.
    sample: u32,
}

/// Buffers of one thread, reused from tile to tile.
#[derive(Default)]
pub struct Scratch {
    /// Samples of the current tile.
    pub samples: Vec<Sample>,
    /// What was counted.
    pub counters: Counters,
    /// Indices into `samples` of the grid points of a tile.
    pub grid: Vec<u32>,
    rays: Vec<Ray>,
    next: Vec<Ray>,
    hits: Vec<Hits>,
    occluders: Boxes,
}

/// Bounds of the hit points of each shape in a list of rays.
#[derive(Default)]
struct Boxes(Vec<(usize, Vec3, Vec3)>);

impl Boxes {
    fn add(&mut self, shape: usize, p: Vec3) {
        match self.0.iter_mut().find(|b| b.0 == shape) {
            Some((_, lo, hi)) => (*lo, *hi) = (lo.min(p), hi.max(p)),
            None => self.0.push((shape, p, p)),
        }
    }

    /// Candidate occluders of each lamp for all the points.
    fn candidates(&self, stage: &Stage) -> [u64; MAX_LAMPS] {
        let mut masks = [0; MAX_LAMPS];
        for (mask, shafts) in masks.iter_mut().zip(&stage.shafts) {
            for &(shape, lo, hi) in &self.0 {
                // The points of secondary rays start a clearance off the surface.
                let (centre, radius) = ((lo + hi) * 0.5, (hi - lo).length() * 0.5);
                let reach = radius + centre.length() + stage.scene.camera.position.length();
                let slack = 4e-6 * reach;
                *mask |= occluders(stage.scene, shafts, Some(shape), &Region::Ball(centre, radius + slack));
            }
        }
        masks
    }
}

/// Lists with fewer packets than this are traced against all occluders: culling would cost more.
const CULL_FROM: usize = 6;

/// Traces one sample for each of `positions` (px, right and down from the picture's corner) and
/// appends them to `scratch.samples`. `candidates` must hold all shapes the first rays may hit.
pub fn trace(stage: &Stage, scratch: &mut Scratch, positions: &[Position], candidates: u64) {
    let first = scratch.samples.len();
    scratch.samples.resize(first + positions.len(), UNTRACED);
    scratch.counters.add(Counter::PrimaryRays, positions.len() as u32);

    scratch.rays.clear();
    let spread = stage.pixel;
    scratch.rays.extend(positions.iter().enumerate().map(|(i, p)| Ray {
        origin: stage.scene.camera.position,
        direction: stage.direction(p.0, p.1),
        weight: Vec3::ONE,
        spread,
        sample: (first + i) as u32,
    }));
    let mut candidates = candidates;
    for level in 0..=stage.quality.depth {
        if scratch.rays.is_empty() {
            break;
        }
        step(stage, scratch, candidates, level);
        std::mem::swap(&mut scratch.rays, &mut scratch.next);
        scratch.next.clear();
        candidates = u64::MAX;
    }
    scratch.rays.clear();
    for sample in &mut scratch.samples[first..] {
        sample.display = stage.display.map(sample.colour);
    }
}

/// A position in the picture, px from its left and upper edges.
pub type Position = (f32, f32);

/// The packet of rays that begins at `at` in a list; lanes past its end repeat its last ray.
struct Packet {
    rays: Rays8,
    weight: V3,
    spread: F,
    active: F,
    count: usize,
}

impl Packet {
    fn load(list: &[Ray], at: usize) -> Packet {
        let last = list.len() - 1;
        let lane = |i: usize| &list[(at + i).min(last)];
        let count = (list.len() - at).min(8);
        Packet {
            rays: Rays8 {
                origin: V3::from_fn(|i| lane(i).origin),
                direction: V3::from_fn(|i| lane(i).direction),
            },
            weight: V3::from_fn(|i| lane(i).weight),
            spread: F::new(std::array::from_fn(|i| lane(i).spread)),
            active: lanes::from_bits((0xff_u32 >> (8 - count)) as u8),
            count,
        }
    }
}

/// Traces `scratch.rays`, adds what they find to their samples, and appends what goes on from
/// there to `scratch.next`.
fn step(stage: &Stage, scratch: &mut Scratch, candidates: u64, level: u32) {
    let Scratch { samples, counters, rays, next, hits, occluders: boxes, .. } = scratch;
    let packets = rays.len().div_ceil(8);
    hits.clear();
    for k in 0..packets {
        let packet = Packet::load(rays, k * 8);
        hits.push(nearest(stage.scene, &packet.rays, candidates, counters));
    }

    let mut shadows = [u64::MAX; MAX_LAMPS];
    if stage.quality.cull && packets >= CULL_FROM {
        boxes.0.clear();
        for (ray, i) in rays.iter().zip(0..) {
            let hit = &hits[i / 8];
            let id = hit.id.as_array()[i % 8];
            if id >= 0.0 {
                let t = hit.t.as_array()[i % 8];
                boxes.add(id as usize >> 2, ray.origin + ray.direction * t);
            }
        }
        shadows = boxes.candidates(stage);
    }

    for (k, hit) in hits.iter().enumerate() {
        let packet = Packet::load(rays, k * 8);
        let found = shade_packet(stage, &packet, hit, level, &shadows, counters);
        let owners = &rays[k * 8..k * 8 + packet.count];
        for (lane, owner) in owners.iter().enumerate() {
            found.write(stage, lane, level, owner.direction, &mut samples[owner.sample as usize]);
        }
        if level < stage.quality.depth {
            found.spawn(stage, owners, next, counters);
        }
    }
}

/// What a packet's rays found: light for their samples, and where rays go on from.
struct Found {
    /// Weighted light, all of it.
    light: V3,
    /// Weighted light on the surface, before its albedo.
    irradiance: V3,
    albedo: V3,
    id: F,
    depth: F,
    point: V3,
    normal: V3,
    codes: Codes,
    signature: F,
    spread: F,
    mirrored: V3,
    mirrored_weight: V3,
    mirrored_start: V3,
    refracted: V3,
    refracted_weight: V3,
    refracted_start: V3,
}

/// Light that the rays of a packet find at their hits, and the rays that go on from there.
fn shade_packet(
    stage: &Stage,
    packet: &Packet,
    hit: &Hits,
    level: u32,
    shadows: &[u64; MAX_LAMPS],
    counters: &mut Counters,
) -> Found {
    let scene = stage.scene;
    let Packet { rays, active, spread, .. } = packet;
    let (spread, active) = (*spread, *active);
    let zero = V3::ZERO;
    let mut weight = packet.weight;
    let mut light = zero;
    let mut signature = F::ZERO;

    if let Some(fog) = &scene.fog {
        counters.add(Counter::FogSegments, 8);
        let (through, scattered) = shade::fog(fog, rays, hit.t);
        light += weight * scattered;
        weight = weight * through;
    }
    if level > 0 && !scene.emitters.is_empty() {
        let (shine, hidden, seen) = shade::emitters(&scene.emitters, rays, spread, hit.t);
        light += weight * shine;
        weight = weight * (F::ONE - hidden);
        signature = seen;
    }

    let solid = active & hit.id.simd_ge(F::ZERO);
    let mut id = hit.id;
    if solid.to_bitmask() != active.to_bitmask() {
        let (sky, seen) = shade::background(&scene.background, rays, spread);
        let open = active & !solid;
        light += (weight * sky) & open;
        id = open.select(seen, id);
    }
    let mut found = Found {
        light,
        irradiance: zero,
        albedo: zero,
        id,
        depth: hit.t,
        point: zero,
        normal: zero,
        codes: [F::ZERO; MAX_LAMPS],
        signature,
        spread: F::ZERO,
        mirrored: zero,
        mirrored_weight: zero,
        mirrored_start: zero,
        refracted: zero,
        refracted_weight: zero,
        refracted_start: zero,
    };
    if !solid.any() {
        return found;
    }

    let t = solid.select(hit.t, F::ZERO);
    let s = surface(scene, rays, t, solid.select(hit.id, F::splat(NONE)), spread);
    let view = -rays.direction;
    let trace = Visibility::Trace(shadows);
    let lit = shade::direct(stage, &s, view, solid, trace, &mut found.codes, counters);
    let split = shade::split(&s, rays.direction);
    let local = shade::local(stage, &s, &split, lit);
    let seen = weight & solid;
    found.albedo = s.colour(Channel::Colour);
    found.irradiance = seen * local.irradiance;
    found.light += found.irradiance * found.albedo + seen * local.rest;
    found.point = s.point;
    found.normal = s.normal;

    let facing = V3::select(s.inside, -s.outward, s.outward);
    let offset = facing * s.clearance;
    let m = s.value(Channel::Roughness);
    found.spread = spread + m * m * F::splat(3.0);
    found.mirrored = split.mirrored;
    found.mirrored_weight = seen * split.reflectance * s.value(Channel::Reflection);
    found.mirrored_start = s.point + offset;
    let entering = seen & !split.total;
    let one = V3::splat(Vec3::ONE);
    let passed = (one - split.reflectance) * s.value(Channel::Transparency);
    found.refracted = split.refracted;
    found.refracted_weight = entering * passed * s.colour(Channel::Tint);
    found.refracted_start = s.point - offset;
    found
}

impl Found {
    /// Adds one lane's light to its sample; the first hit also fills in what the sample is.
    fn write(&self, stage: &Stage, lane: usize, level: u32, direction: Vec3, sample: &mut Sample) {
        let light = self.light.lane(lane);
        sample.colour += light;
        let id = self.id.as_array()[lane];
        if level == 0 {
            sample.id = id;
            sample.irradiance = self.irradiance.lane(lane);
            sample.albedo = self.albedo.lane(lane);
            sample.depth = self.depth.as_array()[lane] * direction.dot(stage.forward());
            sample.point = self.point.lane(lane);
            sample.normal = self.normal.lane(lane);
            sample.codes = self.codes.map(|c| c.as_array()[lane]);
        } else {
            sample.indirect += light;
        }
        // Two hits deep for all, three for what is seen through glass.
        let transparent = sample.id >= 0.0 && stage.bits[sample.id as usize >> 2] > 0.0;
        if level <= 1 + transparent as u32 {
            let mut h = mix(sample.signature, id.to_bits());
            h = mix(h, self.signature.as_array()[lane] as u32);
            for code in &self.codes[..stage.lamps.len().min(MAX_LAMPS)] {
                h = mix(h, code.as_array()[lane].to_bits());
            }
            sample.signature = h;
        }
    }

    /// Appends the rays that go on, if what they may add is worth it.
    fn spawn(&self, stage: &Stage, owners: &[Ray], next: &mut Vec<Ray>, counters: &mut Counters) {
        let cutoff = F::splat(stage.quality.cutoff / stage.scene.grade.exposure);
        let worth = |w: V3| w.x.fast_max(w.y).fast_max(w.z).simd_gt(cutoff).to_bitmask();
        let (mirrors, enters) = (worth(self.mirrored_weight), worth(self.refracted_weight));
        for (lane, owner) in owners.iter().enumerate() {
            let bit = 1 << lane;
            let sample = owner.sample;
            let spread = self.spread.as_array()[lane];
            let mut push = |origin: V3, direction: V3, weight: V3| {
                next.push(Ray {
                    origin: origin.lane(lane),
                    direction: direction.lane(lane),
                    weight: weight.lane(lane),
                    spread,
                    sample,
                });
            };
            if mirrors & bit != 0 {
                counters.add(Counter::ReflectedRays, 1);
                push(self.mirrored_start, self.mirrored, self.mirrored_weight);
            }
            if enters & bit != 0 {
                counters.add(Counter::RefractedRays, 1);
                push(self.refracted_start, self.refracted, self.refracted_weight);
            }
        }
    }
}
