//! One frame, from scene to pixels.

mod frame;
mod stage;
mod view;

pub use frame::Renderer;
pub use stage::{Stage, Tables};
pub use view::{FARTHEST, MOST_STEPS, View};
