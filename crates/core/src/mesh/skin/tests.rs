//! Images against what they are made of, and surfaces against their images.

use super::*;
use crate::math::Mat3;
use crate::math::lanes::RAMP;
use crate::mesh::{Assembly, Mesh};
use crate::quality::Quality;
use crate::scene::{Channel, Material, Scene};
use crate::trace::check::Random;
use crate::trace::{Rays8, nearest, surface};

const HIGH: &Quality = &Quality::PRESETS[Quality::DEFAULT].1;

fn random_image(random: &mut Random, size: [usize; 2]) -> Image {
    let texel = |_| [0; 3].map(|_| (random.bits() >> 24) as u8);
    Image::new(size, (0..size[0] * size[1]).map(texel).collect()).unwrap()
}

#[test]
fn the_middle_of_a_texel_is_its_colour_and_images_repeat() {
    let mut random = Random::new(71);
    for size in [[1, 1], [2, 3], [7, 4], [16, 16]] {
        let image = random_image(&mut random, size);
        for i in 0..size[0] * size[1] {
            let (x, y) = (i % size[0], i / size[0]);
            let texel = image.levels[0].texels[i].map(|byte| srgb_decode(number(byte as usize) / 255.0));
            let uv =
                Vec2::new((number(x) + 0.5) / number(size[0]), 1.0 - (number(y) + 0.5) / number(size[1]));
            for around in [Vec2::ZERO, Vec2::new(3.0, -2.0)] {
                let off = (image.at(uv + around, 0.0) - Vec3::from_array(texel)).abs().max_element();
                assert!(off < 1e-5, "{size:?} {x} {y}: {off}");
            }
        }
    }
    assert!(Image::new([2, 2], vec![[0; 3]; 3]).is_none() && Image::new([0, 2], vec![]).is_none());
}

#[test]
fn halves_keep_the_mean_light_and_the_last_is_it() {
    let mut random = Random::new(72);
    for size in [[8, 8], [13, 5], [1, 9]] {
        let image = random_image(&mut random, size);
        let mean = |level: &Level| {
            let light = |t: &[u8; 3]| Vec3::from_array(t.map(|byte| image.linear[byte as usize]));
            level.texels.iter().map(light).sum::<Vec3>() / number(level.texels.len())
        };
        let all = mean(&image.levels[0]);
        for level in &image.levels {
            // Half a step of a byte for each halving.
            assert!((mean(level) - all).abs().max_element() < 0.02, "{size:?} {:?}", level.size);
        }
        let far = image.at(Vec2::new(0.3, 0.9), 1e9);
        assert!((far - mean(image.levels.last().unwrap())).abs().max_element() < 1e-6);
        for wild in [f32::NAN, f32::INFINITY, -1e30, 3e38] {
            assert!(image.at(Vec2::new(wild, 0.1), wild).is_finite(), "{wild}");
        }
    }
}

#[test]
fn a_surface_has_the_colour_of_its_place_in_the_image_however_it_is_placed() {
    let mut random = Random::new(73);
    let image = Arc::new(random_image(&mut random, [5, 4]));
    for case in 0..40 {
        let corners = [0; 3].map(|_| random.vector(-1, 1));
        let uv = [0; 3].map(|_| Vec2::new(random.range(-2.0, 2.0), random.range(-2.0, 2.0)));
        let mesh = Mesh::flat(vec![corners]).with_skin(Skin { image: image.clone(), uvs: vec![uv] });
        mesh.validate().unwrap();
        let scale = Mat3::from_diagonal(Vec3::splat(random.range(0.5, 2.0)).into());
        let instance = Instance::new(&Arc::new(mesh), scale, random.vector(-1, 1), 0);
        let metal = case % 2 == 1;
        let base = Vec3::new(0.5, 0.25, 0.75);
        let material = if metal {
            Material { f0: base, diffuse: 0.0, ..Material::DEFAULT }
        } else {
            Material { colour: base, ..Material::DEFAULT }
        };
        let (a, b) = (random.range(0.2, 0.4), random.range(0.2, 0.4));
        let [p, q, r] = corners.map(|p| instance.to_world(p));
        let (e, f) = (q - p, r - p);
        let n = cross(e, f);
        if n.length() < 0.05 * e.length() * f.length() {
            continue;
        }
        let at = p + e * a + f * b;
        let n = crate::math::normalize(n);
        let rays = Rays8 { origin: V3::splat(at + n), direction: V3::splat(-n) };
        let scene =
            Scene { meshes: Assembly::new(vec![instance]), materials: vec![material], ..Scene::default() };
        let hits = nearest(&scene, HIGH, &rays, u64::MAX, &mut crate::counters::Counters::default());
        // Footprints from none on, lane by lane.
        let s = surface(&scene, HIGH, &rays, hits.t, hits.id, RAMP * splat(0.01));
        let place = uv[0] + (uv[1] - uv[0]) * a + (uv[2] - uv[0]) * b;
        let (own, other) = (s.colour(Channel::Colour), s.colour(Channel::F0));
        let seen = if metal { other } else { own };
        let off = (seen.lane(0) - base * image.at(place, 0.0)).abs().max_element();
        assert!(off < 1e-3, "case {case}: {off}");
        let texels = ((uv[1] - uv[0]).perp_dot(uv[2] - uv[0]).abs() * 20.0 / cross(e, f).length()).sqrt();
        let off = (seen.lane(7) - base * image.at(place, 0.07 * texels)).abs().max_element();
        assert!(off < 1e-3, "case {case}: {off} over a footprint");
    }
}
