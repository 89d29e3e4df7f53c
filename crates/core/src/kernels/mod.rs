//! Every formula of the engine for one ray, one angle or one number: f32 in, f32 out.
//!
//! These are doors, not second implementations: each puts its arguments into all eight lanes of the
//! engine's own routine and reads one lane, so a result is that of the packet bit for bit. They are
//! for measuring the formulas from outside, and for whoever needs a single ray; the engine calls the
//! packets.
//!
//! In two things doors go beyond packets. A ray's direction may have any length, down to subnormal numbers: a power of
//! two, which changes no bit, brings it to 1 and the distances back. And [`ggx`], [`beckmann`] and [`refract`], of
//! which f32 can't hold 4 ulp, are f64 inside; what their packets lose stands with each.
//!
//! The shapes stand in [`wide`] once more, f64 inside and within 1 ulp: second implementations, for who needs them.
//!
//! | here | packets | source |
//! |---|---|---|
//! | [`sphere`], [`plane`], [`cylinder`], [`capped_cylinder`], [`cone`], [`capped_cone`], [`triangle`] | the same names in [`trace`](crate::trace) | with each |
//! | [`slab`] | [`Rays8::in_box`] | Ize, JCGT 2(2), 2013 |
//! | [`walk`] | [`Walk`], [`voxels`] | Amanatides and Woo 1987 |
//! | [`quadratic`], [`difference_of_products`] | the same in [`lanes`] | Kahan |
//! | [`schlick`], [`refract`] | [`shade::schlick`], [`shade::refract`] | Schlick 1994 |
//! | [`fresnel`], [`cos_refracted`], [`is_total`] | [`shade::dielectric`] | Fresnel 1823 |
//! | [`ggx`], [`ggx_of_cosine`], [`smith_g1`], [`smith_g2`] | [`shade::distribution`], [`shade::masking`], [`shade::visibility`] | Walter et al. 2007, Heitz 2014 |
//! | [`beckmann`], [`beckmann_of_cosine`] | [`shade::beckmann`] | Beckmann and Spizzichino 1963 |
//! | [`henyey_greenstein`], [`sample_henyey_greenstein`] | [`shade::phase`] | Henyey and Greenstein 1941 |
//! | [`Extinction`], [`homogeneous`] | [`shade::extinction`] | Bouguer, Lambert, Beer |
//! | [`sdf`], [`field_distance`], [`march`], [`smooth_union`] and alike, [`fold`], [`repeat`] | [`trace::form`], [`trace::distance`], [`trace::field`], [`trace::smooth_min`], [`trace::folded`], [`trace::repeated`] | Hart 1996, Quilez |
//! | [`basis`], [`cosine_weighted`] | [`sampling`](crate::math::sampling) | Duff et al. 2017 |
//! | [`scalar`]: sin, cos, exp, ln, pow, … | [`lanes_fn`](crate::math::lanes_fn) | with each |
//!
//! **Units.** Lengths and distances are world units, angles are given by their cosines, indices of
//! refraction and densities are ratios, light is a share. Directions and normals are unit vectors
//! where so named: within 2u of length 1, u = 2⁻²⁴.
//!
//! **Range.** Rays: squares of origins and sizes must not leave the range of f32 (1e-19 to 1e18); a direction is
//! anything but 0, though packets need its squares within that range too. Anything else, infinities and NaN
//! included, gives some number or nothing, but no panic, and no NaN where the exact result is a number. Hits whose
//! distance f32 can't hold are none.
//!
//! **Errors** are told in two ways. Of shading terms and elementary functions, in ulp of the exact result for
//! the given f32 arguments. Of what rays meet as a *score*: the error over what moving the shape by
//! u (|o - c| + r + |t d|), the rounding of the ray itself, changes in the exact result, or over half
//! an ulp where that is more. Backward stable f32 scores about 1. `docs/numbers.md` has those
//! reached over millions of random cases, and `cargo lab numbers` makes it anew.
//!
//! ```
//! use glam::Vec3;
//! use luc_core::kernels::{Ray, sphere};
//!
//! // From 10 km away, half way up a ball of radius 1.
//! let ray = Ray { origin: Vec3::new(0.0, 0.5, -1e4), direction: Vec3::Z };
//! let hit = sphere(&ray, Vec3::ZERO, 1.0).unwrap();
//! assert_eq!(hit.enter, 9999.134);
//! ```
//!
//! [`Rays8::in_box`]: crate::trace::Rays8::in_box
//! [`Walk`]: crate::trace::Walk
//! [`voxels`]: crate::trace::voxels()
//! [`lanes`]: crate::math::lanes
//! [`shade::schlick`]: crate::shade::schlick
//! [`shade::refract`]: crate::shade::refract
//! [`shade::dielectric`]: crate::shade::dielectric
//! [`shade::distribution`]: crate::shade::distribution
//! [`shade::masking`]: crate::shade::masking
//! [`shade::visibility`]: crate::shade::visibility
//! [`shade::beckmann`]: crate::shade::beckmann
//! [`shade::phase`]: crate::shade::phase
//! [`shade::extinction`]: crate::shade::extinction
//! [`trace::form`]: crate::trace::form
//! [`trace::distance`]: crate::trace::distance
//! [`trace::field`]: crate::trace::field()
//! [`trace::smooth_min`]: crate::trace::smooth_min
//! [`trace::folded`]: crate::trace::folded
//! [`trace::repeated`]: crate::trace::repeated

mod cells;
mod directions;
mod facets;
mod fields;
mod media;
mod optics;
mod shapes;
pub mod wide;

pub use crate::math::quadratic::roots as quadratic;
pub use crate::math::scalar;
pub use cells::{Visit, walk};
pub use directions::{basis, cosine_weighted};
pub use facets::{beckmann, beckmann_of_cosine, ggx, ggx_of_cosine, smith_g1, smith_g2};
pub use fields::{
    field_distance, field_light, fold, march, repeat, sdf, smooth_intersection, smooth_subtraction,
    smooth_union,
};
pub use media::{Extinction, henyey_greenstein, homogeneous, sample_henyey_greenstein};
pub use optics::{cos_refracted, fresnel, is_total, refract, schlick};
pub use shapes::{
    Crossing, Ray, TriangleHit, capped_cone, capped_cylinder, cone, cylinder, plane, slab, sphere, triangle,
};

use crate::math::lanes::{self, F, splat};

/// a b - c d within 0.5001 ulp: see [`lanes::difference_of_products`].
pub fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    first(lanes::difference_of_products(splat(a), splat(b), splat(c), splat(d)))
}

/// The first lane.
fn first(lanes: F) -> f32 {
    lanes.as_array()[0]
}
