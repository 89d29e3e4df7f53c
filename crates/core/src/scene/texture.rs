//! Patterns that vary a surface: computed where they are seen, never stored.

/// A field of three dimensions from -1 to 1, with cells of side 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Pattern {
    /// Value noise.
    #[default]
    Noise,
    /// Rounded stones with creases between them.
    Cells,
    /// Level layers.
    Stripes,
    /// Bricks 1 wide and ½ high with joints, on the plane that the surface faces most.
    Brick,
    /// Thin long grooves on that plane.
    Scratches,
}

impl Pattern {
    /// Width of the finest detail, cells.
    pub const fn finest(self) -> f32 {
        match self {
            Pattern::Noise => 1.0,
            Pattern::Cells | Pattern::Stripes => 0.5,
            Pattern::Brick => 0.16,
            Pattern::Scratches => 0.12,
        }
    }
}

/// A pattern in world space that varies a surface's albedo, its normal, or both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// What varies.
    pub pattern: Pattern,
    /// Cells of the pattern per world unit.
    pub scale: f32,
    /// How much the albedo varies, 0 to 1.
    pub grain: f32,
    /// Height of the relief that bends the normal: that of a surface which is moved out by the
    /// pattern times this, world units.
    pub bump: f32,
}

impl Texture {
    /// An even surface.
    pub const NONE: Self = Self { pattern: Pattern::Noise, scale: 1.0, grain: 0.0, bump: 0.0 };

    /// Whether anything varies.
    pub fn is_visible(&self) -> bool {
        self.grain > 0.0 || self.bump > 0.0
    }
}

impl Default for Texture {
    fn default() -> Self {
        Self::NONE
    }
}
