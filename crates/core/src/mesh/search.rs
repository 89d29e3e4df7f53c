//! The nearest facet of eight rays, and whether any facet lies on them.
//!
//! Packets whose rays run in about one direction walk the tree of instances as one bundle, and so the trees of
//! meshes whose triangles are not small beside it: there each triangle is tested against all eight. Else
//! each ray walks alone, and the triangles of a leaf are tested at once. Both do the same arithmetic per
//! ray and triangle, so the result is the same, and the same as that of testing everything: the nearest
//! crossing, of equal ones that of the lower id.

use super::Assembly;
use crate::bvh::Bounds;
use crate::counters::{Counter, Counters};
use crate::math::lanes::{Bound, F, INFINITY, LANES, U, V3, greatest, least, splat};
use crate::math::{number, whole};
use crate::scene::Scene;
use crate::trace::{Aim, Hits, Rays8, Slabs};
use std::cell::Cell;

/// Directions that differ by more than this part of their greatest coordinate walk alone.
const SPREAD: f32 = 0.25;

/// Rays too that are so far apart at a mesh that their square is more than so many of its triangles.
const COARSE: f32 = 12.0;

/// Greatest square of an origin's or a direction's length.
const FAR: f32 = 1e36;

/// Hit ids of the facets that hid a lamp from points nearby, the latest first; below 0 for none.
pub type Blockers = Cell<[f32; 4]>;

/// The lowest lane of a mask.
fn lane_of(lanes: u32) -> usize {
    lanes.trailing_zeros() as usize & 7
}

/// Greatest difference of a coordinate between lanes.
#[inline(never)]
fn spread(v: V3) -> F {
    let range = |x: F| greatest(x) - least(x);
    range(v.x).at_least(range(v.y)).at_least(range(v.z))
}

/// Takes over the crossings that come before the best so far. What is looked for is the nearest,
/// or any: then a hit ends the ray, at -1.
#[inline(never)]
fn keep(aim: &Aim, corners: &[V3; 3], id: F, any: bool, best: &mut Hits) {
    let Some(crossing) = aim.cross(corners) else { return };
    let nearer = crossing.t.simd_lt(best.t) | (crossing.t.simd_eq(best.t) & id.simd_lt(best.id));
    let closer = crossing.hit & crossing.t.simd_gt(F::ZERO) & nearer;
    let t = if any { splat(-1.0) } else { crossing.t };
    best.t = closer.select(t, best.t);
    best.id = closer.select(id, best.id);
}

impl Assembly {
    /// Moves the hits of `rays` to nearer facets, in lanes `wanted`; or, if `blockers` are given, their
    /// distance to -1 where any facet comes before them: those are tested first, and get what was found.
    ///
    /// Facets' ids follow those of the scene's other shapes. Facets of glass hide nothing.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn search(
        &self,
        scene: &Scene,
        rays: &Rays8,
        wanted: F,
        blockers: Option<&Blockers>,
        best: &mut Hits,
        counters: &mut Counters,
    ) {
        if self.is_empty() {
            return;
        }
        let Bounds { lo, hi } = self.tree.bounds;
        let (enter, exit) = self.tree.slabs(rays).span(lo, hi, best.t);
        let asked = wanted
            & enter.simd_le(exit)
            // Not so for NaN.
            & rays.origin.dot(rays.origin).simd_lt(splat(FAR))
            & rays.direction.dot(rays.direction).simd_lt(splat(FAR));
        if !asked.any() {
            return;
        }
        let mut found = Hits { t: asked.select(best.t, splat(-1.0)), id: best.id };
        let known = blockers.map_or([-1.0; 4], Cell::get);
        for id in known.into_iter().take_while(|&id| id >= 0.0) {
            let (instance, facet) = self.facet((whole(id) >> 2) - scene.shape_count());
            let corners = instance.mesh().triangles[facet].map(V3::splat);
            counters.add(Counter::FacetTests, LANES);
            keep(&Aim::new(&instance.local(rays)), &corners, splat(id), true, &mut found);
        }
        let open = found.t.simd_gt(F::ZERO);
        let mut todo = open.to_bitmask();
        if todo != 0 {
            // Lanes that nothing is asked about run with the first that is, and find nothing.
            let first = rays.alone(todo);
            let bundle = Rays8 {
                origin: V3::select(open, rays.origin, first.origin),
                direction: V3::select(open, rays.direction, first.direction),
            };
            let spreads = (spread(bundle.origin), spread(bundle.direction));
            let near = greatest(bundle.direction.max_abs()) * splat(SPREAD);
            let close = spreads.1.simd_lt(near).all();
            let slabs = self.tree.slabs(&bundle);
            while todo != 0 {
                let lanes = if close { todo } else { todo & todo.wrapping_neg() };
                self.walk(scene, (&bundle, &slabs, spreads), lanes, blockers.is_some(), &mut found, counters);
                todo &= !lanes;
            }
        }
        let hidden = (open & found.t.simd_lt(F::ZERO)).to_bitmask();
        if let (Some(blockers), true) = (blockers, hidden != 0) {
            let [a, b, c, _] = known;
            blockers.set([found.id.as_array()[lane_of(hidden)], a, b, c]);
        }
        best.t = asked.select(found.t, best.t);
        best.id = asked.select(found.id, best.id);
    }

    /// Does so for the rays of `lanes`: as one bundle, if those are more than one.
    fn walk(
        &self,
        scene: &Scene,
        (rays, slabs, spreads): (&Rays8, &Slabs, (F, F)),
        lanes: u32,
        any: bool,
        best: &mut Hits,
        counters: &mut Counters,
    ) {
        let base = 4.0 * number(scene.shape_count());
        let single = lanes & (lanes - 1) == 0;
        // Beyond which distance no hit counts any more.
        let limit = |best: &Hits| {
            if single { best.t.as_array()[lane_of(lanes)] } else { greatest(best.t).as_array()[0] }
        };
        self.tree.walk(
            (slabs, lanes),
            limit(best),
            counters,
            &mut |leaf: usize, _: usize, counters: &mut Counters| {
                let instance = &self.instances[self.tree.leaves[leaf][0] as usize];
                if any && scene.materials[instance.material].is_transparent() {
                    return limit(best);
                }
                let mesh = instance.mesh();
                let local = instance.local(rays);
                let [first, _] = instance.ids(base);
                let slabs = mesh.tree.slabs(&local);
                let Bounds { lo, hi } = mesh.tree.bounds;
                let (enter, exit) = slabs.span(lo, hi, best.t);
                let mut rest = lanes & enter.simd_le(exit).to_bitmask();
                if rest == 0 {
                    return limit(best);
                }
                let apart = spreads.0 + spreads.1 * least(enter);
                let together = !single && (apart * apart).simd_lt(splat(COARSE * instance.grain)).all();
                let all = Aim::new(&local);
                while rest != 0 {
                    let lane = lane_of(rest);
                    let one = |v: F| splat(v.as_array()[lane]);
                    let own;
                    let (aim, lanes, mut found) = if together {
                        (&all, rest, *best)
                    } else {
                        own = all.alone(lane);
                        (&own, rest & rest.wrapping_neg(), Hits { t: one(best.t), id: one(best.id) })
                    };
                    let reach = |found: &Hits| {
                        if together { greatest(found.t) } else { least(found.t) }.as_array()[0]
                    };
                    mesh.tree.walk(
                        (&slabs, lanes),
                        reach(&found),
                        counters,
                        &mut |leaf: usize, count: usize, counters: &mut Counters| {
                            counters.add(Counter::FacetTests, count * if together { LANES } else { 1 });
                            let (corners, items) = (&mesh.leaves[leaf], &mesh.tree.leaves[leaf]);
                            if together {
                                let [a, b, c] = corners;
                                for (i, &item) in items[..count].iter().enumerate() {
                                    let one = |p: &V3| V3::splat(p.lane(i));
                                    let id = splat(first + 4.0 * item as f32);
                                    keep(aim, &[one(a), one(b), one(c)], id, any, &mut found);
                                }
                            } else {
                                // All of the leaf at once.
                                let items = F::from_i32x8(U::new(*items).cast_signed());
                                keep(aim, corners, splat(first) + items * splat(4.0), any, &mut found);
                            }
                            reach(&found)
                        },
                    );
                    rest &= !lanes;
                    if together {
                        *best = found;
                    } else {
                        let nearest = least(found.t);
                        best.t.as_mut_array()[lane] = nearest.as_array()[0];
                        let id = found.t.simd_eq(nearest).select(found.id, INFINITY);
                        best.id.as_mut_array()[lane] = least(id).as_array()[0];
                    }
                }
                limit(best)
            },
        );
    }
}
