//! Bounding volume hierarchies: eight boxes a node, side by side, in one flat list.
//!
//! One ray, or a bundle of rays that run close together, is tested against the eight boxes of a
//! node at once, one box a lane. Leaves hold up to four items. The same tree serves the triangles
//! of a mesh and the instances of a scene.

mod build;
#[cfg(test)]
mod tests;
mod walk;

use crate::math::Vec3;
use crate::math::lanes::{F, LANES};

/// Items a leaf may hold.
pub const LEAF: usize = 4;

/// Child of an unused lane.
const EMPTY: u32 = u32::MAX;

/// Flag of a child that is a leaf: `LEAF_BIT | index * LEAF + count - 1`.
const LEAF_BIT: u32 = 1 << 31;

/// An axis-parallel box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least corner.
    pub lo: Vec3,
    /// Greatest corner.
    pub hi: Vec3,
}

impl Bounds {
    /// A box around nothing.
    pub const NOTHING: Bounds = Bounds { lo: Vec3::INFINITY, hi: Vec3::NEG_INFINITY };

    /// The box around both.
    pub fn union(self, b: Bounds) -> Bounds {
        Bounds { lo: self.lo.min(b.lo), hi: self.hi.max(b.hi) }
    }

    /// The box around some points; not finite if one of them isn't.
    pub fn around(points: &[Vec3]) -> Bounds {
        let sound = points.iter().all(|p| p.is_finite());
        let add = |b: Bounds, &p: &Vec3| b.union(Bounds { lo: p, hi: p });
        if sound { points.iter().fold(Bounds::NOTHING, add) } else { Bounds::NOTHING }
    }

    /// Whether the box is around something, and bounded.
    pub fn is_finite(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// Half the surface area.
    pub fn area(self) -> f32 {
        let d = self.hi - self.lo;
        d.x * (d.y + d.z) + d.y * d.z
    }
}

/// Eight boxes and what is in them.
#[derive(Clone, Debug)]
struct Node {
    /// Least and greatest x, y and z; a lane is a box.
    bounds: [F; 6],
    /// Index of a node, a leaf, or [`EMPTY`].
    child: [u32; LANES],
}

/// A hierarchy over items that have a box each.
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    /// Items of each leaf; the first of them again where there are fewer.
    pub leaves: Vec<[u32; LANES]>,
    /// The box around everything.
    pub bounds: Bounds,
}

impl Default for Tree {
    fn default() -> Self {
        Self { nodes: Vec::new(), leaves: Vec::new(), bounds: Bounds::NOTHING }
    }
}

impl Node {
    fn child_bounds(&self, lane: usize) -> Bounds {
        let at = |i: usize| self.bounds[i].as_array()[lane];
        Bounds { lo: Vec3::new(at(0), at(2), at(4)), hi: Vec3::new(at(1), at(3), at(5)) }
    }

    fn set(&mut self, lane: usize, b: Bounds, child: u32) {
        for (plane, value) in self.bounds.iter_mut().zip([b.lo.x, b.hi.x, b.lo.y, b.hi.y, b.lo.z, b.hi.z]) {
            plane.as_mut_array()[lane] = value;
        }
        self.child[lane] = child;
    }
}

impl Tree {
    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// What is wrong with the tree over items with these boxes, if something is: every item whose
    /// box is finite must lie in exactly one leaf, every box within that of its parent, and every
    /// node must be reached exactly once.
    pub fn validate(&self, boxes: &[Bounds]) -> Result<(), &'static str> {
        let mut items = vec![0; boxes.len()];
        let mut nodes = vec![0; self.nodes.len()];
        let mut todo = if self.is_empty() { vec![] } else { vec![(0, self.bounds)] };
        let inside = |b: Bounds, outer: Bounds| b.lo.cmpge(outer.lo).all() && b.hi.cmple(outer.hi).all();
        while let Some((index, outer)) = todo.pop() {
            *nodes.get_mut(index).ok_or("a child that is no node")? += 1;
            let node = &self.nodes[index];
            for (lane, &child) in node.child.iter().enumerate().filter(|(_, child)| **child != EMPTY) {
                let bounds = node.child_bounds(lane);
                if !inside(bounds, outer) {
                    return Err("a box that leaves its parent's");
                }
                if child & LEAF_BIT == 0 {
                    todo.push((child as usize, bounds));
                    continue;
                }
                let (leaf, last) = ((child & !LEAF_BIT) as usize / LEAF, child as usize % LEAF);
                for &item in &self.leaves.get(leaf).ok_or("a leaf without items")?[..=last] {
                    *items.get_mut(item as usize).ok_or("an item that is none")? += 1;
                    if !inside(boxes[item as usize], bounds) {
                        return Err("an item that leaves its leaf's box");
                    }
                }
            }
        }
        if !items.iter().zip(boxes).all(|(&n, b)| n == i32::from(b.is_finite())) {
            return Err("an item that is lost or there twice");
        }
        if nodes.iter().any(|&n| n != 1) {
            return Err("a node that is not reached exactly once");
        }
        Ok(())
    }
}
