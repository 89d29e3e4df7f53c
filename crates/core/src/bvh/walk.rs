//! Walking a tree with eight rays at once, as the intervals that their origins and directions span.
//!
//! A box is entered no earlier than max over the axes of min((near - o) / d) over the intervals of
//! o and d, and left no later than min max((far - o) / d), near and far chosen by the sign of d;
//! an axis whose signs differ is left out. For one ray in all lanes the intervals are points and
//! this is the slab test. Rays that run together cost one test of eight boxes in place of eight.
//! What lies between the rays is covered too: so a cell of the picture asks what may show in it.
//!
//! **Rounding.** Origins are widened by 32 u of the greatest coordinate involved. A triangle that is
//! hit at t, as trace::triangle computes it, holds a point within 8 u of that from o + t d, and the lane
//! in a distance's last bits adds up to 14 u; so no box is left out, or passed over as too far, that
//! holds the nearest hit or one that equals it.
//!
//! **NaN**, from 0 times infinity where a ray runs in a face, is the first operand of a
//! minimum or maximum, which then gives the second: the axis sets no bound.

use super::{EMPTY, LEAF, LEAF_BIT, Node, Tree};
use crate::counters::{Counter, Counters};
use crate::math::lanes::{Bound, F, LANE_INDEX, LANES, greatest, least, splat, splat_u};
use crate::trace::{Across, Rays8, Slabs};

/// One ray, or rays as intervals, along an axis.
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
    /// The ray of the only lane in a mask; of more, all as a bundle.
    #[inline(never)]
    fn new(rays: &Across, lanes: u32) -> Axis {
        let Across { lo, hi, inverse } = *rays;
        let signs = inverse.to_bitmask();
        let first = lanes.trailing_zeros() as usize % LANES;
        let one = |v: F| splat(v.as_array()[first]);
        let (lo, hi, mut small, mut big) = if lanes & (lanes - 1) == 0 {
            (one(lo), one(hi), one(inverse), one(inverse))
        } else {
            (least(lo), greatest(hi), least(inverse), greatest(inverse))
        };
        if lanes & (lanes - 1) != 0 && signs != 0 && signs != 0xff {
            (small, big) = (splat(f32::NAN), splat(f32::NAN));
        }
        if signs >> first & 1 != 0 {
            Axis { backward: true, origin: [lo, hi], inverse: [big, small] }
        } else {
            Axis { backward: false, origin: [hi, lo], inverse: [small, big] }
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

/// What is done at a leaf, given its index and its number of items: a new limit comes of it. A trait of its own, as
/// the table of a `dyn FnMut` holds each closure once more, as `FnOnce`.
pub trait AtLeaf {
    /// Does so.
    fn at_leaf(&mut self, leaf: usize, count: usize, counters: &mut Counters) -> f32;
}

impl<F: FnMut(usize, usize, &mut Counters) -> f32> AtLeaf for F {
    fn at_leaf(&mut self, leaf: usize, count: usize, counters: &mut Counters) -> f32 {
        self(leaf, count, counters)
    }
}

/// A walk through a tree.
struct Walker<'a> {
    tree: &'a Tree,
    axes: &'a [Axis; 3],
    /// Distance up to which leaves are of interest.
    limit: f32,
    counters: &'a mut Counters,
    leaf: &'a mut dyn AtLeaf,
}

impl Walker<'_> {
    /// Visits a node, and then what of its children may be met before the limit: no deeper than 20 calls.
    fn visit(&mut self, mut index: usize) {
        loop {
            self.counters.add(Counter::NodeVisits, 1);
            let node = &self.tree.nodes[index];
            // What is infinitely far is not met: with a lane it would be NaN.
            let limit = splat(self.limit).at_most(splat(f32::MAX));
            let (enter, met) = node.test(self.axes, limit);
            // The lane in the last bits tells equal distances apart.
            let enter = F::from_bits(enter.to_bits() & splat_u(!7) | LANE_INDEX);
            let mut ahead = met.select(enter, splat(f32::INFINITY));
            let mut lanes = met.to_bitmask();
            loop {
                if lanes == 0 {
                    return;
                }
                let mut lane = lanes.trailing_zeros() as usize % LANES;
                if lanes & (lanes - 1) != 0 {
                    let nearest = least(ahead);
                    ahead = ahead.simd_eq(nearest).select(splat(f32::INFINITY), ahead);
                    lane = nearest.as_array()[0].to_bits() as usize % LANES;
                }
                lanes &= !(1 << lane);
                if enter.as_array()[lane] > self.limit {
                    return;
                }
                let child = node.child[lane];
                if child == EMPTY {
                    continue;
                }
                if child & LEAF_BIT != 0 {
                    let (leaf, last) = ((child & !LEAF_BIT) as usize / LEAF, child as usize % LEAF);
                    self.limit = self.leaf.at_leaf(leaf, last + 1, self.counters);
                } else if lanes == 0 {
                    index = child as usize;
                    break;
                } else {
                    self.visit(child as usize);
                }
            }
        }
    }
}

impl Tree {
    /// `rays` as the tree's boxes see them, widened for what rounding may do to where these are met.
    #[inline(never)]
    pub fn slabs(&self, rays: &Rays8) -> Slabs {
        let reach = self.bounds.lo.abs().max(self.bounds.hi.abs()).max_element();
        let room = (greatest(rays.origin.max_abs()) + splat(reach)) * splat(1.0 / 524_288.0);
        Slabs::new(rays, room)
    }

    /// Calls `leaf` with the leaves, by index and number of items, that one of the rays, or a ray between them,
    /// may meet at a distance up to `limit`: about the nearest first. It returns the new limit. If `lanes` is but
    /// one, only the ray of that counts.
    #[inline(never)]
    pub fn walk(
        &self,
        (Slabs([x, y, z]), lanes): (&Slabs, u32),
        limit: f32,
        counters: &mut Counters,
        leaf: &mut dyn AtLeaf,
    ) {
        if self.is_empty() {
            return;
        }
        let axes = [Axis::new(x, lanes), Axis::new(y, lanes), Axis::new(z, lanes)];
        Walker { tree: self, axes: &axes, limit, counters, leaf }.visit(0);
    }
}
