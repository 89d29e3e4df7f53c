//! From linear light to the pixels of the screen.

mod bloom;
mod chain;
mod display;
mod effect;
mod finish;
mod picture;

pub use display::Display;
pub use finish::{KEEPS, Post};
