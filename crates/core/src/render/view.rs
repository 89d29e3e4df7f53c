//! Other ways to look at a scene than by its light: what the first rays meet, drawn as it is.
//!
//! No light, no adaptive sampling, no post: one ray through the middle of each pixel. Only the view
//! of the sampling and that of the small lights are ordinary frames, with an overlay all over.

use super::{Renderer, Stage, Tables};
use crate::counters::{Counter, Counters};
use crate::math::Vec3;
use crate::math::lanes::{F, V3, splat};
use crate::math::scalar::srgb_encode;
use crate::parallel;
use crate::quality::Quality;
use crate::sample::TILE;
use crate::scene::{Channel, Scene};
use crate::trace::{Rays8, nearest, surface};

/// What is drawn instead of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Shading normals in world space: red, green and blue are x, y and z from -1 to 1.
    Normal,
    /// Distance from the eye, linear from black at 0 to white at [`FARTHEST`] and beyond.
    Distance,
    /// Colour of surfaces in white light from the front, with textures: diffuse and mirrored.
    Albedo,
    /// The finished frame, without effects, with how each pixel was got: see [`Scene::overlay`].
    Sampling,
    /// How many small lights reach the surfaces of each tile: black for none, blue for one, by violet
    /// and orange to white for 64 and more. See [`Scene::light_count`].
    Lights,
    /// Tests and steps that the first ray took, linear from black for none to white for
    /// [`MOST_STEPS`] and more. Needs the feature `counters`, else all is black.
    Steps,
}

/// Distance that [`View::Distance`] draws white, world units.
pub const FARTHEST: f32 = 50.0;

/// Steps that [`View::Steps`] draws white.
pub const MOST_STEPS: f32 = 127.5;

impl View {
    /// All views with their names.
    pub const ALL: [(&str, View); 6] = [
        ("normal", View::Normal),
        ("distance", View::Distance),
        ("albedo", View::Albedo),
        ("sampling", View::Sampling),
        ("lights", View::Lights),
        ("steps", View::Steps),
    ];

    /// Draws frame `n` of a scene as 0RGB rows into `pixels`; `n` as for [`Renderer::frame`].
    pub fn draw(self, scene: &Scene, n: u64, size: (u32, u32), quality: &Quality, pixels: &mut [u32]) {
        let (sampling, lights) = (self == View::Sampling, self == View::Lights);
        if sampling || lights {
            let mut scene = scene.clone();
            scene.effects.clear();
            // A share of the width, and a weight.
            *if sampling { &mut scene.overlay } else { &mut scene.light_count } = 1.0;
            return Renderer::default().frame(&scene, n, size, quality, pixels);
        }
        let tables = &mut Tables::default();
        let stage = &Stage::new(scene, quality, size.into(), tables);
        parallel::each(pixels.chunks_mut(size.0 as usize), |y, row| {
            for (k, row) in row.chunks_mut(TILE).enumerate() {
                let candidates = stage.candidates((k * TILE, y / TILE * TILE), TILE);
                for (i, pixel) in row.iter_mut().enumerate() {
                    let value = self.pixel(stage, k * TILE + i, y, candidates);
                    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
                    *pixel = byte(value.x) << 16 | byte(value.y) << 8 | byte(value.z);
                }
            }
        });
    }

    /// Display value of a pixel. All lanes carry its ray, so that steps are counted for it alone.
    fn pixel(self, stage: &Stage, x: usize, y: usize, candidates: u64) -> Vec3 {
        let direction = stage.directions(splat(x as f32 + 0.5), splat(y as f32 + 0.5));
        let rays = Rays8 { origin: V3::splat(stage.view.origin), direction };
        let mut counters = Counters::default();
        let hit = nearest(stage.scene, &stage.quality, &rays, candidates, &mut counters);
        let t = hit.t.as_array()[0];
        let found = hit.id.as_array()[0] >= 0.0;
        let near = if found { hit.t } else { F::ZERO };
        let s = || surface(stage.scene, &stage.quality, &rays, near, hit.id, splat(stage.pixel));
        match self {
            View::Distance => Vec3::splat(t / FARTHEST),
            View::Steps => {
                let steps: u64 = Counter::ALL.iter().map(|&(counter, _)| counters.get(counter)).sum();
                Vec3::splat((steps / 8) as f32 / MOST_STEPS)
            }
            _ if !found => Vec3::ZERO,
            View::Normal => s().normal.lane(0) * 0.5 + 0.5,
            _ => {
                let s = s();
                let colour = s.colour(Channel::Colour) * s.value(Channel::Diffuse) + s.colour(Channel::F0);
                colour.lane(0).map(srgb_encode)
            }
        }
    }
}
