//! The free camera: where it is, where it looks, and its pose as keys for a part's tracks.

use glam::Vec2;
use luc_core::math::Vec3;
use luc_core::math::scalar::sin_cos;
use luc_core::scene::Camera;
use minifb::Key;

/// Units it moves, and radians it turns, a second.
const SPEED: f32 = 4.0;
const TURN: f32 = 0.9;

/// Keys that move it along its own axes (right, up, forward), and that turn it (right, up).
const MOVES: [(Key, Vec3); 6] = [
    (Key::W, Vec3::Z),
    (Key::S, Vec3::NEG_Z),
    (Key::D, Vec3::X),
    (Key::A, Vec3::NEG_X),
    (Key::E, Vec3::Y),
    (Key::Q, Vec3::NEG_Y),
];
const TURNS: [(Key, Vec2); 4] =
    [(Key::Right, Vec2::X), (Key::Left, Vec2::NEG_X), (Key::Up, Vec2::Y), (Key::Down, Vec2::NEG_Y)];

/// Whether a key steers the camera.
pub fn steers(key: Key) -> bool {
    MOVES.iter().any(|m| m.0 == key) || TURNS.iter().any(|t| t.0 == key)
}

/// Moves and turns a camera by the keys that are held for `seconds`.
pub fn steer(camera: &mut Camera, held: &[Key], seconds: f32) {
    let axes = camera.world_from_camera();
    let sum = |found: Vec3, m: &(Key, Vec3)| if held.contains(&m.0) { found + m.1 } else { found };
    let way = axes * MOVES.iter().fold(Vec3::ZERO, sum) * (SPEED * seconds);
    let turned = |found: Vec2, t: &(Key, Vec2)| if held.contains(&t.0) { found + t.1 } else { found };
    let angle = TURNS.iter().fold(Vec2::ZERO, turned) * (TURN * seconds);
    let view = camera.target - camera.position;
    let ((sx, cx), (sy, cy)) = (sin_cos(angle.x), sin_cos(angle.y));
    let level = axes.z_axis * cx + axes.x_axis * sx;
    let forward = level * cy + axes.y_axis * sy;
    camera.position += way;
    camera.target = camera.position + forward.normalize_or(axes.z_axis) * view.length().max(0.1);
}

/// A pose as track keys at `seconds` of a part, and as a camera.
pub fn keys(camera: &Camera, part: &str, seconds: f64) -> String {
    let Camera { position: p, target: t, roll, fov } = camera;
    let mut text = format!(
        "// {part}, {seconds:.3} s\nCamera {{ position: Vec3::new({:.3}, {:.3}, {:.3}), target: Vec3::new({:.3}, {:.3}, {:.3}), roll: {roll:.4}, fov: {fov:.4} }}\n",
        p.x, p.y, p.z, t.x, t.y, t.z
    );
    for (name, v) in [("position", p), ("target", t)] {
        for (axis, value) in ["x", "y", "z"].into_iter().zip(v.to_array()) {
            text += &format!("key({seconds:.3}, {value:.3}, Ease::Smooth), // {name}.{axis}\n");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_forward_and_back_comes_home_and_keeps_the_view() {
        let start = Camera {
            position: Vec3::new(1.0, 2.0, 3.0),
            target: Vec3::new(4.0, 2.5, -1.0),
            ..Camera::default()
        };
        let mut camera = start;
        steer(&mut camera, &[Key::W, Key::D], 0.5);
        let forward = |c: &Camera| (c.target - c.position).normalize();
        assert!((camera.position - start.position).length() > 1.0);
        assert!((forward(&camera) - forward(&start)).length() < 1e-5);
        steer(&mut camera, &[Key::S, Key::A], 0.5);
        assert!((camera.position - start.position).length() < 1e-4, "{camera:?}");
    }

    #[test]
    fn turning_keeps_the_place_and_the_distance() {
        let start = Camera::default();
        let mut camera = start;
        steer(&mut camera, &[Key::Right], 1.0);
        assert_eq!(camera.position, start.position);
        assert!(camera.target.x > start.target.x, "right is right: {camera:?}");
        assert!(((camera.target - camera.position).length() - 5.0).abs() < 1e-4);
        steer(&mut camera, &[], 1.0);
        assert!(camera.target.is_finite());
    }

    #[test]
    fn a_pose_is_printed_as_code() {
        let text = keys(&Camera::default(), "mirror", 1.5);
        assert!(text.contains("key(1.500, 5.000, Ease::Smooth), // position.z"), "{text}");
        assert!(text.contains("roll: 0.0000, fov: 0.8000"));
    }
}
