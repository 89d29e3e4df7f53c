//! Refinement of one tile: cells are split until what lies between their samples is known.
//!
//! A cell is interpolated if its corners and its centre have equal signatures, nothing else may
//! appear in it, and the bilinear value at the centre is within tolerance in display units; else
//! it is split in four, down to the pixel. Samples lie on pixels, so children share them.
//! Whitted 1980's adaptive supersampling turned round; the centre sample is what makes it exact.
//!
//! *Nothing else may appear*: a shape whose projected bound meets the cell and that isn't behind
//! the cell's own surface may lie between the corners, however small it is. So may the shadow of
//! a shape whose bound, seen from a lamp, meets the cell's patch of surface, when all corners are
//! lit. A convex front is nowhere deeper than its deepest corner, seen along the view axis.

use super::block::{Sample, Samples};
use super::interpolate::fill;
use super::tile::{GRID, Kind, Record, TILE, Tile};
use super::wave::{Position, Scratch, trace};
use crate::counters::{Counter, Counters};
use crate::cull::{Region, may_cover, occluders};
use crate::quality::Rung;
use crate::render::Stage;
use crate::shade::MAX_LAMPS;
use crate::trace::{BLOCKED, Shape};
use glam::Vec2;

/// A square between samples; `x`, `y` from the tile's corner, px.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub x: usize,
    pub y: usize,
    pub size: usize,
}

/// The samples of a cell: corners in reading order, and the centre.
pub(super) struct Corners<'a> {
    /// Side of the cell, px.
    pub size: usize,
    pub corners: [Sample<'a>; 4],
    pub centre: Option<Sample<'a>>,
}

impl Cell {
    fn points(self) -> [(usize, usize); 4] {
        let Cell { x, y, size } = self;
        [(x, y), (x + size, y), (x, y + size), (x + size, y + size)]
    }

    /// The sample in the middle, which is a corner of the children.
    fn middle(self, stage: &Stage) -> Option<(usize, usize)> {
        let half = self.size / 2;
        (half > 0 && stage.quality.centre).then_some((self.x + half, self.y + half))
    }

    fn children(self) -> [Cell; 4] {
        let size = self.size / 2;
        let Cell { x, y, .. } = self;
        [(x, y), (x + size, y), (x, y + size), (x + size, y + size)].map(|(x, y)| Cell { x, y, size })
    }
}

/// What a tile knows of the shapes that may show, or cast shadows, in it.
struct Surroundings {
    /// Shapes that may be seen.
    shapes: u64,
    /// Shapes that may cast a shadow from each lamp.
    shadows: [u64; MAX_LAMPS],
}

/// Samples the tile whose upper left pixel is `corner`, and fills its pixels.
pub fn refine(stage: &Stage, scratch: &mut Scratch, corner: (usize, usize), tile: &mut Tile) {
    let width = TILE.min(stage.width as usize - corner.0);
    let height = TILE.min(stage.height as usize - corner.1);
    let cell = stage.quality.cell(stage.height) as usize;
    let mut around = Surroundings { shapes: stage.candidates(corner, TILE), shadows: [u64::MAX; MAX_LAMPS] };
    scratch.samples.0.clear();
    scratch.grid.clear();
    scratch.grid.resize(GRID * GRID, u32::MAX);

    let mut cells = Vec::new();
    for y in (0..height).step_by(cell) {
        cells.extend((0..width).step_by(cell).map(|x| Cell { x, y, size: cell }));
    }
    tile.edges = [[false; GRID]; GRID];
    let mut first = true;
    while !cells.is_empty() {
        sample(stage, scratch, &cells, corner, around.shapes);
        if first {
            around.shadows = shadow_casters(stage, &scratch.samples);
            first = false;
        }
        let mut next = Vec::new();
        for &cell in &cells {
            let at = |(x, y): (usize, usize)| scratch.samples.get(scratch.grid[y * GRID + x] as usize);
            let known = Corners {
                size: cell.size,
                corners: cell.points().map(at),
                centre: cell.middle(stage).map(at),
            };
            if cell.size == 1 {
                tile.set(cell.x, cell.y, known.corners[0].colour(), Record::new(Kind::Traced, 1));
                tile.nearness[cell.y * TILE + cell.x] = 1.0 / known.corners[0].depth();
                scratch.counters.add(Counter::Traced, 1);
                if known.is_edge(stage) {
                    for (x, y) in cell.points() {
                        tile.edges[y][x] = true;
                    }
                }
            } else if cell.size <= stage.quality.smallest as usize
                || (known.smooth(stage)
                    && !around.may_hide_something(stage, corner, cell, &known, &mut scratch.counters))
            {
                fill(stage, corner, cell, &known, tile, &mut scratch.counters);
            } else {
                next.extend(cell.children().into_iter().filter(|c| c.x < width && c.y < height));
            }
        }
        cells = next;
    }
}

/// Traces the samples of `cells` that are still missing, in the cells' order.
#[inline(never)]
fn sample(stage: &Stage, scratch: &mut Scratch, cells: &[Cell], corner: (usize, usize), shapes: u64) {
    let mut missing: Vec<Position> = Vec::new();
    let before = scratch.samples.0.len() * 8;
    for cell in cells {
        for (x, y) in cell.points().into_iter().chain(cell.middle(stage)) {
            let slot = &mut scratch.grid[y * GRID + x];
            if *slot == u32::MAX {
                *slot = (before + missing.len()) as u32;
                missing.push(((corner.0 + x) as f32 + 0.5, (corner.1 + y) as f32 + 0.5));
            }
        }
    }
    trace(stage, scratch, &missing, shapes);
}

/// Shapes that may cast a shadow on any surface between `samples`, per lamp.
fn shadow_casters(stage: &Stage, samples: &Samples) -> [u64; MAX_LAMPS] {
    let mut masks = [0; MAX_LAMPS];
    let hits =
        || (0..samples.0.len() * 8).map(|i| samples.get(i)).filter(|s| s.id() >= 0.0).map(|s| s.point());
    let Some(some) = hits().next() else { return masks };
    let (lo, hi) = hits().fold((some, some), |(lo, hi), p| (lo.min(p), hi.max(p)));
    // Curved patches bulge a little out of the box of their corners.
    let region = Region::cuboid(lo, hi, 0.02 * (hi - lo).length());
    for (mask, shafts) in masks.iter_mut().zip(&stage.shafts) {
        *mask = occluders(stage.scene, shafts, u64::MAX, None, &region);
    }
    masks
}

impl Corners<'_> {
    /// Whether all samples agree with the first in a property.
    fn all(&self, like: impl Fn(Sample, Sample) -> bool) -> bool {
        let first = self.corners[0];
        self.corners[1..].iter().chain(&self.centre).all(|&s| like(s, first))
    }

    /// Whether some sample has a property.
    fn any(&self, property: impl Fn(Sample) -> bool) -> bool {
        self.corners.iter().chain(&self.centre).any(|&s| property(s))
    }

    /// Whether all samples saw the same surface from about the same side, by the same lamps.
    fn same_surface(&self) -> bool {
        self.all(|s, first| {
            s.surface() == first.surface() && (s.id() < 0.0 || s.normal().dot(first.normal()) > 0.5)
        })
    }

    /// Whether mirrors and glass show the same things at all samples.
    fn same_signature(&self) -> bool {
        self.all(|s, first| s.signature() == first.signature())
    }

    /// Whether what the samples saw differs visibly.
    fn is_edge(&self, stage: &Stage) -> bool {
        let limit = 2.0 * stage.quality.tolerance;
        let contrast = |s: Sample, first: Sample| (s.display() - first.display()).abs().max_element();
        let alike = self.same_surface() && self.same_signature();
        !alike && !self.all(|s, first| contrast(s, first) <= limit)
    }

    /// Largest error of the bilinear display value at the centre; without a centre sample, the
    /// corners' span.
    pub fn colour_error(&self) -> f32 {
        let [a, b, c, d] = self.corners.map(|s| s.display());
        let error = match self.centre {
            Some(centre) => ((a + b + c + d) * 0.25 - centre.display()).abs(),
            None => a.max(b).max(c.max(d)) - a.min(b).min(c.min(d)),
        };
        error.max_element()
    }

    /// Whether the bilinear value at the centre is within tolerance of the true one; within a
    /// quarter of it where mirrors or glass show different things at the samples.
    ///
    /// Written so that NaN refines. Without a centre sample the corners must be this close.
    #[inline(never)]
    fn smooth(&self, stage: &Stage) -> bool {
        if !self.same_surface() {
            return false;
        }
        // Mirrors magnify relief: between samples farther apart than its cells nothing is known.
        let first = self.corners[0];
        let mirrors = first.material(stage).is_some_and(|m| m.reflection > 0.0);
        if mirrors && first.relief_within(stage, self.size) {
            return false;
        }
        let same = self.same_signature();
        let tolerance = stage.quality.tolerance * if same { 1.0 } else { 0.25 };
        let error = match self.centre {
            Some(centre) if stage.rung(centre.id()) == Rung::Surface => {
                let [a, b, c, d] = self.corners.map(|s| s.indirect());
                let predicted = stage.display.map(centre.direct() + (a + b + c + d) * 0.25);
                let error = (predicted - centre.display()).abs().max_element();
                // One corner in the mirror image of a lamp makes the mean white, right or wrong.
                if same { error } else { error.max(self.colour_error()) }
            }
            _ => self.colour_error(),
        };
        error <= tolerance
    }
}

impl Surroundings {
    /// Whether a shape, or the shadow of one, may lie between the samples of a cell.
    #[inline(never)]
    fn may_hide_something(
        &self,
        stage: &Stage,
        corner: (usize, usize),
        cell: Cell,
        known: &Corners,
        counters: &mut Counters,
    ) -> bool {
        let id = known.corners[0].id();
        let own = if id >= 0.0 { id as usize >> 2 } else { usize::MAX };
        let half = cell.size as f32 * 0.5;
        let middle = ((corner.0 + cell.x) as f32 + half + 0.5, (corner.1 + cell.y) as f32 + half + 0.5);
        let at = stage.on_screen(middle.0, middle.1);
        let reach = Vec2::splat(half * stage.pixel);
        let depths = known.corners.map(|s| s.depth());
        let deepest = depths.into_iter().fold(0.0, f32::max);
        for (i, dop) in stage.dops.iter().enumerate() {
            let field = matches!(stage.scene.shape(i), Shape::Field(_));
            if self.shapes >> (i & 63) & 1 == 0 || i == own || dop.unbounded || dop.near >= deepest || field {
                continue;
            }
            if dop.meets_rectangle(at, reach) && may_cover(stage, i, at, reach, &depths) {
                return true;
            }
        }
        for node in &stage.nodes {
            let known = node.shape == own && known.any(|s| s.node() == node.index);
            if self.shapes >> (node.shape & 63) & 1 == 1 && !known && node.may_cover(at, reach, &depths) {
                return true;
            }
        }
        let meshes = &stage.scene.meshes;
        let [right, up, forward] = [0, 1, 2].map(|axis| stage.view.world_from_view.col(axis));
        let towards = |sign: (f32, f32)| {
            let p = at + reach * Vec2::from(sign);
            right * p.x + up * p.y + forward
        };
        let corners = [(-1.0, 1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(towards);
        if meshes.may_lie_between(stage.view.origin, corners, depths, counters) {
            return true;
        }
        if own == usize::MAX {
            return false;
        }
        let points = known.corners.map(|s| s.point());
        // Between the corners a curved surface bulges out of their hull.
        let flat = matches!(stage.scene.shape(own), Shape::Plane(_) | Shape::Triangle(_) | Shape::Facet(..));
        let across = (points[3] - points[0]).length().max((points[2] - points[1]).length());
        let region = Region::patch(&points, if flat { 0.0 } else { 0.1 * across });
        let material = &stage.scene.materials[stage.scene.shape(own).material()];
        for (lamp, shafts) in stage.shafts.iter().enumerate() {
            let position = stage.lamps[lamp].position;
            let faces = known.corners.iter().any(|s| s.normal().dot(position - s.point()) > 0.0);
            let lit = faces && known.corners.iter().all(|s| s.code(lamp) != BLOCKED);
            if (self.shadows[lamp] == 0 && meshes.is_empty()) || !lit || !stage.lamps[lamp].lights(material) {
                continue;
            }
            let to = points.map(|p| p - position);
            if meshes.may_lie_between(position, to, [1.0; 4], counters) {
                return true;
            }
            // A body that already colours the light of all samples is known to be there.
            let crossed = known.corners[0].code(lamp) as u32;
            let may = occluders(stage.scene, shafts, self.shadows[lamp], Some(own), &region);
            for (i, &bit) in stage.bits.iter().enumerate() {
                let known_tint = bit > 0.0 && crossed & bit as u32 != 0;
                let unbounded = matches!(stage.scene.shape(i), Shape::Plane(_)) || stage.endless(i);
                if may >> (i & 63) & 1 == 1 && i != own && !known_tint && !unbounded {
                    return true;
                }
            }
        }
        false
    }
}
