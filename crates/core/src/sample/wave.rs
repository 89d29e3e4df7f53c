//! Tracing a list of samples as a wavefront: all rays of one length of chain at a time, in packets
//! of eight, without recursion.
//!
//! Contributions of a sample are added in list order, and a sample's own rays keep their order in
//! any list, so its sum doesn't depend on what else is in the list.

use super::block::{Block, Samples};
use super::rays::{Packet, RayList};
use super::refine::Cell;
use super::scatter::{self, Draw, Way};
use crate::counters::{Counter, Counters};
use crate::cull::{Bounds, Region, occluders};
use crate::features;
use crate::math::hash::mix_x8;
use crate::math::lanes::{Bound, F, U, V3, splat};
use crate::math::{Vec3, whole};
use crate::render::Stage;
use crate::scene::{Channel, Shading};
use crate::shade::{self, MAX_LAMPS, Visibility};
use crate::study::Phase;
use crate::trace::{BLOCKED, Hits, NONE, Rays8, Suspects, nearest, surface};

/// Buffers of one thread, reused from tile to tile.
#[derive(Default)]
pub struct Scratch {
    /// Samples of the current tile.
    pub samples: Samples,
    /// What was counted.
    pub counters: Counters,
    /// Indices into `samples` of the grid points of a tile.
    pub grid: Vec<u32>,
    /// Cells of a tile, or pixels with the number of their additional samples.
    pub(super) cells: Vec<Cell>,
    /// Where samples are wanted.
    pub(super) positions: Vec<Position>,
    rays: RayList,
    next: RayList,
    hits: Vec<Hits>,
    occluders: Boxes,
    /// Rays that were drawn at random at the hits of a packet.
    drawn: Vec<Way>,
    /// Indices of beams.
    pub(super) beams: Vec<usize>,
}

impl Scratch {
    /// Gives each list of all of them the room that the largest of its kind has.
    pub fn even(all: &mut [Scratch]) {
        fn grow<T>(list: &mut Vec<T>, room: usize) {
            list.reserve_exact(room.saturating_sub(list.len()));
        }
        let mut most = [0; 9];
        for one in &*all {
            for (most, room) in most.iter_mut().zip(one.room()) {
                *most = room.max(*most);
            }
        }
        let [samples, grid, cells, positions, packets, hits, occluders, drawn, beams] = most;
        for one in all {
            grow(&mut one.samples.0, samples);
            grow(&mut one.grid, grid);
            grow(&mut one.cells, cells);
            grow(&mut one.positions, positions);
            grow(&mut one.rays.packets, packets);
            grow(&mut one.next.packets, packets);
            grow(&mut one.hits, hits);
            grow(&mut one.occluders.0, occluders);
            grow(&mut one.drawn, drawn);
            grow(&mut one.beams, beams);
        }
    }

    /// Elements that its lists have room for.
    fn room(&self) -> [usize; 9] {
        [
            self.samples.0.capacity(),
            self.grid.capacity(),
            self.cells.capacity(),
            self.positions.capacity(),
            // These two take turns.
            self.rays.packets.capacity().max(self.next.packets.capacity()),
            self.hits.capacity(),
            self.occluders.0.capacity(),
            self.drawn.capacity(),
            self.beams.capacity(),
        ]
    }
}

/// Bounds of the hit points of each shape in a list of rays, lane by lane.
#[derive(Default)]
struct Boxes(Vec<(f32, Bounds)>);

impl Boxes {
    /// Adds the points of a packet's hits; shapes from number `facets` on are facets of meshes.
    fn add(&mut self, points: V3, ids: F, facets: f32) {
        // The part of the shape makes no difference; facets share one box.
        let shapes = (ids * splat(0.25)).floor().at_most(splat(facets));
        let mut todo = ids.simd_ge(F::ZERO).to_bitmask();
        while todo != 0 {
            let shape = shapes.as_array()[todo.trailing_zeros() as usize];
            let own = shapes.simd_eq(splat(shape));
            todo &= !own.to_bitmask();
            let found = self.0.iter().position(|b| b.0 == shape);
            let at = found.unwrap_or(self.0.len());
            if found.is_none() {
                self.0.push((shape, Bounds::EMPTY));
            }
            self.0[at].1.add(points, own);
        }
    }

    /// What may hide each lamp from all the points.
    #[cfg_attr(luc_size, optimize(size))]
    fn suspects(&self, stage: &Stage) -> [Suspects; MAX_LAMPS] {
        let mut masks = [0; MAX_LAMPS];
        for (shape, bounds) in &self.0 {
            let Some((lo, hi)) = bounds.corners() else { continue };
            // Shadow rays start at the points as put back onto the surface, a clearance off.
            let reach = lo.abs().max(hi.abs()).length() + stage.scene.camera.position.length();
            let off = if stage.scene.fields.is_empty() { 0.0 } else { 4.0 * stage.quality.epsilon };
            let region = Region::cuboid(lo, hi, 4e-6 * reach + off);
            for (lamp, (mask, shafts)) in masks.iter_mut().zip(stage.shafts()).enumerate() {
                let own = Some(*shape as usize);
                // What may hide the middle of a lamp tells little of soft shadows.
                let soft = stage.shadow_rays(lamp) > 1 || stage.penumbra(lamp) > 0.0;
                *mask |= if soft { u64::MAX } else { occluders(stage.scene, shafts, !*mask, own, &region) };
            }
        }
        masks.map(Suspects::new)
    }
}

/// Footprint, world units, from which on what a mirrored ray hits dissolves into the scene's
/// ambient light, and how fast: it is gone one unit per gain later.
const BLUR_FROM: f32 = 0.2;
const BLUR_GAIN: f32 = 1.2;

/// Lists with fewer packets than this are traced against all occluders: culling would cost more.
const CULL_FROM: usize = 6;

/// Traces one sample for each of `scratch.positions` (px, right and down from the picture's corner) and
/// appends them to `scratch.samples`, from the start of a new block on. `candidates` must hold all
/// shapes the first rays may hit.
#[inline(never)]
pub fn trace(stage: &Stage, scratch: &mut Scratch, candidates: u64) {
    let positions = &scratch.positions;
    let first = scratch.samples.0.len();
    scratch.counters.add(Counter::PrimaryRays, positions.len());
    scratch.rays.clear();
    scratch.rays.count = positions.len();
    for (k, eight) in positions.chunks(8).enumerate() {
        let lane = |i: usize| eight[i.min(eight.len() - 1)];
        let x = F::new(std::array::from_fn(|i| lane(i).0));
        let y = F::new(std::array::from_fn(|i| lane(i).1));
        scratch.rays.packets.push(Packet {
            rays: Rays8 { origin: V3::splat(stage.scene.camera.position), direction: stage.directions(x, y) },
            weight: V3::splat(Vec3::ONE),
            spread: splat(stage.pixel),
            seed: scatter::seed(x, y),
            samples: std::array::from_fn(|i| (8 * (first + k) + i) as u32),
        });
    }
    let mut candidates = candidates;
    for level in 0..=stage.quality.depth {
        if scratch.rays.count == 0 {
            break;
        }
        scratch.counters.add_rays(scratch.rays.count);
        step(stage, scratch, candidates, level);
        std::mem::swap(&mut scratch.rays, &mut scratch.next);
        scratch.next.clear();
        candidates = u64::MAX;
    }
    for block in &mut scratch.samples.0[first..] {
        block.display = stage.display.map8(block.colour);
    }
}

/// A position in the picture, px from its left and upper edges.
pub type Position = (f32, f32);

/// Inverse sharpness of what rays with this footprint see of the sky's glows: the variance of a box.
pub(super) fn soft(stage: &Stage, spread: F) -> F {
    if features::GGX && stage.scene.shading == Shading::Ggx {
        spread * spread * splat(1.0 / 12.0)
    } else {
        F::ZERO
    }
}

/// Traces `scratch.rays`, adds what they find to their samples, and appends what goes on from
/// there to `scratch.next`.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
fn step(stage: &Stage, scratch: &mut Scratch, candidates: u64, level: u32) {
    let Scratch { samples, counters, rays, next, hits, occluders: boxes, drawn: ways, .. } = scratch;
    hits.clear();
    counters.watch.enter(Phase::Tracing);
    for packet in &rays.packets {
        hits.push(nearest(stage.scene, &stage.quality, &packet.rays, candidates, counters));
    }

    counters.watch.enter(Phase::Sampling);
    let mut suspects = [u64::MAX; MAX_LAMPS].map(Suspects::new);
    if stage.quality.cull && hits.len() >= CULL_FROM {
        boxes.0.clear();
        for (packet, hit) in rays.packets.iter().zip(hits.iter()) {
            let points = packet.rays.origin + packet.rays.direction * hit.t;
            boxes.add(points, hit.id, stage.scene.shape_count() as f32);
        }
        suspects = boxes.suspects(stage);
    }

    counters.watch.enter(Phase::Shading);
    let mut found = Found { drawn: std::mem::take(ways), ..Found::default() };
    for (k, hit) in hits.iter().enumerate() {
        let packet = &rays.packets[k];
        shade_packet(stage, packet, hit, level, &suspects, &mut found, counters);
        let owners = rays.owners(k);
        let hash = found.hash(stage);
        if level == 0 {
            found.block.surface = hash;
            found.block.direct = found.block.colour;
            samples.0.push(found.block);
        } else {
            // What drawn rays meet differs from sample to sample.
            let drawn = scatter::drawn(packet).to_bitmask();
            for (lane, &owner) in owners.iter().enumerate() {
                // Two hits deep for all, three for what is seen through glass.
                let id = samples.get(owner as usize).id();
                let shape = whole(id.max(0.0)) >> 2;
                let glass = id >= 0.0 && stage.bits.get(shape).is_some_and(|&bit| bit > 0.0);
                let deep = level == 1 || (level == 2 && glass);
                let hash = (deep && drawn >> lane & 1 == 0).then_some(hash.as_array()[lane]);
                samples.add(owner as usize, found.block.colour.lane(lane), hash);
            }
        }
        if level < stage.quality.depth {
            found.spawn(stage, owners, next, counters);
        }
    }
    *ways = found.drawn;
    counters.watch.enter(Phase::Sampling);
}

/// What a packet's rays found.
#[derive(Default)]
struct Found {
    /// The hits, and their weighted light, as samples of their own; `surface` and `direct` are left
    /// open, and `signature` holds what was seen of shining rectangles.
    block: Block,
    /// Which part of its field each lane has hit.
    part: F,
    /// Mirrored and refracted rays, which go on from the hits.
    onward: [Packet; 2],
    /// Rays that were drawn at random, before those.
    drawn: Vec<Way>,
}

/// Light that the rays of a packet find at their hits, and the rays that go on from there.
#[inline(never)]
fn shade_packet(
    stage: &Stage,
    packet: &Packet,
    hit: &Hits,
    level: u32,
    suspects: &[Suspects; MAX_LAMPS],
    found: &mut Found,
    counters: &mut Counters,
) {
    let scene = stage.scene;
    let Packet { rays, spread, seed, .. } = packet;
    let (spread, scattered, drawn) = (*spread, scatter::scattered(packet), scatter::drawn(packet));
    let zero = V3::ZERO;
    let mut weight = packet.weight;
    let mut light = zero;
    let mut signature = F::ZERO;

    if let (true, Some(volume)) = (features::SMOKE, stage.volume) {
        // Before the fog, which is mostly behind it.
        let pace = stage.quality.smoke * if level > 0 { 3.0 } else { 1.0 };
        counters.watch.enter(Phase::SmokeRender);
        let (through, glow) = volume.march(stage, rays, hit.t, pace, counters);
        counters.watch.enter(Phase::Shading);
        light += weight * glow;
        weight = weight * through;
    }
    if let Some(fog) = &scene.fog {
        counters.add(Counter::FogSegments, 8);
        let (through, scattered) = shade::fog(fog, rays, hit.t);
        light += weight * scattered;
        weight = weight * through;
    }
    if features::BEAMS && level > 0 {
        // What the eye sees of them straight is added to the finished pixels.
        counters.add(Counter::Beams, 8 * scene.beams.len());
        for beam in &scene.beams {
            light += packet.weight * shade::beam(beam, rays, spread, hit.t);
        }
    }
    if level > 0 && !scene.emitters.is_empty() && !scattered.all() {
        counters.add(Counter::EmitterTests, 8 * scene.emitters.len());
        let (shine, hidden, seen) = shade::emitters(&scene.emitters, rays, spread, hit.t);
        light += (weight * shine) & !scattered;
        weight = weight * (F::ONE - (hidden & !scattered));
        signature = seen;
    }

    let solid = hit.id.simd_ge(F::ZERO);
    let mut id = hit.id;
    if !solid.all() {
        counters.add(Counter::DiscTests, 8 * scene.background.discs.len());
        counters.add(Counter::Glows, 8 * scene.background.glows.len());
        let (sky, seen) = shade::background(&scene.background, rays, spread, soft(stage, spread), scattered);
        light += (weight * sky) & !solid;
        id = solid.select(id, seen);
    }
    if level > 0 {
        // What a rough mirror sees far off dissolves into the mean light around it.
        let width = spread * hit.t - splat(BLUR_FROM);
        let blur = (width * splat(BLUR_GAIN)).at_least(F::ZERO).at_most(F::ONE) & (solid & !drawn);
        light += weight * shade::ambient(stage, rays.direction) * blur;
        weight = weight * (F::ONE - blur);
    }
    let Found { block, part, onward, drawn: ways } = found;
    ways.clear();
    *part = F::ZERO;
    *block = Block::default();
    block.colour = light;
    block.signature = signature.to_bits();
    block.id = id;
    block.depth = hit.t * rays.direction.dot(V3::splat(stage.forward()));
    onward[0].weight = zero;
    onward[1].weight = zero;
    if !solid.any() {
        return;
    }

    let t = solid.select(hit.t, F::ZERO);
    let mut s = surface(scene, &stage.quality, rays, t, solid.select(hit.id, splat(NONE)), spread);
    if features::BOUNCES {
        // Highlights in what a bounce sees would be sparks.
        let roughness = &mut s.material[Channel::Roughness as usize];
        *roughness = roughness.at_least(scattered & F::ONE);
    }
    s.count(counters);
    let view = -rays.direction;
    let trace = Visibility::Trace(suspects);
    let lit = shade::direct(stage, &s, view, solid, trace, &mut block.codes, counters);
    let split = shade::split(scene.shading, &s, rays.direction);
    let bounces = scatter::bounces(stage, *seed, &s, level) & solid;
    let local = shade::local(stage, &s, &split, lit, (solid, bounces), counters);
    let seen = weight & solid;
    block.albedo = s.colour(Channel::Colour);
    block.irradiance = seen * local.irradiance;
    block.colour += block.irradiance * block.albedo + seen * local.rest;
    block.point = s.point;
    block.normal = s.normal;
    (block.node, *part) = (s.node, s.part);
    if features::SMOOTH {
        let facets = id.simd_ge(splat(4.0 * scene.shape_count() as f32)) & s.part.simd_ne(F::ZERO);
        counters.add(Counter::SmoothFacets, facets.to_bitmask().count_ones() as usize);
    }
    if features::IMAGES && cfg!(feature = "counters") {
        let painted = |&&id: &&f32| id >= 0.0 && scene.is_painted(whole(id) >> 2);
        counters.add(Counter::ImageLookups, id.as_array().iter().filter(painted).count());
    }

    let offset = s.facing * s.clearance;
    let m = s.value(Channel::Roughness);
    let spread = spread + m * m * splat(6.0);
    let one = V3::splat(Vec3::ONE);
    let mut reflected = seen * split.reflectance * s.value(Channel::Reflection);
    let passed = (one - split.reflectance) * s.value(Channel::Transparency);
    let mut refracted = (seen & !split.total) * passed * s.colour(Channel::Tint);
    let outside = s.point + offset;
    if bounces.any() {
        let weight = seen * local.kept * block.albedo;
        scatter::draw(stage, &s, (Draw::Bounce, level), (weight, bounces), packet, ways);
    }
    let rough = scatter::rough(stage, &s, level) & solid;
    if rough.any() {
        let weight = seen * s.value(Channel::Reflection);
        scatter::draw(stage, &s, (Draw::Mirror, level), (weight, rough), packet, ways);
        reflected = reflected & !rough;
    }
    let cut = if level == stage.quality.depth { solid } else { scattered & solid };
    if cut.any() {
        // Where the chain is cut, the mean light in place of what the rays would find.
        let mirrored = reflected * shade::ambient(stage, split.mirrored);
        let through = refracted * shade::ambient(stage, split.refracted);
        // Lanes without such a ray have no direction either.
        block.colour += (mirrored & cut) + (through & (cut & !split.total));
        (reflected, refracted) = (reflected & !cut, refracted & !cut);
    }
    onward[0].rays = Rays8 { origin: outside, direction: split.mirrored };
    onward[0].weight = reflected;
    onward[0].seed = scatter::offspring(*seed, 64);
    onward[1].seed = scatter::offspring(*seed, 65);
    onward[0].spread = spread;
    onward[1].rays = Rays8 { origin: s.point - offset, direction: split.refracted };
    onward[1].weight = refracted;
    onward[1].spread = spread;
}

impl Found {
    /// Hash of what each lane saw.
    fn hash(&self, stage: &Stage) -> U {
        let mut h = mix_x8(self.block.id.to_bits() ^ self.part.to_bits(), self.block.signature);
        for (k, code) in self.block.codes[..stage.lamps.len().min(MAX_LAMPS)].iter().enumerate() {
            // Soft shadows have no edges.
            if stage.shadow_rays(k) == 1 {
                let soft = code.simd_lt(F::ZERO) & code.simd_gt(splat(BLOCKED));
                let code = if stage.penumbra(k) > 0.0 { *code & !soft } else { *code };
                h = mix_x8(h, code.to_bits());
            }
        }
        h
    }

    /// Appends the rays that go on, if what they may add is worth it.
    #[inline(never)]
    fn spawn(&self, stage: &Stage, owners: &[u32], next: &mut RayList, counters: &mut Counters) {
        let cutoff = splat(stage.quality.cutoff / stage.scene.grade.exposure);
        let worth = |w: V3| w.x.at_least(w.y).at_least(w.z).simd_gt(cutoff).to_bitmask();
        for (lane, &sample) in owners.iter().enumerate() {
            for way in self.drawn.iter().filter(|way| way.which >> lane & 1 == 1) {
                counters.add(way.counter, 1);
                if way.counter == Counter::RoughRays {
                    counters.add(Counter::ReflectedRays, 1);
                }
                next.push(&way.rays, lane, sample);
            }
            for (rays, counter) in self.onward.iter().zip([Counter::ReflectedRays, Counter::RefractedRays]) {
                if worth(rays.weight) >> lane & 1 == 1 {
                    counters.add(counter, 1);
                    next.push(rays, lane, sample);
                }
            }
        }
    }
}
