//! The nearest facet of eight rays, and whether any facet lies on them.
//!
//! Packets whose rays run close together walk the trees as one bundle, and each triangle is tested
//! against all eight; in others each ray walks alone, and the triangles of a leaf are tested at
//! once. Both do the same arithmetic per ray and triangle, so the result is the same, and the same
//! as that of testing everything: the nearest crossing, of equal ones that of the lower id.

use super::{Assembly, gather};
use crate::bvh::Stack;
use crate::counters::{Counter, Counters};
use crate::math::lanes::{Bound, F, LANES, V3, greatest, least, splat};
use crate::scene::Scene;
use crate::trace::{Aim, Hits, Rays8};

/// Directions that differ by more than this part of their greatest coordinate walk alone.
const SPREAD: f32 = 0.25;

/// Rays that start further from each other than this part of their greatest coordinate, too.
const APART: f32 = 0.1;

/// Greatest coordinate that rays may have.
const FAR: f32 = 1e18;

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
    /// Moves the hits of `rays` to nearer facets, in lanes `wanted`; or, if any facet will do,
    /// their distance to -1 where one comes before them.
    ///
    /// Facets' ids follow those of the scene's other shapes. Facets of glass hide nothing.
    #[inline(never)]
    pub fn search(
        &self,
        scene: &Scene,
        rays: &Rays8,
        wanted: F,
        any: bool,
        best: &mut Hits,
        counters: &mut Counters,
    ) {
        let asked =
            wanted & rays.origin.max_abs().simd_lt(splat(FAR)) & rays.direction.max_abs().simd_lt(splat(FAR));
        let mut todo = asked.to_bitmask();
        if todo == 0 || self.is_empty() {
            return;
        }
        // Lanes that aren't asked about run with the first that is.
        let first = todo.trailing_zeros() as usize & 7;
        let one = |v: V3, lane: usize| V3::splat(v.lane(lane));
        let bundle = Rays8 {
            origin: V3::select(asked, rays.origin, one(rays.origin, first)),
            direction: V3::select(asked, rays.direction, one(rays.direction, first)),
        };
        let close = spread(bundle.direction).simd_lt(greatest(bundle.direction.max_abs()) * splat(SPREAD))
            & spread(bundle.origin).simd_lt(greatest(bundle.origin.max_abs()) * splat(APART));
        let single = !close.all();
        while todo != 0 {
            let first = todo.trailing_zeros() as usize & 7;
            let of_first = |v: F| splat(v.as_array()[first]);
            let mut found = Hits { t: of_first(best.t), id: of_first(best.id) };
            if single {
                let ray = Rays8 { origin: one(rays.origin, first), direction: one(rays.direction, first) };
                self.walk(scene, &ray, (true, any), &mut found, counters);
                todo &= todo - 1;
            } else {
                found = Hits { t: asked.select(best.t, found.t), id: asked.select(best.id, found.id) };
                self.walk(scene, &bundle, (false, any), &mut found, counters);
                todo = 0;
            }
            for k in 0..LANES {
                let lane = if single { first } else { k };
                let (t, id) = (found.t.as_array()[k], found.id.as_array()[k]);
                let (t_best, id_best) = (&mut best.t.as_mut_array()[lane], &mut best.id.as_mut_array()[lane]);
                let counts = single || asked.to_bitmask() >> k & 1 == 1;
                if counts && (t < *t_best || (t == *t_best && id < *id_best)) {
                    (*t_best, *id_best) = (t, id);
                }
            }
        }
    }

    fn walk(
        &self,
        scene: &Scene,
        rays: &Rays8,
        (single, any): (bool, bool),
        best: &mut Hits,
        counters: &mut Counters,
    ) {
        let base = 4.0 * scene.shape_count() as f32;
        // Beyond which distance no hit counts any more.
        let limit = |best: &Hits| {
            let t = if single { least(best.t) } else { greatest(best.t) };
            t.as_array()[0]
        };
        self.tree.walk(rays, limit(best), &mut Stack::new(), counters, &mut |items, stack, counters| {
            let instance = &self.instances[items[0] as usize];
            if any && scene.materials[instance.material].is_transparent() {
                return limit(best);
            }
            let mesh = instance.mesh();
            let local = instance.local(rays);
            let aim = Aim::new(&local);
            let [first, _] = instance.ids(base);
            mesh.tree.walk(&local, limit(best), stack, counters, &mut |items, _, counters| {
                counters.add(Counter::FacetTests, items.len() * if single { 1 } else { LANES });
                if single {
                    // All of the leaf at once; the last lanes repeat its last.
                    let last = items.len() - 1;
                    let index = std::array::from_fn(|lane| items[lane.min(last)] as usize);
                    let id = splat(first) + F::new(index.map(|i| 4.0 * i as f32));
                    keep(&aim, &gather(&mesh.triangles, index), id, any, best);
                    return limit(best);
                }
                for &item in items {
                    let corners = mesh.triangles[item as usize].map(V3::splat);
                    keep(&aim, &corners, splat(first + 4.0 * item as f32), any, best);
                }
                limit(best)
            });
            limit(best)
        });
    }
}
