//! Smoke: what it is made of and how it moves. What it looks like at a step is found by simulation.

use super::Voxels;
use crate::math::Vec3;

/// How the air moves. Rates are per second, lengths world units; one step takes [`Air::SECONDS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Density of what turns into smoke.
    pub density: f32,
    /// Its temperature over that of the air.
    pub heat: f32,
    /// Upward acceleration per unit of temperature.
    pub lift: f32,
    /// Acceleration per unit of density, for wind and weight.
    pub wind: Vec3,
    /// Rate at which density is lost.
    pub fade: f32,
    /// Rate at which temperature is lost.
    pub cool: f32,
    /// Rate at which velocity is lost.
    pub drag: f32,
    /// Sweeps of the pressure a step.
    pub sweeps: u32,
    /// Share of their turning that is given back to whirls in a step, 0 for none; over 1/2 it boils.
    pub swirl: f32,
}

impl Air {
    /// Length of a step.
    pub const SECONDS: f32 = 1.0 / 30.0;

    /// Still air that keeps what it has.
    pub const DEFAULT: Self = Self {
        density: 1.0,
        heat: 1.0,
        lift: 0.0,
        wind: Vec3::ZERO,
        fade: 0.0,
        cool: 0.0,
        drag: 0.0,
        sweeps: 16,
        swirl: 0.0,
    };

    /// What it comes to in a step, for cells of a side, world units.
    pub const fn motion(self, cell: f32) -> Motion {
        let pace = Self::SECONDS * Self::SECONDS / cell;
        let [x, y, z] = self.wind.to_array();
        let slow = 1.0 - self.drag * Self::SECONDS;
        let (fade, cool) = (1.0 - self.fade * Self::SECONDS, 1.0 - self.cool * Self::SECONDS);
        Motion {
            keep: [slow, slow, slow, fade, cool, 0.0, 0.0, 0.0],
            source: [f32::MIN, f32::MIN, f32::MIN, self.density, self.heat, 0.0, 0.0, 0.0],
            by_density: [x * pace, y * pace, z * pace, 0.0, 0.0, 0.0, 0.0, 0.0],
            by_heat: [0.0, self.lift * pace, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            sweeps: self.sweeps,
            swirl: self.swirl,
        }
    }
}

/// How the air moves in a step; lanes as those of a cell's values.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Factors.
    pub keep: [f32; 8],
    /// The least values where smoke comes from.
    pub source: [f32; 8],
    /// What a unit of density adds.
    pub by_density: [f32; 8],
    /// What a unit of temperature adds.
    pub by_heat: [f32; 8],
    /// Sweeps of the pressure.
    pub sweeps: u32,
    /// Share of their turning that is given back to whirls.
    pub swirl: f32,
}

/// Smoke in a box. It begins without any, and what it is after so many steps follows from the
/// [`Voxels`] at each of them: solid ones are in its way, those of value [`Voxels::SMOKE`] fill their
/// place with it.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// Least corner, world.
    pub lo: Vec3,
    /// Side of a cell, world units.
    pub cell: f32,
    /// Cells along each axis; those along x are a multiple of 8.
    pub size: [usize; 3],
    /// How it moves.
    pub air: Motion,
    /// Sets a grid to the voxels at a step, from 1 on: a pure function of that. It comes as another step left it.
    pub figure: fn(u32, &mut Voxels),
    /// Where the scene's first two lights are, world: what comes of them through the smoke is a part of its
    /// state, so they stay there. Light of others, which are best within, isn't dimmed.
    pub lamps: [Vec3; 2],
    /// Extinction per world unit and unit of density.
    pub extinction: f32,
    /// Share of the extinction by which light on its way from the lamps is lost; less than 1 stands for
    /// what is scattered more than once.
    pub depth: f32,
    /// Share of light that is scattered, not swallowed, linear RGB.
    pub albedo: Vec3,
    /// Two phase functions of Schlick's, (1 - k²) / (4π (1 - k cos)²): the weight of the first, and each
    /// one's k, which for Henyey and Greenstein's g is about 1.55 g - 0.55 g³ (Blasi et al. 1993).
    pub phase: [f32; 3],
    /// Factor on the light of lamps.
    pub gain: f32,
    /// Light scattered from all around, linear RGB.
    pub ambient: Vec3,
    /// Light given off per unit of temperature, linear RGB.
    pub glow: Vec3,
    /// Whether bodies cast shadows on it: a ray to each lamp from each place that is marched through.
    pub shaded: bool,
}

impl Rules {
    /// A kind of smoke, without place or size, in still air.
    pub const fn new(figure: fn(u32, &mut Voxels)) -> Self {
        Self {
            lo: Vec3::ZERO,
            cell: 1.0,
            size: [0; 3],
            air: Air::DEFAULT.motion(1.0),
            figure,
            lamps: [Vec3::ZERO; 2],
            extinction: 1.0,
            depth: 1.0,
            albedo: Vec3::ONE,
            phase: [1.0, 0.0, 0.0],
            gain: 1.0,
            ambient: Vec3::ZERO,
            glow: Vec3::ZERO,
            shaded: false,
        }
    }

    /// The corner opposite to `lo`.
    pub fn hi(&self) -> Vec3 {
        self.lo + Vec3::from_array(self.size.map(|n| n as f32)) * self.cell
    }
}

/// Smoke at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Smoke {
    /// What it is: the same rules run through the same states.
    pub rules: &'static Rules,
    /// Steps that it has taken.
    pub steps: u32,
    /// Weight of the step before in what is shown, for frames between two steps, 0 to 1.
    pub behind: f32,
}
