//! Triangle meshes: shared geometry with a tree over its triangles, and instances of it in a scene.
//!
//! A mesh is built once and shared; an instance places it by an affine map, anew each frame. Rays
//! are taken into the mesh's own space, where their distances stay the same, so one tree serves
//! all instances, however they are stretched. A second tree lies over the instances.

mod ask;
mod place;
mod prism;
mod search;
#[cfg(test)]
mod tests;

pub use place::{Assembly, Instance};
pub use prism::prism;

use crate::bvh::{Bounds, LEAF, NO_ITEM, Tree};
use glam::Vec3;

/// The triangles of a leaf side by side: x, y and z of the first corners, of the second, of the
/// third, and four times their indices in the mesh. Unused places are NaN, which nothing hits.
type Leaf = [[f32; LEAF]; 10];

/// Triangles with a tree over them.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corners, anticlockwise from outside.
    triangles: Vec<[Vec3; 3]>,
    /// Normals at the corners, for meshes that stand for something curved; else empty.
    normals: Vec<[Vec3; 3]>,
    tree: Tree,
    leaves: Vec<Leaf>,
}

impl Mesh {
    /// A mesh of flat triangles: corners anticlockwise as seen from outside.
    pub fn flat(triangles: Vec<[Vec3; 3]>) -> Mesh {
        Mesh::smooth(triangles, Vec::new())
    }

    /// A mesh whose normals are interpolated between those at the corners, which are given for
    /// every triangle, or for none. They need not be unit vectors.
    #[inline(never)]
    pub fn smooth(triangles: Vec<[Vec3; 3]>, normals: Vec<[Vec3; 3]>) -> Mesh {
        let boxes: Vec<Bounds> = triangles.iter().map(|t| Bounds::around(t)).collect();
        let tree = Tree::build(&boxes, LEAF);
        let mut leaves = vec![[[f32::NAN; LEAF]; 10]; tree.leaves.len()];
        for (leaf, items) in leaves.iter_mut().zip(&tree.leaves) {
            for (place, &item) in items.iter().enumerate().filter(|(_, item)| **item != NO_ITEM) {
                let corners = triangles[item as usize].iter().flat_map(|p| p.to_array());
                for (row, value) in leaf.iter_mut().zip(corners.chain([4.0 * item as f32])) {
                    row[place] = value;
                }
            }
        }
        Mesh { triangles, normals, tree, leaves }
    }

    /// The triangles, in the order of their indices.
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.triangles
    }

    /// Whether its normals are interpolated.
    pub fn is_smooth(&self) -> bool {
        !self.normals.is_empty()
    }

    /// What is wrong with the mesh or its tree, if something is.
    pub fn validate(&self) -> Result<(), &'static str> {
        if self.is_smooth() && self.normals.len() != self.triangles.len() {
            return Err("normals for some triangles only");
        }
        self.tree.validate(&self.triangles.iter().map(|t| Bounds::around(t)).collect::<Vec<_>>())
    }
}
