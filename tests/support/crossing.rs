//! Small bright things that cross the picture, to see whether any frame loses one.

use luc_core::math::{Mat3, Vec3};
use luc_core::mesh::{Assembly, Instance, Mesh, lathe};
use luc_core::scene::*;
use std::sync::Arc;

/// Frames that a crossing takes.
pub const FRAMES: u32 = 60;

/// What crosses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thing {
    /// A bar about one pixel thick and a third of the picture long.
    Bar,
    /// An endless bar about one pixel thick.
    EndlessBar,
    /// A ball three pixels in diameter.
    Ball,
    /// A triangle about four pixels wide.
    Triangle,
    /// A shadow three pixels high, of a ball that is out of the picture.
    Shadow,
    /// A shining rectangle that the backdrop, a mirror, shows about a pixel thick.
    Glint,
    /// A triangle about four pixels wide, of a mesh.
    Facet,
    /// A shadow three pixels high, of a mesh that is out of the picture.
    FacetShadow,
}

/// What it crosses in front of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backdrop {
    /// Nothing at all.
    Dark,
    /// A level floor up to the horizon.
    Floor,
    /// A wall across the view.
    Wall,
    /// A ball that fills half the picture.
    Globe,
}

/// Width of a pixel of a picture 640 px wide, at a distance of one unit.
const PIXEL: f32 = 2.0 * 0.4 / 640.0;

/// The eye looks down -z from here.
const EYE: Vec3 = Vec3::new(0.0, 1.0, 10.0);

/// A point of the floor.
const FLOOR: Vec3 = Vec3::new(0.0, -1.0, 0.0);

/// Distance of the plane across the view on which things move.
const DISTANCE: f32 = 8.0;

/// The scene at a frame of the crossing; without the thing it is what the thing is compared with.
pub fn scene(thing: Thing, backdrop: Backdrop, frame: u32, with_thing: bool) -> Scene {
    let mut scene = Scene {
        // Tangent of half the field of view 0.4.
        camera: Camera { position: EYE, target: EYE - Vec3::Z, roll: 0.0, fov: 0.761_012_8 },
        materials: vec![
            Material { diffuse: 0.0, emission: Vec3::splat(4.0), ..Material::default() },
            Material { colour: Vec3::splat(0.1), ..Material::default() },
        ],
        grade: Grade { grain: 0.0, ..Grade::default() },
        ..Scene::default()
    };
    match backdrop {
        Backdrop::Dark => {}
        Backdrop::Floor => {
            scene.planes.push(Plane { point: FLOOR, normal: Vec3::Y, reach: f32::INFINITY, material: 1 })
        }
        Backdrop::Wall => scene.planes.push(Plane {
            point: Vec3::new(0.0, 0.0, -1.0),
            normal: luc_core::math::normalize(Vec3::new(0.2, 0.1, 1.0)),
            reach: f32::INFINITY,
            material: 1,
        }),
        Backdrop::Globe => scene.spheres.push(Sphere {
            centre: Vec3::new(0.0, 1.0, -2.0),
            radius: 2.5,
            material: 1,
            blend: 0.0,
        }),
    }
    let lamp = Vec3::new(-4.0, 9.0, 6.0);
    scene.lights.push(Light { position: lamp, colour: Vec3::splat(300.0), kind: LightKind::Point });
    if thing == Thing::Glint {
        scene.materials[1] =
            Material { diffuse: 0.0, f0: Vec3::splat(0.6), reflection: 1.0, ..Material::default() };
    }
    if !with_thing {
        return scene;
    }

    // From the left border to the right one, rising, at uneven steps of a pixel.
    let t = frame as f32 / (FRAMES - 1) as f32 * 2.0 - 1.0;
    let px = PIXEL * DISTANCE;
    let on_screen = |x: f32, y: f32| EYE + Vec3::new(x * 320.0 * px, y * 180.0 * px, -DISTANCE);
    let at = on_screen(t * 0.97, -0.7 + 0.2 * t);
    match thing {
        Thing::Bar => {
            let half = Vec3::new(0.35, 0.8, 0.2) * 60.0 * px;
            scene.cylinders.push(Cylinder::between(at - half, at + half, 0.55 * px, 0));
        }
        Thing::EndlessBar => scene.cylinders.push(Cylinder {
            base: at,
            axis: luc_core::math::normalize(Vec3::new(0.3 - 0.5 * t, 0.8, -0.3)),
            radius: 0.55 * px,
            length: f32::INFINITY,
            material: 0,
        }),
        Thing::Ball => {
            scene.spheres.push(Sphere { centre: at, radius: 1.5 * px, material: 0, blend: 0.0 });
        }
        Thing::Glint => {
            let centre = Vec3::new(7.0 * t, 5.0 - 2.0 * t * t, 5.0);
            scene.emitters.push(Emitter::facing(centre, Vec3::Y, 0.1, 3.0, Vec3::splat(9.0)));
        }
        Thing::Triangle => scene.triangles.push(Triangle {
            corners: [[-2.0, -1.5, 0.0], [2.0, -1.0, 1.0], [0.0, 2.0, -1.0]]
                .map(|c: [f32; 3]| at + Vec3::from(c) * px),
            material: 0,
        }),
        Thing::Facet => {
            let corners = [[-2.0, -1.5, 0.0], [2.0, -1.0, 1.0], [0.0, 2.0, -1.0]].map(Vec3::from);
            scene.meshes = place(vec![corners], px, at);
        }
        Thing::Shadow | Thing::FacetShadow => {
            // Half way from the lamp to the place that the shadow is to fall on, which is above the
            // picture; so the shadow is twice as wide. The floor is seen at a slant.
            let ground = ground(backdrop, at - EYE);
            let centre = ground + (lamp - ground) * 0.5;
            let slant = if backdrop == Backdrop::Floor { 2.5 } else { 1.0 };
            let radius = 0.75 * slant * PIXEL * (ground - EYE).length();
            if thing == Thing::Shadow {
                scene.spheres.push(Sphere { centre, radius, material: 0, blend: 0.0 });
            } else {
                let mut body = Vec::new();
                lathe(&mut body, &[(Vec3::NEG_Y, 0.0), (Vec3::ZERO, 1.0), (Vec3::Y, 0.0)], 8, 0.1);
                scene.meshes = place(body, radius, centre);
            }
        }
    }
    scene
}

/// One mesh, scaled and moved, of material 0.
fn place(triangles: Vec<[Vec3; 3]>, scale: f32, at: Vec3) -> Assembly {
    let mesh = Arc::new(Mesh::flat(triangles));
    Assembly::new(vec![Instance::new(&mesh, Mat3::from_diagonal(Vec3::splat(scale).into()), at, 0)])
}

/// Where the backdrop lies in a direction from the eye.
fn ground(backdrop: Backdrop, direction: Vec3) -> Vec3 {
    let plane =
        |point: Vec3, normal: Vec3| EYE + direction * (normal.dot(point - EYE) / normal.dot(direction));
    match backdrop {
        Backdrop::Dark | Backdrop::Floor => plane(FLOOR, Vec3::Y),
        Backdrop::Wall => plane(Vec3::new(0.0, 0.0, -1.0), Vec3::new(0.2, 0.1, 1.0)),
        Backdrop::Globe => {
            let (d, o) = (luc_core::math::normalize(direction), EYE - Vec3::new(0.0, 1.0, -2.0));
            let b = d.dot(o);
            let root = (b * b - o.length_squared() + 2.5 * 2.5).max(0.0).sqrt();
            EYE + d * (-b - root)
        }
    }
}
