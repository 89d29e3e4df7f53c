//! Refinement of one tile: cells are split until what lies between their samples is known.
//!
//! A cell is interpolated if its corners and its centre have equal signatures, nothing else may
//! appear in it, and the bilinear value at the centre is within tolerance in display units; else
//! it is split in four, a cell of four into its pixels. Samples lie on pixels, so children share them.
//! Small pictures of many meshes are traced pixel by pixel: hardly a cell stays whole among their facets.
//! Whitted 1980's adaptive supersampling turned round; the centre sample is what makes it exact.
//!
//! *Nothing else may appear*: a shape whose projected bound meets the cell and that isn't behind
//! the cell's own surface may lie between the corners, however small it is. So may the shadow of
//! a shape whose bound, seen from a lamp, meets the cell's patch of surface, when all corners are
//! lit. A convex front is nowhere deeper than its deepest corner, seen along the view axis.

use super::block::{Sample, Samples};
use super::interpolate::fill;
use super::tile::{GRID, Kind, Record, TILE, Tile};
use super::wave::{Scratch, trace};
use crate::counters::{Counter, Counters};
use crate::cull::{Bounds, Region, may_cover, occluders};
use crate::features;
use crate::math::lanes::F;
use crate::math::{Vec3, number, whole};
use crate::quality::Rung;
use crate::render::Stage;
use crate::shade::MAX_LAMPS;
use crate::trace::{BLOCKED, Shape};
use glam::Vec2;

/// Lines of a picture up to which the facets of many meshes are hardly larger than its pixels.
const SMALL: u32 = 360;
/// More meshes than this are many.
const FEW: usize = 12;

/// A square between samples; `x`, `y` from the tile's corner, px.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub x: usize,
    pub y: usize,
    pub size: usize,
}

/// The samples of a cell: corners in reading order, then the centre.
pub(super) struct Known<'a> {
    /// Side of the cell, px.
    pub size: usize,
    /// Samples that were taken; for those that weren't the first corner stands.
    pub taken: usize,
    pub samples: [Sample<'a>; 5],
}

impl Cell {
    /// Where sample `i` is: the corners in reading order, then the middle, which is a corner of the
    /// children, and in a cell of one pixel the first corner again.
    pub(super) fn point(self, i: usize) -> (usize, usize) {
        let (size, i) = if i < 4 { (self.size, i) } else { (self.size / 2, 3) };
        (self.x + (i & 1) * size, self.y + (i >> 1) * size)
    }

    /// How many of these samples tell what becomes of it: the centre decides whether a cell is split, the
    /// corners whether a pixel is on an edge.
    fn wanted(self, stage: &Stage, measures: bool) -> usize {
        let quality = &stage.quality;
        if self.size == 1 && (measures || quality.edge_samples.max(quality.samples) == 0) {
            1
        } else {
            4 + (quality.study.centre() && self.size > quality.smallest as usize) as usize
        }
    }

    /// Whether it has pixels of the picture on this side of the scene's line.
    fn lies(self, stage: &Stage, corner: (usize, usize), side: usize) -> bool {
        let last = self.size - 1;
        let (x, y) = (corner.0 + self.x, corner.1 + self.y);
        x < stage.width as usize
            && y < stage.height as usize
            && stage.sides().contains(&side)
            && (0..if last == 0 { 1 } else { 4 })
                .any(|i| stage.side(x + (i & 1) * last, y + (i >> 1) * last) == side)
    }

    /// Appends its parts of this size that lie there, along Morton's curve, on which neighbours are near.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn split(self, size: usize, stage: &Stage, corner: (usize, usize), side: usize, cells: &mut Vec<Cell>) {
        let parts = self.size / size;
        for index in 0..parts * parts {
            let mut part = Cell { size, ..self };
            for bit in 0..TILE.trailing_zeros() {
                part.x += (index >> (2 * bit) & 1) * (size << bit);
                part.y += (index >> (2 * bit + 1) & 1) * (size << bit);
            }
            if part.lies(stage, corner, side) {
                cells.push(part);
            }
        }
    }
}

/// What a tile knows of the shapes that may show, or cast shadows, in it.
struct Surroundings {
    /// Shapes that may be seen.
    shapes: u64,
    /// Shapes that may cast a shadow from each lamp.
    shadows: [u64; MAX_LAMPS],
}

/// Whether so many cells would be split to the pixel that tracing each, in packets of neighbours, is faster.
fn is_too_fine(stage: &Stage) -> bool {
    let quality = &stage.quality;
    let plain = quality.edge_samples == 0 && quality.smallest == 1;
    plain && stage.height <= SMALL && stage.scene.meshes.instances().len() > FEW
}

/// Samples the tile whose upper left pixel is `corner`, and fills its pixels.
#[cfg_attr(luc_size, optimize(size))]
pub fn refine(stage: &Stage, scratch: &mut Scratch, corner: (usize, usize), tile: &mut Tile) {
    let mut around = Surroundings { shapes: stage.candidates(corner, TILE), shadows: [u64::MAX; MAX_LAMPS] };
    tile.edges = [[0; GRID]; GRID];
    for pass in stage.sides().start..2 + (features::SPLIT && stage.scene.split.is_some()) as usize {
        refine_side(stage, scratch, corner, pass, &mut around, tile);
    }
}

/// Samples what of the tile lies on one side of the scene's line: 0, each pixel on the left, 1, the right
/// side, 2, each pixel on the right that has no ray of its own, to measure what is there.
fn refine_side(
    stage: &Stage,
    scratch: &mut Scratch,
    corner: (usize, usize),
    pass: usize,
    around: &mut Surroundings,
    tile: &mut Tile,
) {
    let before = scratch.counters.rays();
    let (side, measures) = (pass.min(1), pass == 2);
    let cell = match stage.quality.cell(stage.height) as usize {
        _ if pass != 1 => 1,
        cell if cell > 1 && stage.sides().len() == 2 => (cell * 4).min(32),
        _ if is_too_fine(stage) => 1,
        cell => cell,
    };
    scratch.samples.0.clear();
    scratch.grid.clear();
    scratch.grid.resize(GRID * GRID, u32::MAX);

    let mut cells = std::mem::take(&mut scratch.cells);
    cells.clear();
    Cell { x: 0, y: 0, size: TILE }.split(cell, stage, corner, side, &mut cells);
    if measures {
        tile.measured[0] += number(cells.len());
        cells.retain(|cell| tile.record[cell.y * TILE + cell.x].kind() != Kind::Traced);
    }
    let mut done = 0;
    // Level by level: the cells of the next one are appended.
    while done < cells.len() {
        let level = done..cells.len();
        sample(stage, scratch, &cells[level.clone()], corner, around.shapes, measures);
        if done == 0 {
            around.shadows = shadow_casters(stage, &scratch.samples);
        }
        done = level.end;
        for i in level {
            let cell = cells[i];
            let taken = cell.wanted(stage, measures);
            let at = |i: usize| {
                let (x, y) = cell.point(if i < taken { i } else { 0 });
                scratch.samples.get(scratch.grid[y * GRID + x] as usize)
            };
            let known = Known { size: cell.size, taken, samples: std::array::from_fn(at) };
            if measures {
                let off = stage.display.map(tile.get(cell.x, cell.y)) - known.samples[0].display();
                tile.measured[1] += off.dot(off);
                scratch.counters.add(Counter::Measured, 1);
            } else if cell.size == 1 {
                tile.set(cell.x, cell.y, known.samples[0].colour(), Record::new(Kind::Traced, 1));
                tile.nearness[cell.y * TILE + cell.x] = 1.0 / known.samples[0].depth();
                scratch.counters.add(Counter::Traced, 1);
                if known.is_edge(stage) {
                    for i in 0..4 {
                        let (x, y) = cell.point(i);
                        // From a corner the cell lies in the opposite quadrant.
                        tile.edges[y][x] |= 8 >> i;
                    }
                }
            } else if !cell.lies(stage, corner, 1 - side)
                && (cell.size <= stage.quality.smallest as usize
                    || (known.smooth(stage)
                        && !around.may_hide_something(stage, corner, cell, &known, &mut scratch.counters)))
            {
                fill(stage, corner, cell, &known, tile, &mut scratch.counters);
            } else {
                // A cell of two would take a sample for nearly each pixel that it might save.
                let half = cell.size / 2;
                let size = if half == 2 { half.min(stage.quality.smallest as usize) } else { half };
                cell.split(size, stage, corner, side, &mut cells);
            }
        }
    }
    scratch.cells = cells;
    if !measures {
        tile.rays[side] = scratch.counters.rays() - before;
    }
}

/// Traces the samples of `cells` that are still missing, in the cells' order.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
fn sample(
    stage: &Stage,
    scratch: &mut Scratch,
    cells: &[Cell],
    corner: (usize, usize),
    shapes: u64,
    measures: bool,
) {
    let Scratch { grid, positions: missing, samples, .. } = scratch;
    missing.clear();
    let before = samples.0.len() * 8;
    for cell in cells {
        for (x, y) in (0..cell.wanted(stage, measures)).map(|i| cell.point(i)) {
            let slot = &mut grid[y * GRID + x];
            if *slot == u32::MAX {
                *slot = (before + missing.len()) as u32;
                missing.push((number(corner.0 + x) + 0.5, number(corner.1 + y) + 0.5));
            }
        }
    }
    trace(stage, scratch, shapes);
}

/// Shapes that may cast a shadow on any surface between `samples`, per lamp.
#[cfg_attr(luc_size, optimize(size))]
fn shadow_casters(stage: &Stage, samples: &Samples) -> [u64; MAX_LAMPS] {
    let mut masks = [0; MAX_LAMPS];
    let mut bounds = Bounds::EMPTY;
    for block in &samples.0 {
        bounds.add(block.point, block.id.simd_ge(F::ZERO));
    }
    let Some((lo, hi)) = bounds.corners() else { return masks };
    // Curved patches bulge a little out of the box of their corners.
    let region = Region::cuboid(lo, hi, 0.02 * (hi - lo).length());
    for (mask, shafts) in masks.iter_mut().zip(stage.shafts()) {
        *mask = occluders(stage.scene, shafts, u64::MAX, None, &region);
    }
    masks
}

impl Known<'_> {
    /// Whether all samples agree with the first in a property.
    fn all(&self, like: impl Fn(Sample, Sample) -> bool) -> bool {
        self.samples[1..].iter().all(|&s| like(s, self.samples[0]))
    }

    /// Whether some sample has a property.
    fn any(&self, property: impl Fn(Sample) -> bool) -> bool {
        self.samples.iter().any(|&s| property(s))
    }

    /// Whether all samples saw the same surface from about the same side, by the same lamps.
    pub fn same_surface(&self) -> bool {
        self.all(|s, first| {
            s.surface() == first.surface() && (s.id() < 0.0 || s.normal().dot(first.normal()) > 0.5)
        })
    }

    /// Whether mirrors and glass show the same things at all samples.
    fn same_signature(&self) -> bool {
        self.all(|s, first| s.signature() == first.signature())
    }

    /// Whether what the samples saw differs visibly. A smooth mesh is one surface that may stand before
    /// itself.
    fn is_edge(&self, stage: &Stage) -> bool {
        let folds = features::SMOOTH && self.samples[0].is_of_smooth_mesh(stage);
        let alike = !folds && self.same_surface() && self.same_signature();
        !alike && !self.agree_within(2.0 * stage.quality.tolerance)
    }

    /// Whether all display values are within `limit` of the first.
    #[inline(never)]
    pub fn agree_within(&self, limit: f32) -> bool {
        self.all(|s, first| (s.display() - first.display()).abs().max_element() <= limit)
    }

    /// Mean of a value at the corners.
    #[inline(never)]
    pub fn mean(&self, value: fn(Sample) -> Vec3) -> Vec3 {
        let [a, b, c, d, _] = self.samples.map(value);
        (a + b + c + d) * 0.25
    }

    /// Largest error of the bilinear display value at the centre.
    #[inline(never)]
    pub fn colour_error(&self) -> f32 {
        (self.mean(|s| s.display()) - self.samples[4].display()).abs().max_element()
    }

    /// Whether the bilinear value at the centre is within tolerance of the true one; within a
    /// quarter of it where mirrors or glass show different things at the samples.
    ///
    /// Written so that NaN refines.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn smooth(&self, stage: &Stage) -> bool {
        if !self.same_surface() {
            return false;
        }
        // Which facet of a curved mesh is seen between samples is not known, and so which part of its image.
        if self.samples[0].is_painted(stage) && self.samples[0].is_of_smooth_mesh(stage) {
            return false;
        }
        // Mirrors magnify relief: between samples farther apart than its cells nothing is known.
        let first = self.samples[0];
        let mirrors = first.material(stage).is_some_and(|m| m.reflection > 0.0);
        if mirrors && first.relief_within(stage, self.size) {
            return false;
        }
        let same = self.same_signature();
        if same && !stage.quality.study.centre() {
            return true;
        }
        let tolerance = stage.quality.tolerance * if same { 1.0 } else { 0.25 };
        let mut error = 0.0;
        if stage.rung(self.samples[4].id()) == Rung::Surface {
            let predicted = stage.display.map(self.samples[4].direct() + self.mean(|s| s.indirect()));
            error = (predicted - self.samples[4].display()).abs().max_element();
            if same {
                return error <= tolerance;
            }
        }
        // One corner in the mirror image of a lamp makes the mean white, right or wrong.
        error.max(self.colour_error()) <= tolerance
    }
}

impl Surroundings {
    /// Whether a shape, or the shadow of one, may lie between the samples of a cell.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn may_hide_something(
        &self,
        stage: &Stage,
        corner: (usize, usize),
        cell: Cell,
        known: &Known,
        counters: &mut Counters,
    ) -> bool {
        let id = known.samples[0].id();
        let own = if id >= 0.0 { whole(id) >> 2 } else { usize::MAX };
        let half = number(cell.size) * 0.5;
        let middle = (number(corner.0 + cell.x) + half + 0.5, number(corner.1 + cell.y) + half + 0.5);
        let at = stage.on_screen(middle.0, middle.1);
        let reach = Vec2::splat(half * stage.pixel);
        let [depths @ .., _] = known.samples.map(|s| s.depth());
        let deepest = depths.into_iter().fold(0.0, f32::max);
        for (i, dop) in stage.dops.iter().enumerate() {
            let loose = stage.scene.shape(i).is_loose();
            if self.shapes >> (i & 63) & 1 == 0 || i == own || dop.unbounded || dop.near >= deepest || loose {
                continue;
            }
            if dop.meets_rectangle(at, reach) && may_cover(stage, i, at, reach, &depths) {
                return true;
            }
        }
        for node in stage.nodes {
            let known = node.shape == own && known.any(|s| s.node() == node.index);
            if self.shapes >> (node.shape & 63) & 1 == 1 && !known && node.may_cover(at, reach, &depths) {
                return true;
            }
        }
        let meshes = &stage.scene.meshes;
        if !meshes.is_empty() {
            let [right, up, forward] = [0, 1, 2].map(|axis| stage.view.world_from_view.col(axis));
            let towards = |sign: (f32, f32)| {
                let p = at + reach * Vec2::from(sign);
                right * p.x + up * p.y + forward
            };
            let corners = [(-1.0, 1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(towards);
            if meshes.may_lie_between(stage.view.origin, corners, depths, counters) {
                return true;
            }
        }
        if own == usize::MAX {
            return false;
        }
        if known.may_hide_glint(stage, own) {
            return true;
        }
        let [points @ .., _] = known.samples.map(|s| s.point());
        // Between the corners a curved surface bulges out of their hull.
        let flat = stage.scene.shape(own).is_flat();
        let across = (points[3] - points[0]).length().max((points[2] - points[1]).length());
        let region = Region::patch(&points, if flat { 0.0 } else { 0.1 * across });
        let material = &stage.scene.materials[stage.scene.shape(own).material()];
        for (lamp, shafts) in stage.shafts().enumerate() {
            let position = stage.lamps[lamp].position;
            let faces = known.samples[..4].iter().any(|s| s.normal().dot(position - s.point()) > 0.0);
            let lit = faces && known.samples[..4].iter().all(|s| s.code(lamp) != BLOCKED);
            // Soft shadows rest on the samples alone; a fill light has none.
            let is_hard = stage.shadow_rays(lamp) == 1;
            if (self.shadows[lamp] == 0 && meshes.is_empty())
                || !is_hard
                || !lit
                || !stage.lamps[lamp].lights(material)
            {
                continue;
            }
            let to = points.map(|p| p - position);
            if meshes.may_lie_between(position, to, [1.0; 4], counters) {
                return true;
            }
            // A body that already colours the light of all samples is known to be there.
            let crossed = whole(known.samples[0].code(lamp));
            let may = occluders(stage.scene, shafts, self.shadows[lamp], Some(own), &region);
            for (i, &bit) in stage.bits.iter().enumerate() {
                let known_tint = bit > 0.0 && crossed & whole(bit) != 0;
                // Bounds of fields and voxels are too loose to say that a shadow is near.
                let shape = stage.scene.shape(i);
                let unbounded = matches!(shape, Shape::Plane(_)) || shape.is_loose();
                if may >> (i & 63) & 1 == 1 && i != own && !known_tint && !unbounded {
                    return true;
                }
            }
        }
        false
    }
}
