//! Relief bends the normal as the slope of the moved surface would, fades with the footprint into
//! roughness, and leaves what has none alone.

use crate::math::Vec3;
use crate::math::lanes::{F, V3, splat};
use crate::math::noise::value_noise;
use crate::quality::Quality;
use crate::scene::{Channel, Material, Plane, Scene, Texture};
use crate::trace::check::Random;
use crate::trace::{Rays8, Surface, surface};

/// A floor of this texture, seen by rays down onto `points` from 10 units above with this
/// footprint per unit.
fn seen(texture: Texture, points: [Vec3; 8], spread: f32) -> Surface {
    let material = Material { colour: Vec3::ONE, roughness: 0.2, texture, ..Material::default() };
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 1e3, material: 0 };
    let scene = Scene { planes: vec![plane], materials: vec![material], ..Scene::default() };
    let origin = V3::from_fn(|i| points[i] + Vec3::Y * 10.0);
    let rays = Rays8 { origin, direction: V3::splat(Vec3::NEG_Y) };
    surface(&scene, &Quality::PRESETS[3].1, &rays, splat(10.0), F::ZERO, splat(spread))
}

fn points(random: &mut Random) -> [Vec3; 8] {
    [0; 8].map(|_| Vec3::new(random.range(-30.0, 30.0), 0.0, random.range(-30.0, 30.0)))
}

#[test]
fn relief_has_the_normal_of_the_moved_surface() {
    let mut random = Random::new(640);
    for case in 0..2000 {
        let (scale, bump) = (random.range(0.2, 3.0), random.range(0.001, 0.1));
        let at = points(&mut random);
        let s = seen(Texture { scale, bump, ..Texture::NONE }, at, 0.0);
        for (i, p) in at.into_iter().enumerate() {
            // The graph y = b h(x, z) has the normal (-b dh/dx, 1, -b dh/dz).
            let (_, g) = value_noise(V3::splat(p * scale));
            let g = g.lane(0) * (scale * bump);
            let expected = crate::math::normalize(Vec3::new(-g.x, 1.0, -g.z));
            let found = s.normal.lane(i);
            assert!((found - expected).length() < 1e-5, "{found} {expected} at {p:?}, case {case}");
            assert_eq!(s.outward().lane(i), Vec3::Y, "only shading sees the relief");
        }
    }
}

#[test]
fn relief_fades_into_roughness_from_eight_footprints_a_cell_to_four() {
    let mut random = Random::new(641);
    let texture = Texture { bump: 0.1, ..Texture::NONE };
    let at = points(&mut random);
    let tilt = |spread: f32| {
        let s = seen(texture, at, spread);
        let level = (0..8).fold(1.0, |least: f32, i| least.min(s.normal.lane(i).y));
        (level, s.value(Channel::Roughness).as_array()[0])
    };
    // The footprint is the spread times 10.
    let ((near, smooth), (middle, _), (far, rough)) = (tilt(0.0124), tilt(0.018), tilt(0.0251));
    assert!(near < middle && middle < far, "{near} {middle} {far}");
    assert_eq!(far, 1.0, "no relief is left");
    assert!((smooth - 0.2).abs() < 1e-6, "{smooth}");
    // α² grows by the mean square slope.
    let fourth = |m: f32| m * m * m * m;
    let expected = fourth(0.2) + 0.01 * 0.88;
    assert!((fourth(rough) - expected).abs() < 1e-5, "{rough}");
}

#[test]
fn surfaces_without_relief_keep_normal_and_roughness() {
    let at = points(&mut Random::new(642));
    let s = seen(Texture { grain: 0.5, ..Texture::NONE }, at, 0.1);
    for i in 0..8 {
        assert_eq!(s.normal.lane(i), Vec3::Y);
        assert_eq!(s.value(Channel::Roughness).as_array()[i], 0.2);
    }
}
