//! Images laid over meshes by texture coordinates at the corners.
//!
//! An image is kept with all its halves (Williams 1983), each texel the mean of the area it covers, in
//! linear light. A look-up is bilinear in the two of them whose texels are next in size to the ray's
//! footprint, and linear between these. The footprint counts as a square of its own area, which is a
//! middle course where a surface is seen at a slant.

use super::Instance;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::scalar::srgb_decode;
use crate::math::{Vec3, cross, number, whole};
use glam::Vec2;
use std::sync::Arc;

/// An image and its halves.
#[derive(Clone, Debug)]
pub struct Image {
    levels: Vec<Level>,
    /// The light that each value of a byte stands for.
    linear: Vec<f32>,
}

/// Rows of texels, the uppermost first.
#[derive(Clone, Debug)]
struct Level {
    size: [usize; 2],
    texels: Vec<[u8; 3]>,
}

/// An image with the place of each corner of a mesh in it.
#[derive(Clone, Debug)]
pub struct Skin {
    /// What is laid over the mesh.
    pub image: Arc<Image>,
    /// Texture coordinates of the corners of each triangle: 0 to 1 from left to right and from the lower
    /// edge up; beyond that the image repeats.
    pub uvs: Vec<[Vec2; 3]>,
}

/// A number's fraction of 1, 0 for what has none.
fn fraction(x: f32) -> f32 {
    if x.is_finite() { x - x.floor() } else { 0.0 }
}

/// The image of half the size.
fn halved(old: &Level, linear: &[f32]) -> Level {
    let size = old.size.map(|side| side.div_ceil(2));
    // The texels that the one at `i` of `to` covers, of `from`, with the share of each.
    let covered = |i: usize, from: usize, to: usize| {
        let scale = number(from) / number(to);
        let (a, b) = (number(i) * scale, number(i + 1) * scale);
        (whole(a)..from.min(whole(b.ceil()))).map(move |k| {
            let share = b.min(number(k + 1)) - a.max(number(k));
            (k, share / scale)
        })
    };
    let texel = |i: usize| {
        let mut sum = [0.0; 3];
        for (y, high) in covered(i / size[0], old.size[1], size[1]) {
            for (x, wide) in covered(i % size[0], old.size[0], size[0]) {
                for (sum, byte) in sum.iter_mut().zip(old.texels[y * old.size[0] + x]) {
                    *sum += high * wide * linear[byte as usize];
                }
            }
        }
        // The byte whose light is nearest.
        sum.map(|light| {
            let above = linear.partition_point(|&l| l < light).clamp(1, 255);
            let down = light - linear[above - 1] < linear[above] - light;
            (above - down as usize) as u8
        })
    };
    Level { size, texels: (0..size[0] * size[1]).map(texel).collect() }
}

impl Level {
    /// Light of the texels around a place, both coordinates from 0 to 1, v up.
    fn at(&self, u: f32, v: f32, linear: &[f32]) -> Vec3 {
        let [width, height] = self.size;
        // Half a texel back, and once around, so that nothing is below 0.
        let (x, y) = (u * number(width) + number(width) - 0.5, (2.0 - v) * number(height) - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |dx: usize, dy: usize| {
            let [x, y] = [(whole(x) + dx) % width, (whole(y) + dy) % height];
            Vec3::from_array(self.texels[y * width + x].map(|byte| linear[byte as usize]))
        };
        let row = |dy: usize| {
            let (a, b) = (texel(0, dy), texel(1, dy));
            a + (b - a) * fx
        };
        let (upper, lower) = (row(0), row(1));
        upper + (lower - upper) * fy
    }
}

impl Image {
    /// An image of sRGB's bytes, row by row from the upper edge; `None` unless there is one for each texel.
    pub fn new(size: [usize; 2], texels: Vec<[u8; 3]>) -> Option<Image> {
        if texels.is_empty() || size[0].checked_mul(size[1]) != Some(texels.len()) {
            return None;
        }
        let linear: Vec<f32> = (0..256).map(|byte| srgb_decode(number(byte) / 255.0)).collect();
        let mut levels = vec![Level { size, texels }];
        while let Some(level) = levels.last().filter(|level| level.size != [1, 1]) {
            levels.push(halved(level, &linear));
        }
        Some(Image { levels, linear })
    }

    /// Width and height, texels.
    pub fn size(&self) -> [usize; 2] {
        self.levels[0].size
    }

    /// Linear light at a place, see [`Skin::uvs`], as the mean over about `width` texels.
    pub fn at(&self, uv: Vec2, width: f32) -> Vec3 {
        let (u, v) = (fraction(uv.x), fraction(uv.y));
        let (mut width, mut level) = (width.max(1.0), 0);
        while width >= 2.0 && level + 1 < self.levels.len() {
            (width, level) = (width * 0.5, level + 1);
        }
        let at = |level: usize| self.levels[level.min(self.levels.len() - 1)].at(u, v, &self.linear);
        let (fine, coarse) = (at(level), at(level + 1));
        fine + (coarse - fine) * (width - 1.0).min(1.0)
    }
}

impl Instance {
    /// Light that an image leaves of white on facets, by their indices in the mesh and the weights of
    /// their second and third corners, where rays have footprints of this width on them, world units.
    #[inline(never)]
    pub(crate) fn painted(&self, skin: &Skin, index: F, uv: [F; 2], width: F) -> V3 {
        let triangles = self.mesh().triangles();
        let [index, u, v, width] = [index, uv[0], uv[1], width].map(F::to_array);
        V3::from_fn(|lane| {
            let i = whole(index[lane]).min(triangles.len() - 1);
            let [a, b, c] = skin.uvs[i];
            let [p, q, r] = triangles[i].map(|p| self.to_world(p));
            let [w, h] = skin.image.size().map(number);
            // Texels per world unit, from the areas of the triangle in both.
            let (texels, area) = ((b - a).perp_dot(c - a).abs() * w * h, cross(q - p, r - p).length());
            let density = (texels / area.max(1e-30)).sqrt();
            skin.image.at(a + (b - a) * u[lane] + (c - a) * v[lane], width[lane] * density)
        })
    }
}

/// The width of footprints on surfaces with unit normals `n`: rays of unit direction `d` are `width`
/// wide, and at a slant their area grows.
pub(crate) fn on_surface(width: F, n: V3, d: V3) -> F {
    width / n.dot(d).abs().at_least(splat(1e-3)).sqrt()
}

#[cfg(test)]
mod tests;
