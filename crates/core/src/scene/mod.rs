//! What is drawn: plain data, one list per kind of shape, no behaviour.
//!
//! A scene is made anew for each frame by the show's pure functions of time. Shapes of all kinds
//! share one index space, [`Scene::shape_count`] long: spheres first, then planes, cylinders,
//! cones, triangles, voxels and fields, each in list order. Facets of meshes follow. Right-handed, y up,
//! world units.

mod background;
mod beam;
mod camera;
mod effect;
mod field;
mod light;
mod material;
mod shapes;
mod smoke;
mod split;
mod texture;
mod track;
mod voxels;

pub use background::{Background, Disc, Glow, Stop};
pub use beam::Beam;
pub use camera::Camera;
pub use effect::{Effect, Kind, Place};
pub use field::{Field, Form, Join, Node};
pub use light::{Emitter, Light, LightKind, PointLight};
pub use material::{Channel, Fire, Material};
pub use shapes::{Cone, Cylinder, Plane, Sphere, Triangle};
pub use smoke::{Air, Motion, Rules, Smoke};
pub use split::{Figures, Split};
pub use texture::{Pattern, Texture};
pub use track::{Ease, Key, track};
pub use voxels::{Edit, Voxels};

use crate::math::Vec3;
use crate::mesh::Assembly;

/// How light that arrives directly from a lamp is reflected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Lambert plus (r·v)^n: Phong 1975.
    #[default]
    Phong,
    /// Lambert plus Schlick Fresnel, Beckmann distribution and the V-cavity geometry term:
    /// Cook and Torrance 1982.
    CookTorrance,
    /// Lambert plus Schlick Fresnel, Trowbridge and Reitz's distribution and Smith's
    /// height-correlated shadowing: Walter et al. 2007, Heitz 2014.
    Ggx,
}

/// Constant in-scatter inside a box: `c exp(-density d) + colour (1 - exp(-density d))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Extinction per world unit.
    pub density: f32,
    /// Colour of a thick layer, linear RGB.
    pub colour: Vec3,
    /// Least corner of the box that holds the fog.
    pub lo: Vec3,
    /// Greatest corner.
    pub hi: Vec3,
}

/// How the linear picture becomes display values; see [`crate::post`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grade {
    /// Factor on linear light before the tone map.
    pub exposure: f32,
    /// Light over this spreads, in exposed units.
    pub bloom_threshold: f32,
    /// How much of it, 0 for none.
    pub bloom: f32,
    /// Display value of black.
    pub lift: Vec3,
    /// Exponent divisor per channel: under 1 deepens the middle.
    pub gamma: Vec3,
    /// Display value of white.
    pub gain: Vec3,
    /// Darkening of the corners, 0 to 1.
    pub vignette: f32,
    /// Half amplitude of the dither and grain, in display units.
    pub grain: f32,
}

impl Grade {
    /// Nothing but the dither.
    pub const DEFAULT: Self = Self {
        exposure: 1.0,
        bloom_threshold: 1.0,
        bloom: 0.0,
        lift: Vec3::ZERO,
        gamma: Vec3::ONE,
        gain: Vec3::ONE,
        vignette: 0.0,
        grain: 0.5 / 255.0,
    };
}

impl Default for Grade {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Everything a frame shows.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The eye.
    pub camera: Camera,
    /// What is seen where nothing is hit.
    pub background: Background,
    /// Spheres; opaque or transparent.
    pub spheres: Vec<Sphere>,
    /// Infinite planes; opaque.
    pub planes: Vec<Plane>,
    /// Cylinders, finite or infinite.
    pub cylinders: Vec<Cylinder>,
    /// Cones and frusta, finite or infinite.
    pub cones: Vec<Cone>,
    /// Single triangles.
    pub triangles: Vec<Triangle>,
    /// Grids of solid cells; opaque.
    pub voxels: Vec<Voxels>,
    /// Bodies as signed distance fields.
    pub fields: Vec<Field>,
    /// Distance up to which fields take ambient light from what is near them, world units; 0 for
    /// not at all.
    pub occlusion: f32,
    /// Radius of lamps in whose light fields cast soft shadows, world units; 0 for hard ones. Where
    /// several rays go to a shining rectangle, they tell its shadow instead.
    #[cfg(feature = "field-shadows")]
    pub penumbra: f32,
    /// Triangle meshes, placed.
    pub meshes: Assembly,
    /// What shapes are made of; shapes hold indices into this list.
    pub materials: Vec<Material>,
    /// Lamps that are not seen themselves.
    pub lights: Vec<Light>,
    /// Rectangles that shine; seen in mirrors and through glass.
    pub emitters: Vec<Emitter>,
    /// Beams of light in the haze; they light nothing themselves.
    pub beams: Vec<Beam>,
    /// Small lights without shadow, at most 512.
    pub points: Vec<PointLight>,
    /// The reflection model for direct light.
    pub shading: Shading,
    /// Bounces of diffuse light that rays follow where the quality has samples for them, 0 to 3; after
    /// the last one, or without, the ambient light stands for them.
    pub bounces: u32,
    /// Whether a rough mirror is drawn as several rays where the quality has them; else one stands for them.
    pub rough: bool,
    /// Whether shining rectangles cast soft shadows, where the quality has rays for them; else those of
    /// lamps in their middles.
    pub soft: bool,
    /// Light from everywhere below (normal down) and above (normal up), mixed by the normal's y.
    pub ambient: [Vec3; 2],
    /// Haze, if the scene has any.
    pub fog: Option<Fog>,
    /// Smoke that moves, if the scene has any.
    pub smoke: Option<Smoke>,
    /// Grading of the finished picture.
    pub grade: Grade,
    /// Effects on the graded picture, in their order; vignette and grain come after them.
    pub effects: Vec<Effect>,
    /// A line on either side of which the frame is sampled in another way.
    pub split: Option<Split>,
    /// Show how the frame was sampled, on this share of the picture's width from the left.
    pub overlay: f32,
    /// Show how many small lights reach the surfaces of each tile, over the picture with this
    /// weight, 0 to 1.
    pub light_count: f32,
}

impl Scene {
    /// An empty scene: [`Scene::default`] as one function, which is large, for all who call it.
    #[inline(never)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Radius of lamps for the shadows of fields; 0 in builds that can't draw these.
    pub fn penumbra(&self) -> f32 {
        #[cfg(feature = "field-shadows")]
        return self.penumbra;
        #[cfg(not(feature = "field-shadows"))]
        0.0
    }

    /// Whether some shape's surface is known between samples, which that of fields is not.
    pub fn has_known_surfaces(&self) -> bool {
        self.shape_count() > self.fields.len() || !self.meshes.is_empty()
    }

    /// Number of shapes of all kinds together; facets of meshes are numbered after them.
    pub fn shape_count(&self) -> usize {
        self.spheres.len()
            + self.planes.len()
            + self.cylinders.len()
            + self.cones.len()
            + self.triangles.len()
            + self.voxels.len()
            + self.fields.len()
    }
}
