//! Walking a tree with eight rays at once, as the intervals that their origins and directions span.
//!
//! A box is entered no earlier than max over the axes of min((near - o) / d) over the intervals of
//! o and d, and left no later than min max((far - o) / d), near and far chosen by the sign of d;
//! an axis whose signs differ is left out. For one ray in all lanes the intervals are points and
//! this is the slab test. Rays that run together cost one test of eight boxes in place of eight.
//! What lies between the rays is covered too: so a cell of the picture asks what may show in it.
//!
//! **Rounding.** Origins are widened by 16 u of the greatest coordinate involved. A triangle that is
//! hit at t, as trace::triangle computes it, holds a point within 8 u of that from o + t d; so no
//! box is left out, or passed over as too far, that holds the nearest hit or one that equals it.
//!
//! **NaN**, from 0 times infinity where a ray runs in a face, is the first operand of a
//! minimum or maximum, which then gives the second: the axis sets no bound.

use super::{EMPTY, LEAF_BIT, Node, Tree, range};
use crate::counters::{Counter, Counters};
use crate::math::Vec3;
use crate::math::lanes::{Bound, F, INFINITY, LANE_INDEX, greatest, least, splat, splat_u};
use crate::trace::Rays8;

/// Rays as intervals, along one axis.
#[derive(Clone, Copy)]
struct Axis {
    /// Whether the plane hi comes first, not lo.
    backward: bool,
    /// Origins that meet the near plane first, and the far plane last.
    origin: [F; 2],
    /// 1/d, of the smallest and of the greatest size.
    inverse: [F; 2],
}

impl Axis {
    #[inline(never)]
    fn new(origin: F, direction: F, room: F, single: bool) -> Self {
        let signs = direction.to_bitmask() as u8;
        let inverse = F::ONE / direction;
        let range = |v: F| if single { (v, v) } else { (least(v), greatest(v)) };
        let ((lo, hi), (small, big)) = (range(origin), range(inverse));
        let (lo, hi) = (lo - room, hi + room);
        match signs {
            0 => Self { backward: false, origin: [hi, lo], inverse: [small, big] },
            0xff => Self { backward: true, origin: [lo, hi], inverse: [big, small] },
            _ => Self { backward: false, origin: [lo; 2], inverse: [splat(f32::NAN); 2] },
        }
    }
}

impl Node {
    /// From which distance on each box may be met, and the mask of those met before `limit`.
    #[inline(always)]
    fn test(&self, axes: &[Axis; 3], limit: F) -> (F, F) {
        let (mut enter, mut exit) = (F::ZERO, limit);
        let mut cut = |axis: &Axis, planes: &[F]| {
            let near = planes[usize::from(axis.backward)] - axis.origin[0];
            let far = planes[usize::from(!axis.backward)] - axis.origin[1];
            // One end of 1/d does: what it gives wrongly for a plane behind the origins is below 0 either way.
            enter = (near * axis.inverse[0]).at_least(enter);
            exit = (far * axis.inverse[1]).at_most(exit);
        };
        cut(&axes[0], &self.bounds[..2]);
        cut(&axes[1], &self.bounds[2..4]);
        cut(&axes[2], &self.bounds[4..]);
        (enter, enter.simd_le(exit))
    }
}

/// A walk through a tree.
struct Walker<'a> {
    tree: &'a Tree,
    axes: &'a [Axis; 3],
    /// Distance up to which leaves are of interest.
    limit: f32,
    counters: &'a mut Counters,
    leaf: &'a mut dyn FnMut(&[u32], &mut Counters) -> f32,
}

impl Walker<'_> {
    /// Visits a node, and then what of its children may be met before the limit: no deeper than 20 calls.
    fn visit(&mut self, node: usize) {
        self.counters.add(Counter::NodeVisits, 1);
        let node = &self.tree.nodes[node];
        // What is infinitely far is not met: with a lane it would be NaN.
        let limit = splat(self.limit).at_most(splat(f32::MAX));
        let (enter, met) = node.test(self.axes, limit);
        // The lane in the last bits tells equal distances apart.
        let enter = F::from_bits(enter.to_bits() & splat_u(!7) | LANE_INDEX);
        let mut ahead = met.select(enter, INFINITY);
        loop {
            let nearest = least(ahead);
            let from = nearest.as_array()[0];
            if from > self.limit || from == f32::INFINITY {
                return;
            }
            ahead = ahead.simd_eq(nearest).select(INFINITY, ahead);
            let child = node.child[from.to_bits() as usize & 7];
            if child == EMPTY {
                continue;
            }
            if child & LEAF_BIT != 0 {
                self.limit = (self.leaf)(&self.tree.order[range(child)], self.counters);
            } else {
                self.visit(child as usize);
            }
        }
    }
}

impl Tree {
    /// How far boxes must be widened for `rays`, for what rounding may do to where these meet them.
    fn room(&self, rays: &Rays8) -> f32 {
        let reach = self.bounds.lo.abs().max(self.bounds.hi.abs()).max_element();
        (greatest(rays.origin.max_abs()).as_array()[0] + reach) * (1.0 / 1_048_576.0)
    }

    /// Where each of `rays` enters and leaves the box around all, up to `end`: see [`Rays8::in_box`]. Outside
    /// of that a ray meets nothing of the tree.
    #[inline(always)]
    pub fn span(&self, rays: &Rays8, end: F) -> (F, F) {
        let room = Vec3::splat(self.room(rays));
        rays.in_box(self.bounds.lo - room, self.bounds.hi + room, end)
    }

    /// Calls `leaf` with the leaves that one of `rays`, or a ray between them, may meet at a
    /// distance up to `limit`: about the nearest first. It returns the new limit. Of a `single` ray, in all
    /// lanes, no range is to be sought.
    #[inline(never)]
    pub fn walk(
        &self,
        (rays, single): (&Rays8, bool),
        limit: f32,
        counters: &mut Counters,
        leaf: &mut dyn FnMut(&[u32], &mut Counters) -> f32,
    ) {
        if self.is_empty() {
            return;
        }
        let Rays8 { origin: o, direction: d } = rays;
        let room = splat(self.room(rays));
        let axis = |o: F, d: F| Axis::new(o, d, room, single);
        let axes = [axis(o.x, d.x), axis(o.y, d.y), axis(o.z, d.z)];
        Walker { tree: self, axes: &axes, limit, counters, leaf }.visit(0);
    }
}
