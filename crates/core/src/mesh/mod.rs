//! Triangle meshes: shared geometry with a tree over its triangles, and instances of it in a scene.
//!
//! A mesh is built once and shared; an instance places it by an affine map, anew each frame. Rays
//! are taken into the mesh's own space, where their distances stay the same, so one tree serves
//! all instances, however they are stretched. A second tree lies over the instances.

mod ask;
mod lathe;
mod place;
mod search;
mod skin;
#[cfg(test)]
mod tests;

pub use lathe::lathe;
pub use place::{Assembly, Instance};
pub use search::Blockers;
pub(crate) use skin::on_surface;
pub use skin::{Image, Skin};

use crate::bvh::{Bounds, LEAF, Tree};
use crate::features;
use crate::math::Vec3;
use crate::math::lanes::V3;

/// Triangles with a tree over them.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corners, anticlockwise from outside.
    triangles: Vec<[Vec3; 3]>,
    /// Normals at the corners, for meshes that stand for something curved; else empty.
    normals: Vec<[Vec3; 3]>,
    tree: Tree,
    /// The triangles of each leaf of the tree, side by side.
    leaves: Vec<[V3; 3]>,
    #[cfg(feature = "images")]
    skin: Option<Skin>,
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
        Mesh {
            leaves: tree.leaves.iter().map(|items| gather(&triangles, items)).collect(),
            tree,
            triangles,
            normals,
            #[cfg(feature = "images")]
            skin: None,
        }
    }

    /// The mesh with an image laid over it: a factor on the albedo.
    #[cfg(feature = "images")]
    pub fn with_skin(self, skin: Skin) -> Mesh {
        Mesh { skin: Some(skin), ..self }
    }

    /// What is laid over it.
    pub fn skin(&self) -> Option<&Skin> {
        #[cfg(feature = "images")]
        return self.skin.as_ref();
        #[cfg(not(feature = "images"))]
        None
    }

    /// The triangles, in the order of their indices.
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.triangles
    }

    /// Whether its normals are interpolated.
    pub fn is_smooth(&self) -> bool {
        features::SMOOTH && !self.normals.is_empty()
    }

    /// What is wrong with the mesh or its tree, if something is.
    pub fn validate(&self) -> Result<(), &'static str> {
        if self.is_smooth() && self.normals.len() != self.triangles.len() {
            return Err("normals for some triangles only");
        }
        if self.skin().is_some_and(|skin| skin.uvs.len() != self.triangles.len()) {
            return Err("texture coordinates for some triangles only");
        }
        self.tree.validate(&self.triangles.iter().map(|t| Bounds::around(t)).collect::<Vec<_>>())
    }
}

/// Points of up to eight triangles, one or more, lane by lane; lanes that are left have those of the first.
#[inline(never)]
fn gather(list: &[[Vec3; 3]], index: &[u32]) -> [V3; 3] {
    let [a, b, c] = list[index[0] as usize];
    let mut out = [V3::splat(a), V3::splat(b), V3::splat(c)];
    for (lane, &i) in index.iter().enumerate().skip(1) {
        for (points, &p) in out.iter_mut().zip(&list[i as usize]) {
            points.set_lane(lane, p);
        }
    }
    out
}
