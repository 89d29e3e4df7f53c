//! One frame, from scene to pixels.

mod frame;
mod stage;

pub use frame::Renderer;
pub use stage::Stage;
