//! Light at surfaces and along rays: direct light, background, fog, mirrors and glass.

mod background;
mod beam;
pub mod dielectric;
mod direct;
pub mod extinction;
mod fog;
mod fresnel;
mod ggx;
mod lamps;
pub mod phase;
mod points;

pub use background::{background, emitters};
pub use beam::beam;
pub use direct::{Codes, Lit, Local, MAX_LAMPS, Visibility, ambient, beckmann, direct, local, tinted};
pub use fog::fog;
pub use fresnel::{Refracted, Split, refract, schlick, split};
pub use ggx::{distribution, masking, sample, visibility};
pub use lamps::{Lamp, lamps};
pub use points::{MAX_POINTS, Mask, Points};
