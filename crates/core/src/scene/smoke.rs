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
    /// Downward acceleration per unit of density.
    pub weight: f32,
    /// Strength by which whirls are kept from being lost in the grid, 0 for none.
    pub whirl: f32,
    /// Acceleration of all smoke, for wind.
    pub wind: Vec3,
    /// Rate at which density is lost.
    pub fade: f32,
    /// Rate at which temperature is lost.
    pub cool: f32,
    /// Rate at which velocity is lost.
    pub drag: f32,
    /// Sweeps of the pressure a step.
    pub sweeps: u32,
}

impl Air {
    /// Length of a step.
    pub const SECONDS: f32 = 1.0 / 30.0;

    /// Still air that keeps what it has.
    pub const DEFAULT: Self = Self {
        density: 1.0,
        heat: 1.0,
        lift: 0.0,
        weight: 0.0,
        whirl: 0.0,
        wind: Vec3::ZERO,
        fade: 0.0,
        cool: 0.0,
        drag: 0.0,
        sweeps: 16,
    };
}

/// Smoke in a box. It begins without any, and what it is after so many steps follows from the
/// [`Voxels`] at each of them: solid ones are in its way, those of value [`Voxels::SMOKE`] fill their
/// place with it.
#[derive(Clone, Copy, Debug)]
pub struct Smoke {
    /// Least corner, world.
    pub lo: Vec3,
    /// Side of a cell, world units.
    pub cell: f32,
    /// Cells along each axis; those along x are a multiple of 8.
    pub size: [usize; 3],
    /// How it moves.
    pub air: Air,
    /// The voxels at a step, from 1 on: a pure function.
    pub figure: fn(u32) -> Voxels,
    /// Steps that it has taken.
    pub steps: u32,
    /// Weight of the step before in what is shown, for frames between two steps, 0 to 1.
    pub behind: f32,
    /// Extinction per world unit and unit of density.
    pub extinction: f32,
    /// Share of the extinction by which light on its way from the lamps is lost; less than 1 stands for
    /// what is scattered more than once.
    pub depth: f32,
    /// Share of light that is scattered, not swallowed, linear RGB.
    pub albedo: Vec3,
    /// Two phase functions of Henyey and Greenstein: the weight of the first, and each one's g.
    pub phase: [f32; 3],
    /// Factor on the light of lamps.
    pub gain: f32,
    /// Light scattered from all around, linear RGB.
    pub ambient: Vec3,
    /// Light given off per unit of temperature, linear RGB.
    pub glow: Vec3,
}

impl Smoke {
    /// A kind of smoke, without place or size.
    pub const fn new(figure: fn(u32) -> Voxels) -> Self {
        Self {
            lo: Vec3::ZERO,
            cell: 1.0,
            size: [0; 3],
            air: Air::DEFAULT,
            figure,
            steps: 0,
            behind: 0.0,
            extinction: 1.0,
            depth: 1.0,
            albedo: Vec3::ONE,
            phase: [1.0, 0.0, 0.0],
            gain: 1.0,
            ambient: Vec3::ZERO,
            glow: Vec3::ZERO,
        }
    }

    /// The corner opposite to `lo`.
    pub fn hi(&self) -> Vec3 {
        self.lo + Vec3::from_array(self.size.map(|n| n as f32)) * self.cell
    }

    /// Whether both run through the same states, however far they have come.
    pub fn moves_like(&self, other: &Smoke) -> bool {
        std::ptr::fn_addr_eq(self.figure, other.figure)
            && (self.lo, self.cell, self.size, self.air) == (other.lo, other.cell, other.size, other.air)
    }
}
