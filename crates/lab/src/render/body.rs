//! A model as meshes: one for each material (two, if its image is laid over some faces only), of unit size and
//! standing on the floor.

use super::image::Paint;
use super::mtl::Told;
use super::obj::Model;
use glam::Vec2;
use luc_core::math::{Mat3, Vec3};
use luc_core::mesh::{Assembly, Instance, Mesh, Skin};
use luc_core::scene::Texture;
use std::collections::HashMap;
use std::sync::Arc;

/// Triangles whose ids an f32 can tell apart.
const MOST: usize = 4_000_000;

/// Edges whose faces bend by more than this stay sharp under normals of our own: its cosine.
const CREASE: f32 = 0.5;

/// How normals are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    /// Those of the file; faces without are flat.
    File,
    /// One for each face.
    Flat,
    /// Means over the faces around a corner, but for sharp edges.
    Smooth,
}

/// A model ready to be placed in a scene.
pub struct Body {
    /// Meshes with the index of their material among those of the model.
    pub meshes: Vec<(Arc<Mesh>, usize)>,
    /// All corners.
    pub points: Vec<Vec3>,
    /// Greatest y.
    pub top: f32,
}

/// Sine of the angle between normals that are one.
const PARALLEL: f32 = 1e-3;

/// What becomes a mesh, triangle by triangle.
#[derive(Default)]
struct Part {
    corners: Vec<[Vec3; 3]>,
    normals: Vec<[Vec3; 3]>,
    uvs: Vec<[Vec2; 3]>,
}

impl Part {
    /// Whether some normal is not that of its face.
    fn is_smooth(&self) -> bool {
        let bent = |n: Vec3, face: Vec3| n.cross(face).length() > PARALLEL * n.length() * face.length();
        self.corners.iter().zip(&self.normals).any(|(c, n)| n.iter().any(|&n| bent(n, across(*c))))
    }

    fn mesh(self, paint: Option<&Paint>) -> Mesh {
        let mesh = if self.is_smooth() {
            Mesh::smooth(self.corners, self.normals)
        } else {
            Mesh::flat(self.corners)
        };
        match paint {
            Some(paint) => mesh.with_skin(Skin { image: paint.image.clone(), uvs: self.uvs }),
            None => mesh,
        }
    }
}

/// Three points around a face, its normal as long as twice its area.
fn across([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}

impl Body {
    /// The model with its greatest half side 1, in the middle over the origin, with its least y 0. `z_up`
    /// turns models whose third axis points up. `paints` are the images of the model's materials.
    pub fn new(
        model: &Model,
        paints: &[Option<Paint>],
        normals: Normals,
        z_up: bool,
    ) -> Result<Body, String> {
        if model.triangles.is_empty() {
            return Err("there are no faces in it".into());
        }
        if model.triangles.len() > MOST {
            return Err(format!("{} triangles; {MOST} can be drawn", model.triangles.len()));
        }
        let turn = |p: Vec3| if z_up { Vec3::new(p.x, p.z, -p.y) } else { p };
        let used = || model.triangles.iter().flat_map(|t| t.at).map(|i| turn(model.positions[i]).as_dvec3());
        let start = || used().next().unwrap_or_default();
        let (lo, hi) = used().fold((start(), start()), |(lo, hi), p| (lo.min(p), hi.max(p)));
        let half = 0.5 * (hi - lo).max_element();
        if half == 0.0 {
            return Err("all its corners are one point".into());
        }
        let middle = (lo + hi) * 0.5;
        let place = |i: usize| {
            let p = (turn(model.positions[i]).as_dvec3() - middle) / half;
            Vec3::new(p.x as f32, (p.y + (hi.y - lo.y) * 0.5 / half) as f32, p.z as f32)
        };
        let corners: Vec<[Vec3; 3]> = model.triangles.iter().map(|t| t.at.map(place)).collect();
        let smooth = match normals {
            Normals::Smooth => smoothed(&corners),
            _ => Vec::new(),
        };
        let mut parts: Vec<[Part; 2]> = model.materials.iter().map(|_| Default::default()).collect();
        for (i, (told, &corners)) in model.triangles.iter().zip(&corners).enumerate() {
            let paint = paints.get(told.material).and_then(Option::as_ref).zip(told.uv);
            let part = &mut parts[told.material][paint.is_some() as usize];
            let flat = [across(corners); 3];
            let own = match normals {
                Normals::File => told.normal.map_or(flat, |n| n.map(|n| turn(model.normals[n]))),
                Normals::Flat => flat,
                Normals::Smooth => smooth[i],
            };
            part.corners.push(corners);
            part.normals.push(own);
            if let Some((paint, uv)) = paint {
                let at = |i: usize| {
                    let [u, v] = model.uvs[i];
                    Vec2::new(u, v) * Vec2::from(paint.scale) + Vec2::from(paint.offset)
                };
                part.uvs.push(uv.map(at));
            }
        }
        let mut meshes = Vec::new();
        for (material, [plain, painted]) in parts.into_iter().enumerate() {
            let paint = paints.get(material).and_then(Option::as_ref);
            for (part, paint) in [(plain, None), (painted, paint)] {
                if !part.corners.is_empty() {
                    meshes.push((Arc::new(part.mesh(paint)), material));
                }
            }
        }
        let points: Vec<Vec3> = corners.into_iter().flatten().collect();
        let top = points.iter().map(|p| p.y).fold(0.0, f32::max);
        Ok(Body { meshes, points, top })
    }

    /// All meshes as they stand.
    pub fn assembly(&self) -> Assembly {
        let instance = |(mesh, material): &(Arc<Mesh>, usize)| {
            Instance::new(mesh, Mat3::IDENTITY, Vec3::ZERO, *material)
        };
        Assembly::new(self.meshes.iter().map(instance).collect())
    }
}

/// What is said about each of a model's materials, in its order. Of what nothing is said wears `texture`.
pub fn told(model: &Model, libraries: &[Told], texture: Texture) -> Vec<Told> {
    let of = |name: &String| {
        // Of two with one name the later counts.
        let found = libraries.iter().rev().find(|told| told.name == *name);
        found.cloned().unwrap_or_else(|| Told { texture, ..Told::new(name) })
    };
    model.materials.iter().map(of).collect()
}

/// Normals at the corners of triangles: means of the faces that share the point and don't bend too far
/// from the corner's own, by their areas.
fn smoothed(corners: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
    let faces: Vec<Vec3> = corners.iter().map(|&t| across(t)).collect();
    // 0 and -0 are one place.
    let key = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let mut around: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
    for (i, t) in corners.iter().enumerate() {
        t.iter().for_each(|&p| around.entry(key(p)).or_default().push(i));
    }
    let units: Vec<Vec3> = faces.iter().map(|n| n.normalize_or_zero()).collect();
    let mean = |i: usize, p: Vec3| {
        let near = around[&key(p)].iter().filter(|&&k| units[k].dot(units[i]) >= CREASE);
        near.fold(Vec3::ZERO, |sum, &k| sum + faces[k])
    };
    corners.iter().enumerate().map(|(i, t)| t.map(|p| mean(i, p))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &str = "v 5 5 5\nv 9 5 5\nv 9 9 5\nv 5 9 5\nv 5 5 9\nv 9 5 9\nv 9 9 9\nv 5 9 9\nv 99 99 99\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nusemtl b\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

    #[test]
    fn a_model_is_of_unit_size_and_stands_on_the_floor() {
        for (normals, z_up) in [(Normals::File, false), (Normals::Smooth, true)] {
            let body = Body::new(&Model::read(CUBE).unwrap(), &[], normals, z_up).unwrap();
            let (lo, hi) = body
                .points
                .iter()
                .fold((body.points[0], body.points[0]), |(lo, hi), &p| (lo.min(p), hi.max(p)));
            assert_eq!(
                (lo, hi),
                (Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)),
                "unused corners don't count"
            );
            assert_eq!(
                body.meshes.iter().map(|m| (m.0.triangles().len(), m.1)).collect::<Vec<_>>(),
                [(6, 0), (6, 1)]
            );
            for (mesh, _) in &body.meshes {
                mesh.validate().unwrap();
                assert!(!mesh.is_smooth(), "all its normals are those of its faces");
            }
        }
    }

    #[test]
    fn edges_of_a_cube_stay_sharp_and_those_of_a_ball_go() {
        let cube = Body::new(&Model::read(CUBE).unwrap(), &[], Normals::Flat, false).unwrap();
        let corners: Vec<[Vec3; 3]> = cube.points.chunks(3).map(|c| [c[0], c[1], c[2]]).collect();
        for (t, normals) in corners.iter().zip(smoothed(&corners)) {
            for n in normals {
                assert!(n.normalize().dot(across(*t).normalize()) > 0.9999);
            }
        }
        let mut ball = Vec::new();
        let ring = |y: f32| (Vec3::Y * y, (1.0 - y * y).max(0.0).sqrt());
        luc_core::mesh::lathe(&mut ball, &[-1.0, -0.8, -0.3, 0.3, 0.8, 1.0].map(ring), 24, 0.0);
        for (t, normals) in ball.iter().zip(smoothed(&ball)) {
            for (p, n) in t.iter().zip(normals) {
                assert!(n.normalize().dot(p.normalize()) > 0.95, "{p} {n}");
            }
        }
    }

    #[test]
    fn what_has_no_size_is_refused() {
        for (text, words) in
            [("", "no faces"), ("v 1 1 1\nf 1 1 1\n", "one point"), ("v 0 0 0\nl 1 1\n", "no faces")]
        {
            let said = Body::new(&Model::read(text).unwrap(), &[], Normals::File, false).err().unwrap();
            assert!(said.contains(words), "{said}");
        }
    }
}
