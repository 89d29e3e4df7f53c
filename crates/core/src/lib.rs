//! The engine of Lúč.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod output;
pub mod quality;
pub mod render;
