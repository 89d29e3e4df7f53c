//! A scene made ready for one frame: what every ray asks for, computed once.

use crate::cull::{Dop, FieldNode, Shaft, View, dops, field_nodes, shafts};
use crate::features;
use crate::math::lanes::{F, V3, splat};
use crate::math::{Vec3, number, whole};
use crate::post::Display;
use crate::quality::{Quality, Rung};
use crate::scene::Scene;
use crate::shade::{Lamp, MAX_LAMPS, Points, lamps};
use crate::sim::Volume;
use crate::trace::Shape;
use core::ops::Range;
use glam::Vec2;

/// A scene, a quality and a size, with all that follows from them.
pub struct Stage<'a> {
    /// What is drawn.
    pub scene: &'a Scene,
    /// How well.
    pub quality: Quality,
    /// Width of the picture, px.
    pub width: u32,
    /// Height of the picture, px.
    pub height: u32,
    /// Which sample pattern of a still that averages several.
    pub pattern: u32,
    /// By how much that pattern moves all positions in the picture, px.
    pub shift: Vec2,
    /// The eye.
    pub view: View,
    /// Width of a pixel on the plane one unit ahead of the eye.
    pub pixel: f32,
    /// Sources of direct light.
    pub lamps: &'a [Lamp],
    /// Small lights, if the scene has any.
    pub points: Option<&'a Points>,
    /// Per shape: a power of two for a transparent one, 0 for an opaque one.
    pub bits: &'a [f32],
    /// Factor on the light that crosses each transparent shape, in the order of their bits.
    pub tints: &'a [Vec3],
    /// Bounds of the shapes on the screen.
    pub dops: &'a [Dop],
    /// Bounds of the bodies that fields are joined of.
    pub nodes: &'a [FieldNode],
    /// Bounds of the beams on the screen.
    pub beams: &'a [Dop],
    /// Bounds of the shapes as the lamps that cast shadows see them; see [`Stage::shafts`].
    shafts: &'a [Shaft],
    /// The scene's smoke, if it has any.
    pub volume: Option<&'a Volume<'a>>,
    /// From linear light to display values.
    pub display: &'a Display,
}

/// Room for the lists of a stage; those of the next frame go into the same.
#[derive(Default)]
pub struct Tables {
    lamps: Vec<Lamp>,
    points: Points,
    bits: Vec<f32>,
    tints: Vec<Vec3>,
    dops: Vec<Dop>,
    nodes: Vec<FieldNode>,
    beams: Vec<Dop>,
    shafts: Vec<Shaft>,
    display: Display,
}

/// Transparent shapes that can colour shadows: their bits must stay exact in an f32.
const MAX_TRANSPARENT: usize = 23;

/// Pixels that the camera's field of view spans: the width, or in a wider picture than 16:9 that of one so high.
fn spanned(width: u32, height: u32) -> f32 {
    // f32 rounds 16 / 9 up: a picture of just that shape is spanned by its width.
    (width as f32).min(height as f32 * (16.0 / 9.0))
}

impl<'a> Stage<'a> {
    /// Prepares a frame of `width` by `height` px. A transparent shape beyond the 23rd casts no
    /// shadow; a lamp beyond the eighth casts none either.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn new(
        scene: &'a Scene,
        quality: &Quality,
        [width, height]: [u32; 2],
        tables: &'a mut Tables,
    ) -> Self {
        let view = View { origin: scene.camera.position, world_from_view: scene.camera.world_from_camera() };
        let Tables { bits, tints, beams, .. } = tables;
        bits.clear();
        tints.clear();
        for i in 0..scene.shape_count() {
            let material = &scene.materials[scene.shape(i).material()];
            let glass = material.is_transparent();
            let bit = if glass { (1_u32 << tints.len().min(MAX_TRANSPARENT)) as f32 } else { 0.0 };
            bits.push(bit);
            if glass && tints.len() < MAX_TRANSPARENT {
                tints.push(material.shadow);
            }
        }
        lamps(scene, &mut tables.lamps);
        shafts(scene, &tables.lamps[..tables.lamps.len().min(MAX_LAMPS)], &mut tables.shafts);
        let pixel = 2.0 * scene.camera.half_width() / spanned(width, height);
        let has_points = features::POINTS && !scene.points.is_empty();
        if has_points {
            tables.points.set(&scene.points, view, [width, height], pixel, quality.light_tile);
        }
        dops(scene, &view, &mut tables.dops);
        field_nodes(scene, &view, &mut tables.nodes);
        beams.clear();
        beams.extend(scene.beams.iter().map(|beam| Dop::of_beam(&view, beam, pixel)));
        tables.display.set(&scene.grade);
        Self {
            scene,
            quality: *quality,
            width,
            height,
            points: has_points.then_some(&tables.points),
            volume: None,
            pattern: 0,
            shift: Vec2::ZERO,
            pixel,
            dops: &tables.dops,
            nodes: &tables.nodes,
            beams: &tables.beams,
            view,
            lamps: &tables.lamps,
            bits: &tables.bits,
            tints: &tables.tints,
            shafts: &tables.shafts,
            display: &tables.display,
        }
    }

    /// Bounds of all shapes for each lamp that casts shadows.
    pub fn shafts(&self) -> std::slice::Chunks<'_, Shaft> {
        self.shafts.chunks(self.dops.len().max(1))
    }

    /// Whether what is added to finished pixels asks for the depths of their surfaces.
    pub fn wants_depths(&self) -> bool {
        (features::BEAMS && !self.scene.beams.is_empty())
            || (features::POINTS && self.scene.light_count > 0.0)
    }

    /// Sides of the scene's line that are sampled: 0 is the left one, where every pixel is traced; a scene
    /// without line has only the right one.
    pub fn sides(&self) -> Range<usize> {
        !(features::SPLIT && self.scene.split.is_some()) as usize..2
    }

    /// On which side of the line a pixel lies.
    pub fn side(&self, x: usize, y: usize) -> usize {
        match &self.scene.split {
            Some(split) if features::SPLIT => {
                let right = number(2 * x + 1) / self.width as f32 - 1.0;
                let up = 1.0 - number(2 * y + 1) / self.height as f32;
                (right >= split.x + split.slant * up) as usize
            }
            _ => 1,
        }
    }

    /// Unit vector along the view axis.
    pub fn forward(&self) -> Vec3 {
        self.view.world_from_view.z_axis
    }

    /// The point on the plane one unit ahead (right, up) that shows at a position in the picture,
    /// px right and down from its corner.
    pub fn on_screen(&self, x: f32, y: f32) -> Vec2 {
        let Vec2 { x: cx, y: cy } = Vec2::new(self.width as f32, self.height as f32) * 0.5;
        let Vec2 { x: right, y: down } = self.shift;
        Vec2::new((x + right - cx) * self.pixel, (cy - y - down) * self.pixel)
    }

    /// Unit direction of the ray through a position in the picture.
    pub fn direction(&self, x: f32, y: f32) -> Vec3 {
        self.directions(splat(x), splat(y)).lane(0)
    }

    /// [`Stage::direction`] for eight positions.
    #[inline(never)]
    pub fn directions(&self, x: F, y: F) -> V3 {
        let [right, up, forward] = self.view.world_from_view.to_cols_array_2d().map(V3::splat);
        let pixel = splat(self.pixel);
        let x = (x + splat(self.shift.x) - splat(self.width as f32 * 0.5)) * pixel;
        let y = (splat(self.height as f32 * 0.5) - y - splat(self.shift.y)) * pixel;
        (right * x + up * y + forward).normalize()
    }

    /// What is interpolated on the shape with this hit id. Where a field's surface lies between the
    /// samples is not known without marching, nor that of a curved mesh from one facet: there it is
    /// the colour.
    pub fn rung(&self, id: f32) -> Rung {
        let (shape, count) = (whole(id.max(0.0)) >> 2, self.scene.shape_count());
        let vague = if id < 0.0 {
            !self.scene.has_known_surfaces()
        } else if shape < count {
            shape >= count - self.scene.fields.len()
        } else {
            features::SMOOTH && self.scene.meshes.facet(shape - count).0.mesh().is_smooth()
        };
        let most = if vague { Rung::Colour } else { self.quality.rung };
        // Nor is the hidden share of a shining rectangle, nor what smoke hides.
        let is_soft = |lamp: usize| self.shadow_rays(lamp) > 1 || self.penumbra(lamp) > 0.0;
        let soft = (0..self.lamps.len()).any(is_soft) || self.volume.is_some();
        if soft { most.min(Rung::Light) } else { most }
    }

    /// Shadow rays to a lamp.
    pub fn shadow_rays(&self, lamp: usize) -> u32 {
        let Lamp { is_emitter, is_fill, .. } = self.lamps[lamp];
        if features::FILL && is_fill {
            0
        } else if features::SOFT_SHADOWS && self.scene.soft && is_emitter {
            self.quality.shadow_samples
        } else {
            1
        }
    }

    /// Radius of a lamp in whose light fields cast soft shadows by themselves; 0 where they don't.
    pub fn penumbra(&self, lamp: usize) -> f32 {
        let soft = features::FIELD_SHADOWS && !self.scene.fields.is_empty() && self.shadow_rays(lamp) == 1;
        if soft { self.scene.penumbra() } else { 0.0 }
    }

    /// Mask of the shapes that may show in the square of `side` px at `corner`, see
    /// [`crate::trace::nearest`].
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn candidates(&self, corner: (usize, usize), side: usize) -> u64 {
        if !self.quality.cull {
            return u64::MAX;
        }
        // A little over the last sample, which lies on the next tile's first pixel.
        let half = number(side) * 0.5 + 1.0;
        let middle = self.on_screen(number(corner.0) + half - 1.0, number(corner.1) + half - 1.0);
        let half = Vec2::splat(half * self.pixel);
        let mut mask = 0;
        for (i, dop) in self.dops.iter().enumerate() {
            let seen = match self.scene.shape(i) {
                Shape::Plane(p) => {
                    let n = self.view.world_from_view.transpose() * p.normal;
                    let side = p.normal.dot(p.point - self.view.origin);
                    let reach = n.truncate().abs().dot(half) + 1e-5;
                    let middle = n.truncate().dot(middle) + n.z;
                    side == 0.0 || middle * side.signum() + reach >= 0.0
                }
                _ => dop.meets_rectangle(middle, half),
            };
            if seen {
                mask |= 1 << (i & 63);
            }
        }
        mask
    }
}
