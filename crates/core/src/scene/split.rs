//! A frame that is sampled in two ways, parted by a line, to show what they cost.
//!
//! Left of the line every pixel is traced; right of it the frame is sampled adaptively, as ever. The
//! rays of each side are counted, and the error of the right side is measured: each of its pixels that
//! has no ray of its own is held against one, at its centre and before edges get their further samples.
//! Those rays are not counted as its cost. To measure only some pixels would not do: most of the
//! error is that of a few, and one in four tells 10 dB too much or 3 too little.

use super::{Beam, Camera, Grade};

/// Where the line is, and what is written about the two sides.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// Where the line crosses the middle of the picture, from -1 at the left to 1 at the right.
    pub x: f32,
    /// How far it leans to the right, half widths per half height.
    pub slant: f32,
    /// How brightly it shines, for the titles.
    pub light: f32,
    /// Adds to an empty list the beams that are drawn over the finished picture when the figures are known, and
    /// gives the camera and grade by which they are.
    pub titles: fn(&Figures, &mut Vec<Beam>) -> (Camera, Grade),
}

/// What the sides of a split frame cost.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Where the line was.
    pub split: Split,
    /// Height of the picture over its width.
    pub height: f32,
    /// Rays of all kinds, left and right of the line.
    pub rays: [u64; 2],
    /// Mean squared error of display values on the right side, 1 being white.
    pub error: f32,
}
