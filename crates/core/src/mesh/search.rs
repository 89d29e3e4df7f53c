//! The nearest facet of eight rays, and whether any facet lies on them.
//!
//! Packets whose rays run close together walk the trees as one bundle, and each triangle is tested
//! against all eight; in others each ray walks alone, and the triangles of a leaf are tested at
//! once. Both do the same arithmetic per ray and triangle, so the result is the same, and the same
//! as that of testing everything: the nearest crossing, of equal ones that of the lower id.

use super::{Assembly, Leaf};
use crate::bvh::{LEAF, Stack};
use crate::counters::{Counter, Counters};
use crate::math::lanes::{F, V3, greatest, least, splat, twice};
use crate::scene::Scene;
use crate::trace::{Aim, Hits, Rays8};

/// Directions that differ by more than this part of their greatest coordinate walk alone.
const SPREAD: f32 = 0.25;

/// Rays that start further from each other than this part of their greatest coordinate, too.
const APART: f32 = 0.1;

/// Greatest coordinate that rays may have.
const FAR: f32 = 1e18;

fn size(v: V3) -> F {
    v.x.abs().fast_max(v.y.abs()).fast_max(v.z.abs())
}

/// Greatest difference of a coordinate between lanes.
fn spread(v: V3) -> F {
    let range = |x: F| greatest(x) - least(x);
    range(v.x).fast_max(range(v.y)).fast_max(range(v.z))
}

/// Takes over the crossing of triangles `id` where it comes before the best so far. What is looked
/// for is the nearest, or any: then a hit ends the ray, at -1.
#[inline(always)]
fn cross(aim: &Aim, corners: [V3; 3], id: F, any: bool, best: &mut Hits) {
    let crossing = aim.cross(corners);
    let nearer = crossing.t.simd_lt(best.t) | (crossing.t.simd_eq(best.t) & id.simd_lt(best.id));
    let closer = crossing.hit & crossing.t.simd_gt(F::ZERO) & nearer;
    let t = if any { splat(-1.0) } else { crossing.t };
    best.t = closer.select(t, best.t);
    best.id = closer.select(id, best.id);
}

/// Tests the triangles of a leaf; `first` is the id of the mesh's first.
#[inline(never)]
fn leaf(aim: &Aim, leaf: &Leaf, first: f32, (single, any): (bool, bool), best: &mut Hits) {
    let tests = if single { 1 } else { LEAF };
    for k in 0..tests {
        let row = |i: usize| if single { twice(&leaf[i]) } else { splat(leaf[i][k]) };
        let corner = |i: usize| V3::new(row(3 * i), row(3 * i + 1), row(3 * i + 2));
        let id = splat(first) + row(9);
        if id.simd_eq(id).any() {
            cross(aim, [corner(0), corner(1), corner(2)], id, any, best);
        }
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
        let sound = size(rays.origin).simd_lt(splat(FAR)) & size(rays.direction).simd_lt(splat(FAR));
        let lanes = (wanted & sound).to_bitmask();
        if lanes == 0 || self.is_empty() {
            return;
        }
        // Lanes that aren't asked about run with the first that is.
        let some = lanes.trailing_zeros() as usize;
        let asked = wanted & sound;
        let lane = |i: usize| Rays8 {
            origin: V3::splat(rays.origin.lane(i)),
            direction: V3::splat(rays.direction.lane(i)),
        };
        let other = lane(some);
        let all = Rays8 {
            origin: V3::select(asked, rays.origin, other.origin),
            direction: V3::select(asked, rays.direction, other.direction),
        };
        let close = spread(all.direction).simd_lt(greatest(size(all.direction)) * splat(SPREAD))
            & spread(all.origin).simd_lt(greatest(size(all.origin)) * splat(APART));
        if close.all() {
            let mut found = *best;
            found.t = asked.select(best.t, splat(best.t.as_array()[some]));
            self.walk(scene, &all, (false, any), &mut found, counters);
            best.t = asked.select(found.t, best.t);
            best.id = asked.select(found.id, best.id);
            return;
        }
        for i in (0..8).filter(|i| lanes >> i & 1 == 1) {
            let (t, id) = (best.t.as_array()[i], best.id.as_array()[i]);
            let mut found = Hits { t: splat(t), id: splat(id) };
            self.walk(scene, &lane(i), (true, any), &mut found, counters);
            let (ts, ids) = (found.t.to_array(), found.id.to_array());
            let (mut t, mut id) = (t, id);
            for k in 0..LEAF {
                if ts[k] < t || (ts[k] == t && ids[k] < id) {
                    (t, id) = (ts[k], ids[k]);
                }
            }
            best.t.as_mut_array()[i] = t;
            best.id.as_mut_array()[i] = id;
        }
    }

    fn walk(
        &self,
        scene: &Scene,
        rays: &Rays8,
        mode: (bool, bool),
        best: &mut Hits,
        counters: &mut Counters,
    ) {
        let (single, any) = mode;
        let base = 4.0 * scene.shape_count() as f32;
        // Beyond which distance no hit counts any more.
        let limit = |best: &Hits| {
            let t = if single { least(best.t) } else { greatest(best.t) };
            t.as_array()[0]
        };
        self.tree.walk(rays, limit(best), &mut Stack::new(), counters, &mut |item, stack, counters| {
            let instance = &self.instances[self.tree.leaves[item as usize][0] as usize];
            if any && scene.materials[instance.material].is_transparent() {
                return limit(best);
            }
            let mesh = instance.mesh();
            let local = instance.local(rays);
            let aim = Aim::new(&local);
            let [first, _] = instance.ids(base);
            mesh.tree.walk(&local, limit(best), stack, counters, &mut |item, _, counters| {
                counters.add(Counter::FacetTests, if single { LEAF } else { 8 * LEAF });
                leaf(&aim, &mesh.leaves[item as usize], first, mode, best);
                limit(best)
            });
            limit(best)
        });
    }
}
