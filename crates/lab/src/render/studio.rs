//! The scene that a model is shown in: a dark floor, a shining rectangle as key light, a weak light that
//! fills, one from behind, all of which go with the camera; and a camera that has all of it in view.

use super::body::Body;
use luc_core::math::{Mat3, Vec3};
use luc_core::scene::*;
use std::f32::consts::TAU;

/// Horizontal field of view, radians; that of upright pictures is less.
const FOV: f32 = 0.6;

/// Share of the picture that the model fills.
const FILLED: f32 = 0.82;

/// How far under the model the floor lies: models that bring their own would share its plane.
const BELOW: f32 = 2e-3;

/// Positions around the model that a turning camera must see all of it from.
const AROUND: u32 = 48;

/// From where the model is seen.
pub struct Pose {
    /// Angle about the vertical axis, degrees.
    pub turn: f32,
    /// Angle over the horizon, degrees.
    pub height: f32,
    /// Whether the distance must be right for all turns.
    pub steady: bool,
}

/// Right, up, and towards the eye.
fn axes(turn: f32, height: f32) -> Mat3 {
    let ((sin, cos), (rise, level)) = (turn.to_radians().sin_cos(), height.to_radians().sin_cos());
    let towards = Vec3::new(sin * level, rise, cos * level);
    let right = Vec3::new(cos, 0.0, -sin);
    Mat3::from_cols(right, towards.cross(right), towards)
}

/// The nearest camera that has all points in view, each within a share of the picture: a point p is
/// within if |p.x - c.x| <= (distance - p.z) tangent, so each side of the picture is the greatest of a sum.
fn fitted(points: &[Vec3], turn: f32, height: f32, tangents: [f32; 2]) -> Vec3 {
    let axes = axes(turn, height);
    let mut most = [[f32::MIN; 2]; 2];
    for &p in points {
        let p = axes.transpose() * p;
        for (axis, most) in most.iter_mut().enumerate() {
            let (side, depth) = (p[axis], p.z * tangents[axis]);
            *most = [most[0].max(side + depth), most[1].max(depth - side)];
        }
    }
    let distance = |axis: usize| (most[axis][0] + most[axis][1]) / (2.0 * tangents[axis]);
    let middle = |axis: usize| (most[axis][0] - most[axis][1]) * 0.5;
    axes * Vec3::new(middle(0), middle(1), distance(0).max(distance(1)))
}

/// The camera for a picture of this size.
fn camera(body: &Body, pose: &Pose, (width, height): (u32, u32)) -> Camera {
    let across = (FOV * 0.5).tan() * (width as f32 / height as f32).min(1.0);
    let tangents = [across * FILLED, across * FILLED * height as f32 / width as f32];
    let mut position = fitted(&body.points, pose.turn, pose.height, tangents);
    let towards = axes(pose.turn, pose.height).z_axis;
    if pose.steady {
        // The camera goes around on a circle, and looks at one point.
        let middle = Vec3::Y * (0.5 * body.top);
        let reach = |k: u32| {
            let at = fitted(&body.points, k as f32 * 360.0 / AROUND as f32, pose.height, tangents);
            (at - middle).length()
        };
        position = middle + towards * (0..AROUND).map(reach).fold(0.0, f32::max);
    }
    Camera { position, target: position - towards, roll: 0.0, fov: 2.0 * across.atan() }
}

/// A light studio's dark wall, and its glow behind the model.
fn background() -> Background {
    let stop = |y, v| Stop { y, colour: Vec3::new(0.9, 0.95, 1.1) * v };
    Background {
        stops: vec![stop(-1.0, 0.02), stop(-0.05, 0.045), stop(0.12, 0.05), stop(0.5, 0.13), stop(1.0, 0.3)],
        ..Background::default()
    }
}

/// The scene of a body with these materials, as a picture of this size shows it.
pub fn scene(body: &Body, materials: &[Material], pose: &Pose, size: (u32, u32), floor: bool) -> Scene {
    let camera = camera(body, pose, size);
    let middle = Vec3::new(0.0, 0.5 * body.top, 0.0);
    let axes = axes(pose.turn, 0.0);
    let from = |right: f32, up: f32, towards: f32| middle + axes * Vec3::new(right, up, towards);
    let light = |position, colour| Light { position, colour, kind: LightKind::Point };
    let mut scene = Scene {
        camera,
        background: background(),
        meshes: body.assembly(),
        materials: materials.to_vec(),
        emitters: vec![Emitter::facing(
            from(-3.4, 4.2, 3.6),
            middle,
            2.6,
            2.6,
            Vec3::new(1.0, 0.95, 0.88) * 15.0,
        )],
        lights: vec![
            light(from(5.0, 1.2, 3.0), Vec3::new(0.55, 0.7, 1.0) * 9.0),
            light(from(2.2, 3.6, -4.6), Vec3::new(0.8, 0.88, 1.0) * 16.0),
        ],
        shading: Shading::Ggx,
        bounces: 2,
        rough: true,
        soft: true,
        ambient: [Vec3::new(0.06, 0.055, 0.05), Vec3::new(0.15, 0.165, 0.19)],
        ..Scene::default()
    };
    if floor {
        let stone = Material {
            colour: Vec3::splat(0.09),
            f0: Vec3::splat(0.04),
            roughness: 0.3,
            reflection: 1.0,
            ..Material::DEFAULT
        };
        scene.planes.push(Plane {
            point: Vec3::NEG_Y * BELOW,
            normal: Vec3::Y,
            reach: 60.0,
            material: scene.materials.len(),
        });
        scene.materials.push(stone);
        scene.fog = Some(Fog {
            density: 0.05,
            colour: Vec3::new(0.9, 0.95, 1.1) * 0.045,
            lo: Vec3::splat(-80.0),
            hi: Vec3::splat(80.0),
        });
    }
    scene
}

/// Angle of a frame of a turntable that goes around once in `frames`, degrees.
pub fn turned(frame: u64, frames: u64) -> f32 {
    (frame % frames) as f32 / frames as f32 * (TAU.to_degrees())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::body::Normals;
    use crate::render::obj::Model;

    #[test]
    fn all_of_a_model_is_in_view_and_it_fills_the_picture() {
        let text = "v -3 0 0\nv 9 1 0\nv 0 7 2\nv 1 0 -5\nf 1 2 3\nf 1 2 4\n";
        let body = Body::new(&Model::read(text).unwrap(), &[], Normals::Flat, false).unwrap();
        for (size, turn, height, steady) in [
            ((1280, 720), 30.0, 20.0, false),
            ((300, 900), 200.0, -10.0, false),
            ((640, 640), 111.0, 40.0, true),
        ] {
            let camera = camera(&body, &Pose { turn, height, steady }, size);
            let m = camera.world_from_camera().transpose();
            let tangent = camera.half_width();
            let mut most = 0.0_f32;
            for &p in &body.points {
                let p = m * (p - camera.position);
                let [x, y] = [p.x / p.z / tangent, p.y / p.z / tangent * size.0 as f32 / size.1 as f32];
                assert!(p.z > 0.0 && x.abs().max(y.abs()) < 0.95, "{size:?} {turn}: {x} {y}");
                most = most.max(x.abs()).max(y.abs());
            }
            assert!(steady || (most - FILLED).abs() < 0.02, "{most}");
        }
    }
}
