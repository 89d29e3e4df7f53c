//! The nearest facet of eight rays, and whether any facet lies on them.
//!
//! Packets whose rays run close together walk the tree of instances as one bundle, and so the trees of
//! meshes whose triangles are not small beside it: there each triangle is tested against all eight. Else
//! each ray walks alone, and the triangles of a leaf are tested at once. Both do the same arithmetic per
//! ray and triangle, so the result is the same, and the same as that of testing everything: the nearest
//! crossing, of equal ones that of the lower id.

use super::{Assembly, Mesh, gather};
use crate::bvh::Stack;
use crate::counters::{Counter, Counters};
use crate::math::lanes::{Bound, F, INFINITY, LANES, V3, greatest, least, splat};
use crate::math::number;
use crate::scene::Scene;
use crate::trace::{Aim, Hits, Rays8};

/// Directions that differ by more than this part of their greatest coordinate walk alone.
const SPREAD: f32 = 0.25;

/// Rays that start further from each other than this part of their greatest coordinate, too.
const APART: f32 = 0.1;

/// Rays too that are so far apart in a mesh that their square is more than so many of its triangles.
const COARSE: f32 = 5.0;

/// Greatest coordinate that rays may have.
const FAR: f32 = 1e18;

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

impl Mesh {
    /// Whether rays in its space, as far apart as about its middle, mostly meet the same triangles.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn is_coarse_for(&self, rays: &Rays8) -> bool {
        let bounds = self.tree.bounds;
        let away =
            (V3::splat((bounds.lo + bounds.hi) * 0.5) - rays.origin).max_abs() / rays.direction.max_abs();
        let apart = spread(rays.origin) + spread(rays.direction) * away;
        (apart * apart).simd_lt(splat(COARSE * bounds.area() / number(self.triangles.len()))).all()
    }
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
        // Lanes that aren't asked about run with the first that is, and find nothing.
        let first = rays.alone(todo);
        let bundle = Rays8 {
            origin: V3::select(asked, rays.origin, first.origin),
            direction: V3::select(asked, rays.direction, first.direction),
        };
        let mut found = Hits { t: asked.select(best.t, splat(-1.0)), id: best.id };
        let close = spread(bundle.direction).simd_lt(greatest(bundle.direction.max_abs()) * splat(SPREAD))
            & spread(bundle.origin).simd_lt(greatest(bundle.origin.max_abs()) * splat(APART));
        let stack = &mut Stack::new();
        while todo != 0 {
            let lowest = todo & todo.wrapping_neg();
            let (rays, lanes) = if close.all() { (bundle, todo) } else { (rays.alone(todo), lowest) };
            self.walk(scene, (&rays, lanes), any, &mut found, stack, counters);
            todo &= !lanes;
        }
        best.t = asked.select(found.t, best.t);
        best.id = asked.select(found.id, best.id);
    }

    /// Does so for `rays` as one bundle, in lanes `lanes`; if that is one lane, for its ray in all of them.
    fn walk(
        &self,
        scene: &Scene,
        (rays, lanes): (&Rays8, u32),
        any: bool,
        best: &mut Hits,
        stack: &mut Stack,
        counters: &mut Counters,
    ) {
        let base = 4.0 * number(scene.shape_count());
        let single = lanes & (lanes - 1) == 0;
        // Beyond which distance no hit counts any more.
        let limit = |best: &Hits| {
            if single { best.t.as_array()[lane_of(lanes)] } else { greatest(best.t).as_array()[0] }
        };
        self.tree.walk((rays, single), limit(best), stack, counters, &mut |items, stack, counters| {
            let instance = &self.instances[items[0] as usize];
            if any && scene.materials[instance.material].is_transparent() {
                return limit(best);
            }
            let mesh = instance.mesh();
            let local = instance.local(rays);
            let [first, _] = instance.ids(base);
            let mut rest = lanes;
            let together = !single && mesh.is_coarse_for(&local);
            while rest != 0 {
                let lane = lane_of(rest);
                let one = |v: F| splat(v.as_array()[lane]);
                let (ray, mut found) = if together {
                    (local, *best)
                } else {
                    (local.alone(rest), Hits { t: one(best.t), id: one(best.id) })
                };
                let aim = Aim::new(&ray);
                let reach =
                    |found: &Hits| if together { greatest(found.t) } else { least(found.t) }.as_array()[0];
                mesh.tree.walk(
                    (&ray, !together),
                    reach(&found),
                    stack,
                    counters,
                    &mut |items, _, counters| {
                        counters.add(Counter::FacetTests, items.len() * if together { LANES } else { 1 });
                        if together {
                            for &item in items {
                                let corners = mesh.triangles[item as usize].map(V3::splat);
                                keep(&aim, &corners, splat(first + 4.0 * item as f32), any, &mut found);
                            }
                        } else {
                            // All of the leaf at once; lanes that are left repeat its first.
                            let mut id = splat(number(items[0] as usize));
                            for (id, &item) in id.as_mut_array().iter_mut().zip(items) {
                                *id = number(item as usize);
                            }
                            let id = splat(first) + id * splat(4.0);
                            keep(&aim, &gather(&mesh.triangles, items), id, any, &mut found);
                        }
                        reach(&found)
                    },
                );
                if together {
                    *best = found;
                    break;
                }
                let nearest = least(found.t);
                best.t.as_mut_array()[lane] = nearest.as_array()[0];
                let id = found.t.simd_eq(nearest).select(found.id, INFINITY);
                best.id.as_mut_array()[lane] = least(id).as_array()[0];
                rest &= rest - 1;
            }
            limit(best)
        });
    }
}
