//! End: words of light on the floor before the title, seen from afar; then all but the beam goes out,
//! and the camera flies to where the show began.
//!
//! It is Lúč's first frame with warm light in place of its cold one, so the last frame is the first.

use super::luc::{self, at};
use super::paint::{key, seconds, times, v};
use super::text::{Line, write};
use luc_core::math::Vec3;
use luc_core::scene::*;

/// Share of the way back to the first frame, over seconds.
const BACK: [Key; 2] = [key(5.6, 0.0, Ease::Smooth), key(8.0, 1.0, Ease::Step)];

/// Seconds from one line's first letter to the next line's.
const LINES: f32 = 1.6;

/// Width of the words' strokes, world units.
pub const STROKE: f32 = 0.035;

pub const WORDS: [&[u8]; 3] = [b"THANKS", b"FOR FOLLOWING", b"THE LIGHT"];

/// Colours of the sky at the heights that Lúč's sky has.
const SKY: [Vec3; 4] =
    [v(0.02, 0.01, 0.012), v(0.11, 0.034, 0.022), v(0.05, 0.017, 0.034), v(0.006, 0.004, 0.014)];

/// Where a warm and a violet rectangle shine from, to, their sizes and radiances.
const PANELS: [(Vec3, Vec3, [f32; 2], Vec3); 2] = [
    (v(4.7, 1.9, -12.1), v(-1.8, 0.6, 7.3), [11.3, 2.6], times(v(1.0, 0.46, 0.14), 22.7)),
    (v(-18.7, 9.7, 0.8), v(-4.2, 0.0, 13.7), [3.2, 9.7], times(v(0.5, 0.28, 0.75), 11.1)),
];

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let back = track(&BACK, t);
    let warm = 1.0 - back;
    let mut scene = luc::scene(0);

    for (stop, colour) in scene.background.stops.iter_mut().zip(SKY) {
        stop.colour = colour.lerp(stop.colour, back);
    }
    let colour = v(0.42, 0.15, 0.035) * warm;
    let direction = v(0.2, 0.03, -0.98);
    scene.background.glows.push(Glow { direction, colour, sharpness: 60.0 });
    if let Some(fog) = &mut scene.fog {
        fog.colour = v(0.07, 0.022, 0.024).lerp(fog.colour, back);
        fog.hi.y = 12.0;
    }
    // Each rectangle has gone out when it moves, and only then comes back cold.
    let light = 1.0 - 2.0 * back;
    for (emitter, (centre, target, [w, h], radiance)) in scene.emitters.iter_mut().zip(PANELS) {
        if light > 0.0 {
            *emitter = Emitter::facing(centre, target, w, h, radiance * light);
        } else {
            emitter.radiance *= -light;
        }
    }
    let grade = &mut scene.grade;
    grade.lift = v(0.016, 0.006, 0.014).lerp(grade.lift, back);
    grade.gamma = v(0.92, 0.9, 0.9).lerp(grade.gamma, back);
    grade.gain = v(1.0, 0.98, 0.94).lerp(grade.gain, back);

    // The beam reaches the L, which burns a little until the beam draws back.
    let near = (1.0 - 4.0 * back).max(0.0);
    if let Some(fire) = &mut scene.materials[0].fire {
        (fire.radius, fire.strength) = ((1.5 * near).max(1e-3), 2.0);
    }
    // Long swells break what the floor mirrors into streaks.
    scene.materials[3].texture = Texture { scale: 0.45, bump: 0.12 * warm, ..Texture::NONE };
    scene.lights[0].colour = v(1.0, 0.7, 0.38) * (0.91 * near);
    for beam in &mut scene.beams[..2] {
        beam.from = at(-30.0);
        beam.to = at(-3.46).lerp(beam.to, back);
        beam.width *= 1.0 + 0.5 * warm;
        beam.colour = (beam.colour * v(1.5, 0.95, 0.56)).lerp(beam.colour, back);
    }
    scene.beams[5].colour = v(1.0, 0.78, 0.48) * (2.0 * near);
    scene.beams[5].width = 0.19;

    let camera = &mut scene.camera;
    camera.position = Vec3::new(-8.06 + 0.03 * t, 3.31, 31.1 - 0.1 * t).lerp(camera.position, back);
    camera.target = v(-4.35, 1.85, 8.87).lerp(camera.target, back);
    // The words go out before it passes them: it moves as of 5.6 s.
    let words_light = (17.25 - 3.0 * t).min(1.0);
    if words_light <= 0.0 {
        return scene;
    }
    for (k, words) in WORDS.into_iter().enumerate() {
        let k = k as f32;
        let line = Line {
            words,
            origin: Vec3::new(-10.6, 0.0, 13.1 + 2.6 * k),
            right: 0.19,
            up: v(0.0, 0.0, -0.34),
            width: STROKE,
            colour: v(1.0, 0.52, 0.18) * (1.5 * words_light),
        };
        write(&mut scene.beams, &line, camera.position, (t - 0.2 - LINES * k) * 12.0);
    }
    scene
}
