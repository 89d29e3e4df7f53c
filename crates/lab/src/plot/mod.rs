//! Charts as SVG files: points and lines over two axes, with labels that keep out of each other's way.
//!
//! A writer of our own keeps the files small and the same byte for byte.

mod axis;
mod labels;
mod svg;

pub use axis::Axis;
pub use svg::{draw, page};

/// Colours that colour-blind viewers can tell apart (Okabe and Ito 2008), and three greys.
pub const COLOURS: [&str; 10] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d1f", "#444444", "#999999",
    "#6a3d9a",
];

/// How the points of a series look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// Small dots.
    Dots,
    /// A line without dots.
    Line,
    /// A dashed line without dots.
    Dashes,
    /// Dots joined by a line.
    Path,
    /// Large dots.
    Marks,
}

/// A place in a chart.
#[derive(Clone, Debug)]
pub struct Point {
    /// Along the lower side.
    pub x: f64,
    /// Along the left side.
    pub y: f64,
    /// Text beside it.
    pub label: String,
    /// From where to where x may be, drawn as a thin bar.
    pub spread: Option<(f64, f64)>,
}

impl Point {
    /// A point with no more than a place.
    pub fn at(x: f64, y: f64) -> Self {
        Self { x, y, label: String::new(), spread: None }
    }
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// As the legend calls it; without a name it isn't in the legend.
    pub name: String,
    /// Colour as CSS.
    pub colour: &'static str,
    /// How it looks.
    pub look: Look,
    /// Its points in order.
    pub points: Vec<Point>,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Over it.
    pub title: String,
    /// Lower side.
    pub x: Axis,
    /// Left side.
    pub y: Axis,
    /// What it shows; later ones lie over earlier ones.
    pub series: Vec<Series>,
}
