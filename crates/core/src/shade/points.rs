//! Small lights in great number, culled twice: by the tiles of the screen that their balls of
//! influence meet, and by the box around the eight points to be lit.
//!
//! A light falls off as `I / d² · (1 - (d/r)⁴)²` (Karis 2013, Real Shading in Unreal Engine 4) and is
//! exactly 0 from its radius r on. What is culled would have added exactly 0, so culling never changes
//! a bit. A tile is the part common to a column and a row of the screen, so a mask of lights for each
//! of these is enough: a ball meets the columns and rows that its bounds on the screen meet.

use crate::cull::{Bounds, Dop, View};
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::{Vec3, whole};
use crate::scene::PointLight;

/// Small lights of a scene that shine; those after them don't.
pub const MAX_POINTS: usize = 512;

/// A set of small lights: bit i of word w is light 64 w + i.
pub type Mask = [u64; MAX_POINTS / 64];

/// Eight lights side by side. Lanes past the last light lie at infinity and reach nowhere.
struct Eight {
    position: V3,
    radius: F,
}

/// The small lights of a scene, ready for a frame; none by default.
#[derive(Default)]
pub struct Points {
    eights: Vec<Eight>,
    view: View,
    /// Side of a tile, on the plane one unit ahead of the eye.
    side: f32,
    /// Left and upper edge of the picture on that plane, x right and y down.
    corner: [f32; 2],
    /// Lights whose balls meet each column and each row of tiles.
    bands: [Vec<Mask>; 2],
}

/// How far a tile reaches beyond its sides, as a share of them: much more than rounding.
const SLACK: f32 = 1e-3;

impl Points {
    /// Sorts `lights` into tiles of `side` px of a picture of `size` px, whose pixels are `pixel`
    /// wide on the plane one unit ahead; in place of what was there.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn set(&mut self, lights: &[PointLight], view: View, size: [u32; 2], pixel: f32, side: u32) {
        let Self { eights, bands, .. } = self;
        eights.clear();
        for (masks, n) in bands.iter_mut().zip(size) {
            masks.clear();
            masks.resize(whole(n as f32 / side as f32) + 1, Mask::default());
        }
        let side = pixel * side as f32;
        let corner = size.map(|n| -0.5 * n as f32 * pixel);
        (self.view, self.side, self.corner) = (view, side, corner);
        for (i, light) in lights.iter().take(MAX_POINTS).enumerate() {
            if i % 8 == 0 {
                eights.push(Eight { position: V3::splat(Vec3::INFINITY), radius: F::ZERO });
            }
            let eight: &mut Eight = &mut eights[i / 8];
            eight.position.set_lane(i % 8, light.position);
            eight.radius.as_mut_array()[i % 8] = light.radius;
            let bound = Dop::ball(view.local(light.position), light.radius * 1.001);
            for (axis, bands) in bands.iter_mut().enumerate() {
                let [lo, hi] = bound.extent(axis);
                // One more than the band; 0 for what lies before the first.
                let band = |at: f32| whole(((at - corner[axis]) / side + 1.0).max(0.0));
                let (first, last) = (band(lo - SLACK * side), band(hi + SLACK * side));
                for mask in bands.iter_mut().take(last).skip(first.saturating_sub(1)) {
                    mask[i / 64] |= 1 << (i % 64);
                }
            }
        }
    }

    /// Lights whose balls meet the tile at a position on the plane one unit ahead, x right and y
    /// down; none outside the picture.
    pub fn tile(&self, x: f32, y: f32) -> Option<Mask> {
        let band = |axis: usize, at: f32| {
            let at = (at - self.corner[axis]) / self.side;
            if at >= 0.0 { self.bands[axis].get(whole(at)) } else { None }
        };
        let (column, row) = (band(0, x)?, band(1, y)?);
        Some(std::array::from_fn(|i| column[i] & row[i]))
    }

    /// How many lights reach the surfaces of the tile in a column and a row, between the depths whose
    /// inverses are given, the greater one first.
    pub fn count(&self, lights: &[PointLight], tile: [usize; 2], [near, far]: [f32; 2]) -> u32 {
        let mut count = 0;
        for (k, lights) in lights.chunks(64).take(MAX_POINTS / 64).enumerate() {
            let mut bits = self.bands[0][tile[0]][k] & self.bands[1][tile[1]][k];
            while bits != 0 {
                let light = &lights[bits.trailing_zeros() as usize];
                let z = self.view.local(light.position).z;
                count += u32::from((z + light.radius) * near > 1.0 && (z - light.radius) * far < 1.0);
                bits &= bits - 1;
            }
        }
        count
    }

    /// Calls `light` with the index of each light whose ball meets the box around the points in
    /// lanes `active`, in ascending order.
    #[inline(always)]
    pub fn near(&self, points: V3, active: F, cull: bool, mut light: impl FnMut(usize)) {
        let mut bounds = Bounds::EMPTY;
        bounds.add(points, active);
        let Some((lo, hi)) = bounds.corners() else { return };
        let mask = self.around(points, active, cull);
        for (k, eight) in self.eights.iter().enumerate() {
            let among = mask[k / 8] >> (k % 8 * 8) & 255;
            if among == 0 {
                continue;
            }
            // The same operations as for the distance to a point of the box, which is never less.
            let c = eight.position;
            let beside = |c: F, lo: f32, hi: f32| (splat(lo) - c).at_least(c - splat(hi)).at_least(F::ZERO);
            let off = V3::new(beside(c.x, lo.x, hi.x), beside(c.y, lo.y, hi.y), beside(c.z, lo.z, hi.z));
            let near = off.dot(off).simd_lt(eight.radius * eight.radius).to_bitmask() as u64;
            let mut bits = if cull { near & among } else { among };
            while bits != 0 {
                light(k * 8 + bits.trailing_zeros() as usize);
                bits &= bits - 1;
            }
        }
    }

    /// Lights of all tiles that show the points in lanes `active`.
    #[inline(never)]
    fn around(&self, points: V3, active: F, cull: bool) -> Mask {
        let mut mask = Mask::default();
        for lane in (0..8).filter(|lane| active.to_bitmask() >> lane & 1 == 1) {
            let v = self.view.local(points.lane(lane));
            let seen = if v.z > 0.0 && cull { self.tile(v.x / v.z, -v.y / v.z) } else { None };
            let seen = seen.unwrap_or([u64::MAX; MAX_POINTS / 64]);
            for (word, seen) in mask.iter_mut().zip(seen) {
                *word |= seen;
            }
        }
        mask
    }
}

#[cfg(test)]
mod tests;
