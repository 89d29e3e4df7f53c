//! Parts of the method that only a study of their worth takes away.
//!
//! Without the feature `study` the struct is empty and every answer is a constant, so the intro's
//! compiler drops the questions.

/// How a frame departs from the show's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Study {
    /// Whether cells have a sample in their centre; without it equal signatures at the corners suffice.
    #[cfg(feature = "study")]
    pub centre: bool,
    /// Share of a field's value that a marching ray advances by: over 1 it may pass through bodies.
    #[cfg(feature = "study")]
    pub pace: f32,
    /// Octaves of the bloom, 2 to 4.
    #[cfg(feature = "study")]
    pub octaves: usize,
}

impl Study {
    /// The show's method.
    pub const NONE: Study = Study {
        #[cfg(feature = "study")]
        centre: true,
        #[cfg(feature = "study")]
        pace: 1.0,
        #[cfg(feature = "study")]
        octaves: 4,
    };

    /// Whether cells have a sample in their centre.
    #[inline(always)]
    pub fn centre(&self) -> bool {
        #[cfg(feature = "study")]
        return self.centre;
        #[cfg(not(feature = "study"))]
        true
    }

    /// Factor on the steps of marching rays, unless it is 1.
    #[inline(always)]
    pub fn pace(&self) -> Option<f32> {
        #[cfg(feature = "study")]
        return (self.pace != 1.0).then_some(self.pace);
        #[cfg(not(feature = "study"))]
        None
    }

    /// Octaves of the bloom, of `all`.
    #[inline(always)]
    pub fn octaves(&self, all: usize) -> usize {
        #[cfg(feature = "study")]
        return self.octaves.clamp(2, all);
        #[cfg(not(feature = "study"))]
        all
    }
}
