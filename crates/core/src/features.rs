//! Machinery that an executable has only if it asks for it, by cargo features of this crate.
//!
//! Ordinary builds have everything. The size build has what the show's manifest names, and a test
//! holds that against what the plans of the show call for. Code asks with `if features::X`, so all
//! of it is always compiled, and the compiler drops what can't be reached.

use crate::counters::Counter;

/// Triangles that stand alone.
pub const TRIANGLES: bool = cfg!(feature = "triangles");
/// Trowbridge and Reitz's microfacets.
pub const GGX: bool = cfg!(feature = "ggx");
/// Relief from patterns.
pub const BUMPS: bool = cfg!(feature = "bumps");
/// Signed distance fields.
pub const FIELDS: bool = cfg!(feature = "fields");
/// Grids of voxels.
pub const VOXELS: bool = cfg!(feature = "voxels");
/// Smoke, simulated.
pub const SMOKE: bool = cfg!(feature = "smoke");
/// Shadows of bodies on smoke.
pub const SMOKE_SHADOWS: bool = cfg!(feature = "smoke-shadows");
/// Whirls in smoke that are kept turning.
pub const SWIRL: bool = cfg!(feature = "swirl");
/// Ambient occlusion by fields.
pub const FIELD_OCCLUSION: bool = cfg!(feature = "field-occlusion");
/// Soft shadows by fields.
pub const FIELD_SHADOWS: bool = cfg!(feature = "field-shadows");
/// Beams of light.
pub const BEAMS: bool = cfg!(feature = "beams");
/// Bounds of cylinders without ends; without it their shadows are sought everywhere.
pub const ENDLESS: bool = cfg!(feature = "endless");
/// Bounces of diffuse light.
pub const BOUNCES: bool = cfg!(feature = "bounces");
/// Mirrors of rough surfaces by several rays.
pub const ROUGH: bool = cfg!(feature = "rough");
/// Shadows of shining rectangles by several rays.
pub const SOFT_SHADOWS: bool = cfg!(feature = "soft-shadows");
/// Lamps in whose light nothing casts a shadow.
pub const FILL: bool = cfg!(feature = "fill");
/// Small lights in great number.
pub const POINTS: bool = cfg!(feature = "points");
/// Triangle meshes.
pub const MESHES: bool = cfg!(feature = "meshes");
/// Meshes with interpolated normals.
pub const SMOOTH: bool = cfg!(feature = "smooth");

/// Images on meshes.
pub const IMAGES: bool = cfg!(feature = "images");

/// See [`crate::scene::Pattern::Cells`].
pub const CELLS: bool = cfg!(feature = "cells");
/// See [`crate::scene::Pattern::Stripes`].
pub const STRIPES: bool = cfg!(feature = "stripes");
/// See [`crate::scene::Pattern::Brick`].
pub const BRICK: bool = cfg!(feature = "brick");
/// See [`crate::scene::Pattern::Scratches`].
pub const SCRATCHES: bool = cfg!(feature = "scratches");

/// Frames as the mean of several sample patterns.
pub const AVERAGE: bool = cfg!(feature = "average");
/// PNG files by codes; without it they are stored, three bytes a pixel.
pub const DEFLATE: bool = cfg!(feature = "deflate");
/// Frames that are sampled in two ways.
pub const SPLIT: bool = cfg!(feature = "split");
/// The chain of effects, with at least one of them.
pub const EFFECTS: bool = cfg!(feature = "effects");
/// See [`crate::scene::Kind::Contrast`].
pub const EFFECT_CONTRAST: bool = cfg!(feature = "effect-contrast");
/// See [`crate::scene::Kind::Tint`].
pub const EFFECT_TINT: bool = cfg!(feature = "effect-tint");
/// See [`crate::scene::Kind::Bloom`].
pub const EFFECT_BLOOM: bool = cfg!(feature = "effect-bloom");
/// See [`crate::scene::Kind::WideBloom`].
pub const EFFECT_WIDE_BLOOM: bool = cfg!(feature = "effect-wide-bloom");
/// See [`crate::scene::Kind::Sharpness`].
pub const EFFECT_SHARPNESS: bool = cfg!(feature = "effect-sharpness");
/// See [`crate::scene::Kind::Levels`].
pub const EFFECT_LEVELS: bool = cfg!(feature = "effect-levels");
/// See [`crate::scene::Kind::Fringes`].
pub const EFFECT_FRINGES: bool = cfg!(feature = "effect-fringes");
/// See [`crate::scene::Kind::Edges`].
pub const EFFECT_EDGES: bool = cfg!(feature = "effect-edges");
/// See [`crate::scene::Kind::Cells`].
pub const EFFECT_CELLS: bool = cfg!(feature = "effect-cells");
/// See [`crate::scene::Kind::Lighten`].
pub const EFFECT_LIGHTEN: bool = cfg!(feature = "effect-lighten");
/// See [`crate::scene::Kind::Tube`].
pub const EFFECT_TUBE: bool = cfg!(feature = "effect-tube");
/// See [`crate::scene::Kind::Grain`].
pub const EFFECT_GRAIN: bool = cfg!(feature = "effect-grain");

/// Each feature with the counter that shows it at work.
pub const ALL: [(&str, Counter); 37] = [
    ("triangles", Counter::TriangleTests),
    ("ggx", Counter::Ggx),
    ("bumps", Counter::Bumps),
    ("fields", Counter::FieldSteps),
    ("field-occlusion", Counter::FieldOcclusion),
    ("field-shadows", Counter::FieldShadows),
    ("voxels", Counter::VoxelSteps),
    ("smoke", Counter::SmokeShown),
    ("smoke-shadows", Counter::SmokeShadowRays),
    ("swirl", Counter::SmokeSwirled),
    ("beams", Counter::Beams),
    ("endless", Counter::EndlessTests),
    ("bounces", Counter::ScatterRays),
    ("rough", Counter::RoughRays),
    ("soft-shadows", Counter::SoftShadowRays),
    ("fill", Counter::FillLights),
    ("points", Counter::PointLights),
    ("meshes", Counter::NodeVisits),
    ("smooth", Counter::SmoothFacets),
    ("images", Counter::ImageLookups),
    ("cells", Counter::Cells),
    ("stripes", Counter::Stripes),
    ("brick", Counter::Brick),
    ("scratches", Counter::Scratches),
    ("split", Counter::Measured),
    ("effect-contrast", Counter::Contrast),
    ("effect-tint", Counter::Tint),
    ("effect-bloom", Counter::Bloom),
    ("effect-wide-bloom", Counter::WideBloom),
    ("effect-sharpness", Counter::Sharpness),
    ("effect-levels", Counter::Levels),
    ("effect-fringes", Counter::Fringes),
    ("effect-edges", Counter::Edges),
    ("effect-cells", Counter::CellBorders),
    ("effect-lighten", Counter::Lighten),
    ("effect-tube", Counter::Tube),
    ("effect-grain", Counter::Grain),
];
