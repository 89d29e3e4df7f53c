//! From linear light to the pixels of the screen.

mod bloom;
mod display;
mod finish;

pub use bloom::{Bloom, Glow};
pub use display::Display;
pub use finish::finish;
