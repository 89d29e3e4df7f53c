//! What can't matter is left out: bounds of shapes as seen from an eye or a lamp.

mod bounds;
mod cover;
mod dop;
mod node;
mod shaft;
#[cfg(test)]
mod tests;

pub use bounds::Bounds;
pub use cover::may_cover;
pub use dop::{Dop, View, dops};
pub use node::{FieldNode, field_nodes};
pub use shaft::{Region, Shaft, occluders, shafts};
