//! The quality ladder: every knob that trades accuracy for time, as six named presets.

use crate::study::Study;

/// What is interpolated between the samples of a cell that needs no further samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// The colour: cheapest; blurs highlights and textures.
    Colour,
    /// The light: textures are evaluated at each pixel on the known shape.
    Light,
    /// Only what came by mirrors and glass: surface, texture and direct light are exact at each
    /// pixel, on the known shape and with the known shadows.
    Surface,
}

/// Everything that trades accuracy for time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Side of the coarsest sampling cell at 1080 lines, px: a power of two from 4 to 32, or 1 to
    /// trace every pixel. Half of it up to 720 lines, twice over 1440; see [`Quality::cell`].
    pub block: u32,
    /// Largest error of an interpolated cell at its centre, in display units (1 is white).
    pub tolerance: f32,
    /// Side of the smallest cell that may be split no further, px; 1 refines to the pixel.
    pub smallest: u32,
    /// What is interpolated.
    pub rung: Rung,
    /// Additional samples of each quadrant of a pixel that lies towards an edge.
    pub edge_samples: u32,
    /// Additional samples of every pixel, on edges or not; then there are none for edges alone.
    pub samples: u32,
    /// Longest chain of mirrors and refractions.
    pub depth: u32,
    /// Rays of a bounce of diffuse light, where the scene has bounces; 0 for its ambient light.
    pub scatter: u32,
    /// Rays drawn for the mirror of a rough surface under GGX; 0 for one with a wide footprint.
    pub rough: u32,
    /// Rays whose contribution is at most this are not followed, in units of display white.
    pub cutoff: f32,
    /// How near to a field a ray must come to hit it, world units at the ray's origin; it grows
    /// with the distance: `epsilon * (1 + t)`.
    pub epsilon: f32,
    /// Most steps of a ray that marches; one that is near a body by then has hit it.
    pub steps: u32,
    /// Steps of the eye's rays through smoke, in its cells; rays of mirrors take thrice as long ones. 0 leaves
    /// out the sight of it.
    pub smoke: f32,
    /// Rays to points of each shining rectangle, where the scene has soft shadows; 1 for one to its
    /// middle. At least 1.
    pub shadow_samples: u32,
    /// Side of the tiles of the screen by which small lights are culled, px, at least 1. Changes the
    /// time, never the picture (but for the one that counts the lights).
    pub light_tile: u32,
    /// Leave out shapes, lights and occluders that a tile can't meet. Changes the time, never the picture.
    pub cull: bool,
    /// Frames with different sample patterns that are averaged: 1, more for a still.
    pub average: u32,
    /// What a study takes away; nothing in the show.
    pub study: Study,
}

impl Quality {
    /// The presets from fastest to most exact.
    pub const PRESETS: [(&str, Quality); 6] = [
        (
            "draft",
            Quality {
                block: 32,
                tolerance: 0.08,
                smallest: 2,
                rung: Rung::Colour,
                edge_samples: 0,
                samples: 0,
                depth: 4,
                scatter: 0,
                rough: 0,
                cutoff: 0.03,
                epsilon: 5e-4,
                steps: 96,
                smoke: 2.0,
                shadow_samples: 1,
                light_tile: 16,
                cull: true,
                average: 1,
                study: Study::NONE,
            },
        ),
        (
            "low",
            Quality {
                block: 16,
                tolerance: 0.08,
                smallest: 1,
                rung: Rung::Colour,
                edge_samples: 0,
                samples: 0,
                depth: 4,
                scatter: 0,
                rough: 0,
                cutoff: 0.03,
                epsilon: 5e-4,
                steps: 96,
                smoke: 2.0,
                shadow_samples: 1,
                light_tile: 16,
                cull: true,
                average: 1,
                study: Study::NONE,
            },
        ),
        (
            "medium",
            Quality {
                block: 16,
                tolerance: 0.06,
                smallest: 1,
                rung: Rung::Surface,
                edge_samples: 1,
                samples: 0,
                depth: 5,
                scatter: 0,
                rough: 0,
                cutoff: 0.02,
                epsilon: 3e-4,
                steps: 128,
                smoke: 1.5,
                shadow_samples: 4,
                light_tile: 16,
                cull: true,
                average: 1,
                study: Study::NONE,
            },
        ),
        (
            "high",
            Quality {
                block: 16,
                tolerance: 0.02,
                smallest: 1,
                rung: Rung::Surface,
                edge_samples: 1,
                samples: 0,
                depth: 5,
                scatter: 0,
                rough: 0,
                cutoff: 0.02,
                epsilon: 3e-4,
                steps: 128,
                smoke: 1.0,
                shadow_samples: 8,
                light_tile: 16,
                cull: true,
                average: 1,
                study: Study::NONE,
            },
        ),
        (
            "ultra",
            Quality {
                block: 8,
                tolerance: 0.008,
                smallest: 1,
                rung: Rung::Surface,
                edge_samples: 2,
                samples: 0,
                depth: 7,
                scatter: 4,
                rough: 4,
                cutoff: 0.01,
                epsilon: 2e-4,
                steps: 192,
                smoke: 0.5,
                shadow_samples: 16,
                light_tile: 16,
                cull: true,
                average: 1,
                study: Study::NONE,
            },
        ),
        (
            "reference",
            Quality {
                block: 1,
                tolerance: 0.0,
                smallest: 1,
                rung: Rung::Surface,
                edge_samples: 4,
                samples: 15,
                depth: 12,
                scatter: 4,
                rough: 4,
                cutoff: 0.001,
                epsilon: 1e-4,
                steps: 384,
                smoke: 0.25,
                shadow_samples: 64,
                light_tile: 16,
                cull: true,
                average: 1,
                study: Study::NONE,
            },
        ),
    ];

    /// Index of the preset that `--frame` and the tests use unless told otherwise.
    pub const DEFAULT: usize = 3;

    /// The preset with this name.
    pub fn named(name: &str) -> Option<Quality> {
        Self::PRESETS.iter().find(|(n, _)| *n == name).map(|(_, q)| *q)
    }

    /// The same quality, but every pixel is traced.
    pub fn every_pixel(self) -> Quality {
        Quality { block: 1, ..self }
    }

    /// Side of the coarsest cell for a picture of `height` lines, px.
    pub fn cell(&self, height: u32) -> u32 {
        if self.block <= 1 {
            return 1;
        }
        let block = match height {
            0..=720 => self.block / 2,
            721..=1440 => self.block,
            _ => self.block * 2,
        };
        block.clamp(4, 32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_4_to_32_px_grow_with_the_picture() {
        for (name, quality) in Quality::PRESETS {
            let sizes = [1, 360, 720, 1080, 1440, 2160, 4320].map(|height| quality.cell(height));
            if quality.block == 1 {
                assert_eq!(sizes, [1; 7], "{name} traces every pixel");
                continue;
            }
            assert!(sizes.iter().all(|s| s.is_power_of_two() && (4..=32).contains(s)), "{name}: {sizes:?}");
            assert!(sizes.is_sorted() && sizes[2] < sizes[5], "{name} doesn't grow: {sizes:?}");
        }
        assert_eq!(Quality::PRESETS[Quality::DEFAULT].1.every_pixel().cell(2160), 1);
    }

    #[test]
    fn the_ladder_has_six_rungs_and_no_knob_turns_back() {
        let names = Quality::PRESETS.map(|(name, _)| name);
        assert_eq!(names, ["draft", "low", "medium", "high", "ultra", "reference"]);
        for ((_, worse), (name, better)) in Quality::PRESETS.iter().zip(&Quality::PRESETS[1..]) {
            let up = |knob: fn(&Quality) -> f32| knob(better) >= knob(worse);
            let down = |knob: fn(&Quality) -> f32| knob(better) <= knob(worse);
            let finer = [
                down(|q| q.block as f32),
                down(|q| q.tolerance),
                down(|q| q.smallest as f32),
                better.rung >= worse.rung,
                up(|q| q.edge_samples as f32),
                up(|q| q.samples as f32),
                up(|q| q.depth as f32),
                up(|q| q.scatter as f32),
                up(|q| q.rough as f32),
                down(|q| q.cutoff),
                down(|q| q.epsilon),
                up(|q| q.steps as f32),
                down(|q| q.smoke),
                up(|q| q.shadow_samples as f32),
            ];
            assert!(finer.iter().all(|&is| is), "{name}: {finer:?}");
            assert_ne!(better, worse, "{name}");
            assert_eq!(Quality::named(name), Some(*better));
        }
        assert_eq!(Quality::named("best"), None);
    }
}
