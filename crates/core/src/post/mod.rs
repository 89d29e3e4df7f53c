//! From linear light to the pixels of the screen.

mod display;
mod finish;

pub use display::Display;
pub use finish::finish;
