//! Renders one frame.

/// Buffers that live from frame to frame.
#[derive(Default)]
pub struct Renderer {}
