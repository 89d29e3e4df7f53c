//! Light at surfaces and along rays: direct light, background, fog, mirrors and glass.

mod background;
mod beam;
mod direct;
mod fog;
mod fresnel;
mod ggx;
mod lamps;
mod points;

pub use background::{background, emitters};
pub use beam::beam;
pub use direct::{Codes, Lit, Local, MAX_LAMPS, Visibility, ambient, direct, local};
pub use fog::fog;
pub use fresnel::{Split, schlick, split};
pub use ggx::sample;
pub use lamps::{Lamp, lamps};
pub use points::{MAX_POINTS, Mask, Points};
