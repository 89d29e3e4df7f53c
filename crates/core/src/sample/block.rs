//! What is known of traced samples, in blocks of eight: a packet's results are stored as vectors.

use crate::math::lanes::{F, U, V3, splat};
use crate::math::{Vec3, number, whole};
use crate::quality::Rung;
use crate::render::Stage;
use crate::scene::{Material, Voxels};
use crate::shade::Codes;
use crate::trace::{Shape, relief_within};

/// Eight samples that were traced as one packet.
#[derive(Clone, Copy, Default)]
pub struct Block {
    /// Linear light.
    pub colour: V3,
    /// The share of `colour` that came straight from the first hit; the rest came by mirrors and
    /// glass.
    pub direct: V3,
    /// Light that falls on the first surface, before its albedo, as it reaches the eye.
    pub irradiance: V3,
    /// Albedo of the first surface.
    pub albedo: V3,
    /// `colour` as it will be displayed, 0 to 1.
    pub display: V3,
    /// Hash of the shape hit first and the visibility of each lamp there.
    pub surface: U,
    /// Hash of the shapes hit second and (through glass) third, by mirrors and refraction, with
    /// the visibility of each lamp there. Samples with both hashes equal see the same things.
    pub signature: U,
    /// What the first ray hit, see [`crate::trace::Hits`].
    pub id: F,
    /// Depth of the first hit along the view axis.
    pub depth: F,
    /// First hit, world.
    pub point: V3,
    /// Shading normal there.
    pub normal: V3,
    /// Node of a field that has most of the surface there.
    pub node: F,
    /// Visibility of the lamps there.
    pub codes: Codes,
}

/// One sample: a lane of a block.
#[derive(Clone, Copy)]
pub struct Sample<'a> {
    block: &'a Block,
    lane: usize,
}

/// Samples, `8 * block + lane` their index.
#[derive(Default)]
pub struct Samples(pub Vec<Block>);

impl Samples {
    /// The sample at an index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Sample<'_> {
        Sample { block: &self.0[index >> 3], lane: index & 7 }
    }

    /// Adds light that came by mirrors or glass, and `hash` of what it met, if it counts.
    #[inline(always)]
    pub fn add(&mut self, index: usize, light: Vec3, hash: Option<u32>) {
        let (block, lane) = (&mut self.0[index >> 3], index & 7);
        block.colour.set_lane(lane, block.colour.lane(lane) + light);
        if let Some(hash) = hash {
            let signature = &mut block.signature.as_mut_array()[lane];
            *signature = crate::math::hash::mix(*signature, hash);
        }
    }
}

#[allow(missing_docs, reason = "the fields of Block say what they are")]
impl<'a> Sample<'a> {
    pub fn colour(self) -> Vec3 {
        self.block.colour.lane(self.lane)
    }
    pub fn direct(self) -> Vec3 {
        self.block.direct.lane(self.lane)
    }
    pub fn indirect(self) -> Vec3 {
        self.colour() - self.direct()
    }
    pub fn irradiance(self) -> Vec3 {
        self.block.irradiance.lane(self.lane)
    }
    pub fn albedo(self) -> Vec3 {
        self.block.albedo.lane(self.lane)
    }
    pub fn display(self) -> Vec3 {
        self.block.display.lane(self.lane)
    }
    pub fn surface(self) -> u32 {
        self.block.surface.as_array()[self.lane]
    }
    pub fn signature(self) -> u32 {
        self.block.signature.as_array()[self.lane]
    }
    pub fn id(self) -> f32 {
        self.block.id.as_array()[self.lane]
    }
    pub fn depth(self) -> f32 {
        self.block.depth.as_array()[self.lane]
    }
    pub fn point(self) -> Vec3 {
        self.block.point.lane(self.lane)
    }
    pub fn normal(self) -> Vec3 {
        self.block.normal.lane(self.lane)
    }
    pub fn node(self) -> f32 {
        self.block.node.as_array()[self.lane]
    }
    /// The shape of the first hit.
    fn shape<'s>(self, stage: &Stage<'s>) -> Option<Shape<'s>> {
        (self.id() >= 0.0).then(|| stage.scene.shape(whole(self.id()) >> 2))
    }
    /// What the first hit is made of, if its surface is known between samples: a field's is not.
    pub fn material<'s>(self, stage: &Stage<'s>) -> Option<&'s Material> {
        let shape = self.shape(stage)?;
        if matches!(shape, Shape::Field(_)) {
            return None;
        }
        Some(&stage.scene.materials[shape.material()])
    }
    /// Whether the first hit is of a mesh with interpolated normals.
    pub fn is_of_smooth_mesh(self, stage: &Stage) -> bool {
        matches!(self.shape(stage), Some(Shape::Facet(instance, _)) if instance.mesh().is_smooth())
    }
    /// Whether the first hit is of a mesh that an image is laid over.
    pub fn is_painted(self, stage: &Stage) -> bool {
        self.id() >= 0.0 && stage.scene.is_painted(whole(self.id()) >> 2)
    }
    /// The voxels that the first hit is of.
    pub fn voxels<'s>(self, stage: &Stage<'s>) -> Option<&'s Voxels> {
        match self.shape(stage)? {
            Shape::Voxels(grid) => Some(grid),
            _ => None,
        }
    }
    /// Whether the first surface has relief with smaller cells than `side` px, which samples that
    /// far apart don't tell of.
    pub fn relief_within(self, stage: &Stage, side: usize) -> bool {
        let Some(material) = self.material(stage) else { return false };
        let away = self.point() - stage.view.origin;
        let distance = away.length();
        let across = self.normal().dot(away).abs().max(1e-3 * distance);
        let footprint = stage.pixel * distance * distance / across;
        stage.quality.rung > Rung::Colour && relief_within(&material.texture, footprint, number(side))
    }
    pub fn code(self, lamp: usize) -> f32 {
        self.block.codes[lamp].as_array()[self.lane]
    }
    pub fn codes(self) -> Codes {
        self.block.codes.map(|c| splat(c.as_array()[self.lane]))
    }
}
