//! Mirror: an hourglass of two steel cones with a mirror ball at its waist, before a blue moon.
//!
//! The ball rises on the beat of each fourth bar and lifts the upper cone, which sinks back slowly
//! by itself; two glass balls circle at different heights in opposite directions, one with an
//! ember inside. Everything stands on a dark mirror.

use super::paint::{
    angle, degrees, glass, graded, grain, key, metal, orbit, polished, seconds, swing, times, v,
};
use super::score;
use super::still::{Lamp, Panel, Still};
use luc_core::math::Vec3;
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, pulse, strikes};

/// Strikes of the kick, with which the ember glows.
const KICK: [Strikes; 16] = strikes(&score::SCORE, &score::MIRROR, score::KICK);

/// Seconds between two lifts: four bars.
const CYCLE: f32 = 8.0;

/// How far the cone stands over its rest, units over seconds of the cycle: up on the kick, then it
/// sinks by itself for 3.5 s.
const CONE: [Key; 3] =
    [key(0.0, 0.0, Ease::Smooth), key(0.25, 0.9, Ease::Smooth), key(3.75, 0.0, Ease::Step)];

/// The same for the ball, which carries the cone up and falls back freely.
const BALL: [Key; 4] = [
    key(0.0, 0.0, Ease::Smooth),
    key(0.25, 0.9, Ease::Linear),
    key(0.5, 0.85, Ease::Ramp),
    key(0.95, 0.0, Ease::Step),
];

/// Distance of the camera from its target, units over seconds, and how far the target has risen.
const DISTANCE: [Key; 2] = [key(0.0, 15.4, Ease::Smooth), key(30.0, 13.1, Ease::Step)];
const RISE: [Key; 2] = [key(0.0, 2.4, Ease::Smooth), key(30.0, 2.7, Ease::Step)];

/// How high the ball and the cone stand over their rest, units.
fn lift(t: f32) -> (f32, f32) {
    let t = t % CYCLE;
    let cone = track(&CONE, t);
    (track(&BALL, t).min(cone), cone)
}

/// A glass ball that circles.
const fn circling(radius: f32, material: usize) -> Sphere {
    Sphere { centre: Vec3::ZERO, radius, material, blend: 0.0 }
}

const STEEL: Material =
    Material { specular: v(0.35, 0.47, 0.66), exponent: 18.0, ..metal(v(0.2, 0.27, 0.38), 0.27) };

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.002, 0.004, 0.01) },
        Stop { y: -0.02, colour: v(0.02, 0.045, 0.11) },
        Stop { y: 0.03, colour: v(0.035, 0.085, 0.21) },
        Stop { y: 0.2, colour: v(0.01, 0.026, 0.075) },
        Stop { y: 0.6, colour: v(0.003, 0.007, 0.022) },
        Stop { y: 1.0, colour: v(0.002, 0.004, 0.012) },
    ],
    discs: &[Disc {
        centre: v(8.0, 5.3, -24.0),
        radius: 5.6,
        low: times(v(0.24, 0.48, 1.0), 0.08),
        high: times(v(0.24, 0.48, 1.0), 0.8),
    }],
    spheres: &[
        Sphere { centre: v(0.0, 2.48, 0.0), radius: 0.5, material: 1, blend: 0.0 },
        circling(0.82, 2),
        circling(0.2, 3),
        circling(0.82, 4),
    ],
    planes: &[Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 26.0, material: 5 }],
    materials: &[
        STEEL,
        metal(v(0.93, 0.95, 0.98), 0.02),
        Material { emission: v(0.03, 0.009, 0.001), ..glass(v(1.0, 0.74, 0.42), v(1.0, 0.3, 0.04), 1.28) },
        Material { diffuse: 0.0, emission: times(v(1.0, 0.46, 0.12), 9.0), ..Material::DEFAULT },
        glass(v(0.7, 0.94, 1.0), v(0.12, 0.62, 1.0), 1.5),
        Material { texture: grain(0.9, 0.18), ..polished(v(0.13, 0.17, 0.24), 0.05, 1.75) },
    ],
    lights: &[
        // The ember's own.
        Lamp { position: Vec3::ZERO, colour: times(v(1.0, 0.45, 0.12), 2.28), spot: None },
        Lamp {
            position: v(-4.4, 11.0, -4.6),
            colour: times(v(0.86, 0.93, 1.0), 96.3),
            spot: Some((v(0.9, 0.0, 1.0), [0.85, 0.743])),
        },
        // From the floor up along the upper cone, which else only mirrors the dark below.
        Lamp {
            position: v(-1.3, 0.3, 3.6),
            colour: times(v(0.5, 0.72, 1.0), 70.0),
            spot: Some((v(0.0, 4.4, 0.0), [0.95, 0.86])),
        },
    ],
    panels: &[
        Panel {
            centre: v(-5.2, 4.6, 6.0),
            target: v(0.0, 2.6, 0.0),
            size: [0.9, 10.0],
            radiance: times(v(0.62, 0.8, 1.0), 21.93),
        },
        Panel {
            centre: v(7.5, 7.0, -5.0),
            target: v(0.0, 2.5, 0.0),
            size: [1.0, 5.0],
            radiance: times(v(0.7, 0.85, 1.0), 26.74),
        },
    ],
    ambient: [v(0.08, 0.13, 0.23), v(0.01, 0.026, 0.07)],
    fog: Some(Fog {
        density: 0.012,
        colour: v(0.03, 0.075, 0.18),
        lo: v(-80.0, -0.2, -80.0),
        hi: v(80.0, 5.0, -7.0),
    }),
    grade: graded(Grade {
        bloom_threshold: 1.1,
        bloom: 0.4,
        lift: v(0.0, 0.006, 0.02),
        gamma: v(0.92, 0.92, 0.97),
        vignette: 0.18,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let (ball, cone) = lift(t);
    let above = Vec3::Y * cone;
    let ember = orbit(0.298 + t / 11.0, 2.9, 3.75 + 0.4 * swing(t, 7.0, 0.0));
    let turn = degrees(-15.0 + 12.0 * swing(t, 17.0, 0.0) + 6.0 * swing(t, 23.0, 0.25));
    let target = Vec3::new(1.5, track(&RISE, t), 0.0);
    let away = orbit(turn / std::f32::consts::TAU, track(&DISTANCE, t), -0.05);

    let mut s = STILL.scene();
    s.camera = Camera { position: target + away, target, roll: angle(1.5), fov: angle(43.0) };
    s.spheres[0].centre.y += ball;
    s.spheres[1].centre = ember;
    s.spheres[2].centre = ember;
    s.spheres[3].centre = orbit(0.845 - t / 13.0, 2.84, 1.35 + 0.4 * swing(t, 9.0, 0.0));
    let ember_glows = 1.0 + 0.9 * pulse(&KICK, frame, 7.0);
    s.lights[0].colour *= ember_glows;
    s.materials[3].emission *= ember_glows;
    s.lights[0].position = ember + v(0.0, -1.05, 0.5);
    s.cones = vec![
        Cone::between((v(0.0, 2.1, 0.0), 0.34), (Vec3::ZERO, 1.3), [false, false], 0),
        Cone::between((v(0.0, 3.02, 0.0) + above, 0.0), (v(0.0, 5.2, 0.0) + above, 1.3), [false, true], 0),
    ];
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ball_never_enters_the_upper_cone() {
        for frame in 0..32 * super::super::FPS {
            let (ball, cone) = lift(seconds(frame));
            assert!(
                ball <= cone && ball >= 0.0 && cone <= super::super::paint::short(0.9),
                "frame {frame}: {ball} over {cone}"
            );
        }
    }
}
