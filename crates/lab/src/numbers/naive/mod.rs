//! The formulas as textbooks have them, for comparison only: what they lose is seen beside the engine's.
//!
//! Each takes its arguments in the order that `cases` gives, and returns one number: for shapes the
//! nearest crossing in front of the ray, NaN for none.

mod forms;
mod light;
mod shapes;

pub use forms::*;
pub use light::*;
pub use shapes::*;
