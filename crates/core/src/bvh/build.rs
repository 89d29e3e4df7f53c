//! Building a tree: binned surface area heuristic (Wald 2007), straight into nodes of eight.
//!
//! A node's items are cut in two at the plane, of sixteen along each axis, with the least
//! area times count on both sides; then the largest part is cut again, until there are eight.
//! Ties go to the first axis and plane, so a tree follows from its boxes alone. The subtrees of
//! the root are built in parallel and joined in order.

use super::{Bounds, EMPTY, LEAF, LEAF_BIT, Node, Tree};
use crate::math::lanes::{LANES, ZERO};
use crate::math::number;
use crate::parallel;

/// Planes tried along an axis, and one.
const BINS: usize = 16;

/// Depth from which on parts are halved by count, so that any tree ends: with 2^30 items at depth
/// 20.
const DEEP: usize = 10;

/// Some of the items: a range of their order, and the box around them.
#[derive(Clone, Copy)]
struct Part {
    from: usize,
    to: usize,
    bounds: Bounds,
}

struct Builder<'a> {
    boxes: &'a [Bounds],
    leaf: usize,
}

impl Tree {
    /// A tree over the items with these boxes, at most `leaf` (up to [`LEAF`]) in a leaf. Items
    /// whose box isn't finite are left out.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn build(boxes: &[Bounds], leaf: usize) -> Tree {
        let mut order: Vec<u32> =
            (0..boxes.len() as u32).filter(|&i| boxes[i as usize].is_finite()).collect();
        let builder = Builder { boxes, leaf };
        let mut tree = Tree { bounds: builder.around(&order), ..Tree::default() };
        if order.is_empty() {
            return tree;
        }
        let (parts, count) = builder.parts(&mut order, 0);
        let mut subtrees: [(Vec<Node>, u32); LANES] = Default::default();
        let mut rest = &mut order[..];
        let work = parts[..count].iter().zip(&mut subtrees).map(|(part, subtree)| {
            let (own, others) = std::mem::take(&mut rest).split_at_mut(part.to - part.from);
            rest = others;
            (own, subtree, part.from)
        });
        parallel::each(work, |_, (own, subtree, from)| {
            subtree.1 = builder.child(&mut subtree.0, own, from, 1);
        });

        tree.nodes.push(Node::NONE);
        for (lane, part) in parts[..count].iter().enumerate() {
            let (nodes, child) = &mut subtrees[lane];
            let before = tree.nodes.len() as u32;
            let leaves = &mut tree.leaves;
            let mut moved = |child: u32| {
                if child == EMPTY {
                    child
                } else if child & LEAF_BIT == 0 {
                    child + before
                } else {
                    let (from, last) = ((child & !LEAF_BIT) as usize / LEAF, child as usize % LEAF);
                    let items = &order[from..=from + last];
                    leaves.push(std::array::from_fn(|i| items[i.min(last)]));
                    LEAF_BIT | ((leaves.len() - 1) * LEAF + last) as u32
                }
            };
            for child in nodes.iter_mut().flat_map(|node| &mut node.child) {
                *child = moved(*child);
            }
            let child = moved(*child);
            tree.nodes[0].set(lane, part.bounds, child);
            tree.nodes.append(nodes);
        }
        tree
    }
}

impl Node {
    const NONE: Node = Node { bounds: [ZERO; 6], child: [EMPTY; LANES] };
}

impl Builder<'_> {
    fn around(&self, order: &[u32]) -> Bounds {
        order.iter().fold(Bounds::NOTHING, |b, &i| b.union(self.boxes[i as usize]))
    }

    /// Makes a leaf, or a node with all that is under it, of the items from number `from` on.
    #[inline(never)]
    fn child(&self, nodes: &mut Vec<Node>, order: &mut [u32], from: usize, depth: usize) -> u32 {
        if order.len() <= self.leaf {
            return LEAF_BIT | (from * LEAF + order.len() - 1) as u32;
        }
        let index = nodes.len();
        nodes.push(Node::NONE);
        let (parts, count) = self.parts(order, depth);
        for (lane, part) in parts[..count].iter().enumerate() {
            let child = self.child(nodes, &mut order[part.from..part.to], from + part.from, depth + 1);
            nodes[index].set(lane, part.bounds, child);
        }
        index as u32
    }

    /// Cuts items into up to eight parts, in order.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn parts(&self, order: &mut [u32], depth: usize) -> ([Part; LANES], usize) {
        let mut parts = [Part { from: 0, to: order.len(), bounds: self.around(order) }; LANES];
        let mut count = 1;
        while count < LANES {
            let (mut largest, mut at) = (-1.0, LANES);
            for (i, part) in parts[..count].iter().enumerate() {
                let items = part.to - part.from;
                let size = if depth < DEEP { part.bounds.area() } else { number(items) };
                if items > self.leaf && size > largest {
                    (largest, at) = (size, i);
                }
            }
            let Some(&Part { from, to, .. }) = parts.get(at) else { break };
            let middle = from + self.cut(&mut order[from..to], depth);
            // The later parts make room, so that parts keep the order of their items.
            parts.copy_within(at..count, at + 1);
            parts[at] = Part { from, to: middle, bounds: self.around(&order[from..middle]) };
            parts[at + 1] = Part { from: middle, to, bounds: self.around(&order[middle..to]) };
            count += 1;
        }
        (parts, count)
    }

    /// Orders items so that those before the index returned lie on one side; there are some on
    /// either side.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn cut(&self, order: &mut [u32], depth: usize) -> usize {
        let half = order.len() / 2;
        // Twice the middles of the boxes.
        let middle = |i: u32| self.boxes[i as usize].lo + self.boxes[i as usize].hi;
        let around = order.iter().fold(Bounds::NOTHING, |b, &i| {
            let p = middle(i);
            b.union(Bounds { lo: p, hi: p })
        });
        let scale = BINS as f32 * 0.999 / (around.hi - around.lo);
        let bin =
            |i: u32, axis: usize| (((middle(i) - around.lo)[axis] * scale[axis]) as usize).min(BINS - 1);
        let (mut least, mut best) = (f32::INFINITY, None);
        for axis in 0..3 {
            let mut bins = [(Bounds::NOTHING, 0_u32); BINS];
            for &i in order.iter() {
                let (bounds, count) = &mut bins[bin(i, axis)];
                *bounds = bounds.union(self.boxes[i as usize]);
                *count += 1;
            }
            let mut costs = [0.0; BINS];
            let (mut bounds, mut count) = (Bounds::NOTHING, 0);
            for k in (1..BINS).rev() {
                bounds = bounds.union(bins[k].0);
                count += bins[k].1;
                costs[k] = if count > 0 { bounds.area() * count as f32 } else { f32::INFINITY };
            }
            (bounds, count) = (Bounds::NOTHING, 0);
            for k in 1..BINS {
                bounds = bounds.union(bins[k - 1].0);
                count += bins[k - 1].1;
                let cost = bounds.area() * count as f32 + costs[k];
                if count > 0 && cost < least {
                    (least, best) = (cost, Some((axis, k)));
                }
            }
        }
        let Some((axis, plane)) = best.filter(|_| depth < DEEP) else { return half };
        let mut before = 0;
        for k in 0..order.len() {
            if bin(order[k], axis) < plane {
                order.swap(k, before);
                before += 1;
            }
        }
        before
    }
}
