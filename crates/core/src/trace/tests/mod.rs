//! Hard cases of the kernels, against f64: see [`super::check`] for what scores mean.

mod flat;
mod packets;
mod round;
mod secondary;
mod slender;
mod sphere;
mod texture;
