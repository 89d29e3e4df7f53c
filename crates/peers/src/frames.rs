//! Whole pictures of a distance field: depth and normal of each pixel, by us and by crate fidget.
//!
//! The picture shows the volume from -1 to 1 along each axis, seen from +z without perspective. fidget's own
//! renderer tests voxels and leaves out those that intervals show to be empty or full; [`rays`] marches as
//! we do (Hart 1996), but with values and gradients by fidget, for each group of rays on as many as still run.

use fidget::jit::JitShape;
use fidget::raster::voxel::{self, EvalConfig, RenderConfig, RenderSize};
use fidget::shape::{BoundShape, EzShape};
use fidget::types::Grad;
use luc_core::counters::Counters;
use luc_core::math::Vec3;
use luc_core::math::lanes::{F, V3, splat};
use luc_core::quality::Quality;
use luc_core::scene::{Field, Scene};
use luc_core::trace::{self, Rays8};

/// Where rays begin, along z.
const FRONT: f32 = 1.0;
/// Rays that march as one group with fidget's evaluator: 32x16 px.
const GROUP: [usize; 2] = [32, 16];

/// A picture, row by row.
pub struct Frame {
    side: usize,
    /// Where the surface is, along z; -infinity for none.
    pub depth: Vec<f32>,
    /// Unit vectors, where there is a surface.
    normal: Vec<Vec3>,
}

/// What two pictures differ in.
pub struct Difference {
    /// Pixels in which only one has a surface.
    pub outline: usize,
    /// Pixels whose depths are more than two voxels apart.
    pub depth: usize,
    /// Mean angle between normals, degrees.
    pub angle: f64,
}

impl Frame {
    fn new(side: usize) -> Self {
        let pixels = side * side;
        Self { side, depth: vec![f32::NEG_INFINITY; pixels], normal: vec![Vec3::ZERO; pixels] }
    }

    /// Holds it against another.
    pub fn compare(&self, other: &Frame) -> Difference {
        let mut difference = Difference { outline: 0, depth: 0, angle: 0.0 };
        let mut both = 0;
        for i in 0..self.depth.len() {
            let [a, b] = [self.depth[i], other.depth[i]];
            if a.is_finite() && b.is_finite() {
                both += 1;
                difference.depth += usize::from((a - b).abs() > 4.0 / self.side as f32);
                let cosine = self.normal[i].dot(other.normal[i]).clamp(-1.0, 1.0);
                difference.angle += f64::from(cosine.acos().to_degrees());
            } else {
                difference.outline += usize::from(a.is_finite() || b.is_finite());
            }
        }
        difference.angle /= f64::from(both.max(1));
        difference
    }
}

/// Where column `x` and row `y` are, as fidget places them.
fn place(side: usize, x: usize, y: usize) -> [f32; 2] {
    let half = side as f32 / 2.0;
    [(x as f32 - half) / half, (half - 1.0 - y as f32) / half]
}

/// By the engine, in packets of 4x2 px.
pub fn ours(scene: &Scene, quality: &Quality, side: usize) -> Frame {
    let mut frame = Frame::new(side);
    let mut counters = Counters::default();
    let away = V3::splat(Vec3::NEG_Z);
    for (y, x) in (0..side).step_by(2).flat_map(|y| (0..side).step_by(4).map(move |x| (y, x))) {
        let origin = V3::from_fn(|lane| {
            let [x, y] = place(side, x + lane % 4, y + lane / 4);
            Vec3::new(x, y, FRONT)
        });
        let rays = Rays8 { origin, direction: away };
        let hits = trace::nearest(scene, quality, &rays, u64::MAX, &mut counters);
        let hit = hits.id.simd_ge(F::ZERO);
        if !hit.any() {
            continue;
        }
        let surface = trace::surface(scene, quality, &rays, hits.t, hits.id, splat(2.0 / side as f32));
        for lane in (0..8).filter(|lane| hit.to_bitmask() >> lane & 1 != 0) {
            let i = (y + lane / 4) * side + x + lane % 4;
            frame.depth[i] = FRONT - hits.t.as_array()[lane];
            frame.normal[i] = surface.outward().lane(lane);
        }
    }
    frame
}

/// By fidget's own renderer, in cubes of voxels.
pub fn voxels(shape: &JitShape, side: usize) -> Frame {
    let mut frame = Frame::new(side);
    let bound = BoundShape::try_from(shape.clone()).expect("a shape of coordinates alone");
    let config = RenderConfig::from_size(RenderSize::from(side as u32));
    let alone = EvalConfig { threads: None, ..EvalConfig::default() };
    let picture = voxel::render(bound, &config, &alone).expect("nobody cancels it");
    let half = side as f32 / 2.0;
    for (i, pixel) in picture.iter().enumerate().filter(|(_, pixel)| pixel.depth > 0) {
        // It tells the voxel in front of the first whose value is below 0; the surface is between the two.
        frame.depth[i] = (pixel.depth as f32 - 0.5 - half) / half;
        let [x, y, z] = pixel.normal;
        frame.normal[i] = Vec3::new(x, -y, z).normalize_or_zero();
    }
    frame
}

/// By marching along rays with fidget's values, within our field's box and with our steps.
pub fn rays(shape: &JitShape, field: &Field, quality: &Quality, side: usize) -> Frame {
    let mut frame = Frame::new(side);
    let (values, slopes) = (shape.ez_float_slice_tape(), shape.ez_grad_slice_tape());
    let (mut value, mut slope) = (JitShape::new_float_slice_eval(), JitShape::new_grad_slice_eval());
    let [mut x, mut y, mut z] = [(); 3].map(|()| Vec::new());
    let (mut pixels, mut found) = (Vec::new(), Vec::new());
    let [wide, high] = GROUP;
    let groups = (0..side).step_by(high).flat_map(|y| (0..side).step_by(wide).map(move |x| (y, x)));
    for (top, left) in groups {
        [&mut x, &mut y, &mut z].into_iter().for_each(Vec::clear);
        pixels.clear();
        found.clear();
        for (row, column) in (top..top + high).flat_map(|y| (left..left + wide).map(move |x| (y, x))) {
            let [px, py] = place(side, column, row);
            let inside = |p: f32, lo: f32, hi: f32| lo < p && p < hi;
            if inside(px, field.lo.x, field.hi.x) && inside(py, field.lo.y, field.hi.y) {
                x.push(px);
                y.push(py);
                z.push(field.hi.z);
                pixels.push(row * side + column);
            }
        }
        for _ in 0..quality.steps {
            if pixels.is_empty() {
                break;
            }
            let near = value.eval(&values, &x, &y, &z).expect("slices of one length");
            let mut kept = 0;
            for i in 0..pixels.len() {
                let depth = z[i] - near[i];
                if near[i] < quality.epsilon * (1.0 + FRONT - z[i]) {
                    frame.depth[pixels[i]] = depth;
                    found.push((pixels[i], [x[i], y[i], depth]));
                } else if depth > field.lo.z {
                    (x[kept], y[kept], z[kept], pixels[kept]) = (x[i], y[i], depth, pixels[i]);
                    kept += 1;
                }
            }
            [&mut x, &mut y, &mut z].into_iter().for_each(|list| list.truncate(kept));
            pixels.truncate(kept);
        }
        if found.is_empty() {
            continue;
        }
        let axis = |k: usize, d: [f32; 3]| -> Vec<Grad> {
            found.iter().map(|(_, p)| Grad::new(p[k], d[0], d[1], d[2])).collect()
        };
        let [gx, gy, gz] = [axis(0, [1.0, 0.0, 0.0]), axis(1, [0.0, 1.0, 0.0]), axis(2, [0.0, 0.0, 1.0])];
        let gradients = slope.eval(&slopes, &gx, &gy, &gz).expect("slices of one length");
        for (&(pixel, _), g) in found.iter().zip(gradients) {
            frame.normal[pixel] = Vec3::new(g.dx, g.dy, g.dz).normalize_or_zero();
        }
    }
    frame
}
