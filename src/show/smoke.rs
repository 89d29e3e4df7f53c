//! Smoke: a small house of voxels in the evening sun, in violet light from the other side, turns into
//! smoke layer by layer, until only its window is left.

use super::paint::{angle, graded, key, orbit, seconds, surface, swing, times, v};
use super::still::{Lamp, Still};
use luc_core::math::Vec3;
use luc_core::math::hash::{hash2, mix, unit};
use luc_core::scene::*;

/// Cells of the house, and their side.
const SIZE: [usize; 3] = [34, 26, 26];
const CELL: f32 = 0.1;
const CORNER: Vec3 = v(-1.7, 0.0, -1.3);

/// What the cells are; materials follow in this order.
const WALL: u8 = 1;
const ROOF: u8 = 2;
const WINDOW: u8 = 3;
const EMBER: u8 = 4;

/// The last cell: the middle of the window.
const LAST: [i32; 3] = [19, 5, 20];

/// The front of the fire over seconds: a cell is gone when its own number is over this.
const FRONT: [Key; 5] = [
    key(0.0, 42.0, Ease::Smooth),
    key(4.0, 34.0, Ease::Linear),
    key(12.0, 19.0, Ease::Linear),
    key(18.0, 5.0, Ease::Linear),
    key(23.0, -11.0, Ease::Step),
];

/// The house, as it was built.
fn built([x, y, z]: [i32; 3]) -> u8 {
    // Cells inwards from the overhang of the roof, which steps in by one a layer; its height.
    let (a, b, h) = ((x - 5).min(28 - x), (z - 3).min(22 - z), y - 11);
    let near = |i: i32, middle: i32| (i - middle).abs() < 2;
    let chimney = near(x, 11) && near(z, 9) && h > 1 && h < 14;
    let door = near(x, 10) && h < -4 && z == 21;
    if near(x, 19) && near(y, 5) && z > 19 {
        return if z == 20 { WINDOW } else { 0 };
    }
    let wall = a == 1 && b > h.max(0) || b == 1 && a > 0 && h < 0;
    if h >= 0 && a >= 0 && b == h && !chimney {
        ROOF
    } else if (wall && !door) || chimney {
        WALL
    } else {
        0
    }
}

/// The house at a step of the smoke.
fn figure(step: u32, house: &mut Voxels) {
    let front = track(&FRONT, step as f32 * Air::SECONDS);
    house.reset(CORNER, CELL, SIZE);
    house.material = 1;
    house.groove = 0.09;
    house.variation = 0.3;
    house.edit_all_by(&mut |at, _| {
        let value = built(at);
        let [x, y, z] = at;
        let bits = mix(hash2(x as u32, y as u32), z as u32);
        let own = y as f32 + 0.625 * x as f32 + 0.15625 * z as f32 + unit(bits) * 5.0 - 4.5;
        let over = own - front;
        match value {
            0 => Voxels::EMPTY,
            // The window outlives the rest, and its middle everything.
            WINDOW if over < 21.0 || at == LAST => WINDOW,
            _ if over > 1.5 => Voxels::EMPTY,
            _ if over > 0.0 => Voxels::SMOKE,
            _ if over > -0.8 => EMBER,
            _ => value,
        }
    });
}

static SMOKE: Rules = Rules {
    lo: v(-2.6, 0.0, -1.6),
    cell: 0.08,
    size: [72, 72, 40],
    air: Air {
        density: 2.2,
        heat: 1.0,
        lift: 1.7,
        wind: v(0.1, 0.0, -0.05),
        fade: 0.17,
        cool: 0.35,
        drag: 0.2,
        sweeps: 16,
        ..Air::DEFAULT
    }
    .motion(0.08),
    lamps: [STILL.lights[0].position, STILL.lights[1].position],
    extinction: 7.0,
    depth: 0.8,
    albedo: Vec3::ONE,
    phase: [0.55, 0.76, -0.31],
    gain: 0.3,
    ambient: v(0.045, 0.022, 0.06),
    glow: v(0.05, 0.012, 0.0),
    ..Rules::new(figure)
};

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.02, 0.01, 0.03) },
        Stop { y: -0.02, colour: v(0.14, 0.045, 0.05) },
        Stop { y: 0.02, colour: v(0.36, 0.105, 0.035) },
        Stop { y: 0.12, colour: v(0.14, 0.04, 0.08) },
        Stop { y: 0.32, colour: v(0.035, 0.015, 0.075) },
        Stop { y: 1.0, colour: v(0.012, 0.006, 0.04) },
    ],
    glows: &[Glow { direction: v(0.42, 0.05, -1.0), colour: v(1.0, 0.33, 0.06), sharpness: 26.0 }],
    discs: &[Disc {
        centre: v(14.6, 2.3, -26.0),
        radius: 3.1,
        low: times(v(1.0, 0.42, 0.08), 2.4),
        high: times(v(1.0, 0.42, 0.08), 2.4),
    }],
    planes: &[Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 90.0, material: 0 }],
    materials: &[
        Material { reflection: 1.0, ..surface(v(0.06, 0.04, 0.06), 0.38, 0.0) },
        surface(v(0.42, 0.36, 0.34), 0.6, 0.0),
        surface(v(0.3, 0.075, 0.035), 0.6, 0.0),
        Material { emission: times(v(1.0, 0.6, 0.2), 4.2), ..Material::DEFAULT },
        Material { emission: times(v(1.0, 0.15, 0.015), 1.2), ..Material::DEFAULT },
    ],
    lights: &[
        Lamp {
            position: v(4.6, 3.2, -4.8),
            colour: times(v(1.0, 0.42, 0.1), 65.9),
            spot: Some((v(0.0, 0.9, 0.0), [0.95, 0.8])),
        },
        Lamp {
            position: v(-5.2, 2.6, 2.6),
            colour: times(v(0.34, 0.22, 1.0), 26.0),
            spot: Some((v(0.0, 1.0, 0.0), [0.95, 0.8])),
        },
        Lamp { position: v(0.25, 0.55, 1.0), colour: times(v(1.0, 0.62, 0.25), 0.23), spot: None },
    ],
    shading: Shading::Ggx,
    ambient: [v(0.1, 0.035, 0.04), v(0.15, 0.075, 0.17)],
    fog: Some(Fog {
        density: 0.02,
        colour: v(0.26, 0.075, 0.05),
        lo: v(-90.0, -0.2, -90.0),
        hi: v(90.0, 4.0, -5.0),
    }),
    grade: graded(Grade {
        bloom: 0.55,
        lift: v(0.016, 0.004, 0.022),
        gamma: v(0.88, 0.87, 0.9),
        gain: v(1.0, 0.98, 0.96),
        vignette: 0.2,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let mut scene = STILL.scene();
    let steps = frame.div_ceil(2) as u32;
    scene.smoke = Some(Smoke { rules: &SMOKE, steps, behind: (frame & 1) as f32 * 0.5 });
    scene.voxels = vec![Voxels::default()];
    figure(steps, &mut scene.voxels[0]);
    let way = t / 24.0;
    let target = Vec3::new(0.7, 1.5 + 0.25 * way, 0.0);
    let position = orbit(-0.0545 + 0.042 * way, 9.24, 1.55 + 0.6 * way);
    scene.camera = Camera { position, target, roll: angle(1.5), fov: angle(43.0) };
    let breath = 1.0 + 0.08 * swing(t, 4.0, 0.0);
    for light in &mut scene.lights {
        light.colour *= breath;
    }
    scene
}
