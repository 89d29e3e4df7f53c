//! Laws of the walk: bit for bit what testing every cell finds, watertight against f64, nothing odd
//! is NaN or without end; and what edits do.

use super::*;
use crate::math::scalar::pow;
use crate::quality::Quality;
use crate::scene::{Edit, Field, Join, Material, Node, Scene};
use crate::trace::check::{Random, packet, splat as alone};
use crate::trace::walk::LEVEL;
use crate::trace::{nearest, surface};
use glam::DVec3;

/// A grid of random size in which about one of `sparse` cells is solid.
fn any_grid(random: &mut Random, most: u32, sparse: u32) -> Voxels {
    let size = [0; 3].map(|_| 1 + (random.bits() % most) as usize);
    let mut grid = Voxels::new(Vec3::ZERO, 1.0, size);
    grid.edit_all_by(&mut |_, _| if random.one_in(sparse) { 1 + (random.bits() % 3) as u8 } else { 0 });
    grid
}

/// A ray in cells: most are ordinary; many start or point at faces, edges and corners, run along them,
/// or start inside.
fn any_ray(random: &mut Random, grid: &Voxels) -> (Vec3, Vec3) {
    let size = Vec3::from_array(grid.size().map(|n| n as f32));
    let mut inside = || Vec3::from_array([0; 3].map(|_| random.range(-0.2, 1.2))) * size;
    let (a, b) = (inside(), inside());
    let (mut from, mut to) = (a + (a - b) * 3.0, b);
    let half = |p: Vec3| (p * 2.0).round() * 0.5;
    match random.bits() % 8 {
        0 => to = to.round(),
        1 => (from, to) = (from.round(), to.round()),
        2 => (from, to) = (half(from), half(to)),
        3 => from = half(b) + Vec3::from_array([0; 3].map(|_| random.signed(-20, 4))),
        4 => from = a,
        5 => from = b + (a - b) * 1000.0,
        _ => {}
    }
    let mut direction = to - from;
    for axis in 0..3 {
        if random.one_in(6) {
            direction[axis] = if random.one_in(2) { 0.0 } else { -0.0 };
        }
    }
    if direction == Vec3::ZERO {
        direction = Vec3::X;
    }
    if random.one_in(5) {
        // Equal in all axes: edges and corners one after another.
        direction = direction.signum() * 0.75;
    }
    (from, direction)
}

/// A ray in cells, cell by cell.
struct Ray {
    origin: Vec3,
    direction: Vec3,
}

impl Ray {
    fn new(origin: Vec3, direction: Vec3) -> Self {
        let direction =
            Vec3::from_array(direction.to_array().map(|d| if d.abs() < LEVEL { LEVEL } else { d }));
        Ray { origin, direction }
    }

    /// Distance of the nearer (or farther) face of a cell across an axis.
    fn face(&self, at: [i32; 3], axis: usize, leaving: bool) -> f32 {
        let far = (self.direction[axis] > 0.0) == leaving;
        ((at[axis] + i32::from(far)) as f32 - self.origin[axis]) * (1.0 / self.direction[axis])
    }

    /// When, and across which axis, it comes into a cell, at least 0 (and then across none, -1).
    fn enters(&self, at: [i32; 3]) -> (f32, i32) {
        (0..3).fold((0.0, -1), |last, axis| {
            let t = self.face(at, axis, false);
            if t >= last.0 { (t, axis as i32) } else { last }
        })
    }

    /// When, and across which axis, it leaves it.
    fn leaves(&self, at: [i32; 3]) -> (f32, i32) {
        (0..3).fold((f32::INFINITY, 0), |first, axis| {
            let t = self.face(at, axis, true);
            if t < first.0 { (t, axis as i32) } else { first }
        })
    }
}

/// What the walk finds for a ray in all lanes: distance and axis.
fn walk(
    grid: &Voxels,
    origin: Vec3,
    direction: Vec3,
    limit: f32,
    counters: &mut Counters,
) -> Option<(f32, i32)> {
    let rays = Rays8 { origin: V3::splat(origin), direction: V3::splat(direction) };
    let span = voxels(&rays, grid, splat(limit), counters);
    let (t, axis) = (span.enter.to_array()[3], span.enter_part.to_array()[3]);
    (t != -1.0).then_some((t, axis as i32))
}

/// What testing every solid cell finds.
fn brute(grid: &Voxels, ray: &Ray, limit: f32) -> Option<(f32, i32)> {
    let [nx, ny, nz] = grid.size().map(|n| n as i32);
    let mut best: Option<(f32, i32)> = None;
    for i in 0..nx * ny * nz {
        let at = [i % nx, i / nx % ny, i / (nx * ny)];
        let event = ray.enters(at);
        let met = event < ray.leaves(at) && event.0 > 0.0 && event.0 < limit;
        if met && Voxels::is_solid(grid.get(at)) && best.is_none_or(|best| event < best) {
            best = Some(event);
        }
    }
    best
}

#[test]
fn the_walk_finds_what_testing_every_cell_finds_bit_for_bit() {
    let mut hits = 0;
    for case in 0..6_000 {
        let random = &mut Random::new(case);
        let grid = any_grid(random, 14, [2, 5, 20, 60][case as usize % 4]);
        for ray in 0..20 {
            let (origin, direction) = any_ray(random, &grid);
            let limit = if random.one_in(4) { random.range(0.0, 2.0) } else { f32::INFINITY };
            let mut counters = Counters::default();
            let found = walk(&grid, origin, direction, limit, &mut counters);
            let every = brute(&grid, &Ray::new(origin, direction), limit);
            assert_eq!(
                found.map(|(t, axis)| (t.to_bits(), axis)),
                every.map(|(t, axis)| (t.to_bits(), axis)),
                "case {case}, ray {ray}: {found:?} instead of {every:?}: {origin:?} {direction:?}"
            );
            let steps = counters.get(Counter::VoxelSteps);
            assert!(steps <= 8 * 3 * 16, "case {case}, ray {ray}: {steps} steps");
            hits += u32::from(found.is_some());
        }
    }
    assert!(hits > 25_000, "{hits} of 120,000 rays hit something");
}

/// First distance over 0 at which an exact ray comes into a solid cell whose sides are moved out by
/// `grow`.
fn exact(grid: &Voxels, origin: DVec3, direction: DVec3, grow: f64) -> f64 {
    let [nx, ny, nz] = grid.size().map(|n| n as i32);
    let mut best = f64::INFINITY;
    for i in 0..nx * ny * nz {
        let at = [i % nx, i / nx % ny, i / (nx * ny)];
        if !Voxels::is_solid(grid.get(at)) {
            continue;
        }
        let (mut enter, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (lo, hi) = (f64::from(at[axis]) - grow, f64::from(at[axis]) + 1.0 + grow);
            if direction[axis] == 0.0 {
                if origin[axis] < lo || origin[axis] > hi {
                    exit = f64::NEG_INFINITY;
                }
                continue;
            }
            let (a, b) = ((lo - origin[axis]) / direction[axis], (hi - origin[axis]) / direction[axis]);
            (enter, exit) = (enter.max(a.min(b)), exit.min(a.max(b)));
        }
        if enter < exit && enter > 0.0 {
            best = best.min(enter);
        }
    }
    best
}

#[test]
fn walls_are_watertight_and_nothing_is_met_that_is_not_there() {
    for case in 0..3_000 {
        let random = &mut Random::new(77_000 + case);
        let grid = any_grid(random, 10, [1, 3, 12][case as usize % 3]);
        let size = Vec3::from_array(grid.size().map(|n| n as f32));
        let target = (Vec3::from_array([0; 3].map(|_| random.range(0.0, 1.0))) * size).round();
        // From outside to a corner of cells, where a gap would be.
        let origin = target + random.direction() * 40.0;
        let direction = (target - origin) * (1.0 + random.range(0.0, 1e-6));
        let found = walk(&grid, origin, direction, f32::INFINITY, &mut Counters::default());
        let found = found.map_or(f64::INFINITY, |(t, _)| t.into());
        let (o, d) = (origin.as_dvec3(), direction.as_dvec3());
        let grow = 1e-4;
        let (least, most) = (exact(&grid, o, d, grow), exact(&grid, o, d, -grow));
        // The faces are `grow` apart, which a slanted ray crosses in 1/cos of that.
        let slant = (0..3).map(|i| 1.0 / d[i].abs().max(1e-9)).fold(0.0, f64::max);
        let room = 2.0 * grow * slant + 1e-6;
        assert!(
            found >= least - room && found <= most + room,
            "case {case}: {found} outside {least}..{most}: {origin:?} {direction:?}"
        );
    }
}

#[test]
fn a_ray_along_a_face_belongs_to_one_of_its_sides() {
    let mut grid = Voxels::new(Vec3::ZERO, 1.0, [8, 8, 8]);
    grid.edit(Edit::Add(1), [5, 3, 3], [6, 4, 4]);
    let walk = |o: [f32; 3], d: [f32; 3]| {
        walk(&grid, o.into(), d.into(), f32::INFINITY, &mut Counters::default()).map(|(t, _)| t)
    };
    // Just along the lower face: it belongs to the cell above, whichever sign the 0 has.
    assert_eq!(walk([0.0, 3.0, 3.5], [1.0, 0.0, 0.0]), Some(5.0));
    assert_eq!(walk([0.0, 3.0, 3.5], [1.0, -0.0, 0.0]), Some(5.0));
    assert_eq!(walk([0.0, 4.0, 3.5], [1.0, 0.0, 0.0]), None);
    // Two such rays never both miss, and the cell is as wide as it is.
    assert_eq!(walk([0.0, 3.5, 4.0], [1.0, 0.0, 0.0]), None);
    assert_eq!(walk([0.0, 3.5, 3.0], [2.0, 0.0, 0.0]), Some(2.5));
    // Through the corner (5, 3, 3) along the diagonal.
    assert_eq!(walk([4.0, 2.0, 2.0], [1.0, 1.0, 1.0]), Some(1.0));
    // Nothing, nowhere, and back.
    assert_eq!(walk([0.5; 3], [0.0; 3]), None);
    assert_eq!(walk([9.0, 3.5, 3.5], [1.0, 0.0, 0.0]), None);
    assert_eq!(walk([9.0, 3.5, 3.5], [-1.0, 0.0, 0.0]), Some(3.0));
    // From the middle of the cell it is not met.
    assert_eq!(walk([5.5, 3.5, 3.5], [-1.0, 0.3, 0.0]), None);
}

#[test]
fn odd_rays_end_and_are_never_nan() {
    let grid = any_grid(&mut Random::new(5), 12, 8);
    for (origin, direction) in crate::trace::check::poisoned() {
        let mut counters = Counters::default();
        if let Some((t, _)) = walk(&grid, origin, direction, f32::INFINITY, &mut counters) {
            assert!(t > 0.0, "{origin:?} {direction:?}");
        }
        assert!(counters.get(Counter::VoxelSteps) < 800, "{origin:?} {direction:?}");
    }
}

/// A grid of its own place and cell size in a scene.
fn any_scene(random: &mut Random) -> Scene {
    let mut grid = any_grid(random, 20, 6);
    let materials = (0..3).map(|i| Material { colour: Vec3::splat(0.2 * i as f32), ..Material::default() });
    let materials = materials.collect();
    let rule = grid.clone();
    grid = Voxels::new(random.vector(-2, 2), random.size(-4, 1), rule.size());
    grid.edit_all_by(&mut |at, _| rule.get(at));
    Scene { voxels: vec![grid], materials, ..Scene::default() }
}

#[test]
fn rays_in_packets_meet_what_they_meet_alone_and_leave_the_surface_they_start_on() {
    let quality = Quality::PRESETS[3].1;
    let mut counters = Counters::default();
    let mut left = 0;
    for case in 0..2_000 {
        let random = &mut Random::new(9_000 + case);
        let scene = any_scene(random);
        let grid = &scene.voxels[0];
        let [lo, hi] = grid.bounds();
        let rays = packet(|| {
            let target = lo + (hi - lo) * Vec3::from_array([0; 3].map(|_| random.range(0.0, 1.0)));
            let origin = target + random.direction() * random.size(-1, 6) * (hi - lo).length();
            (origin, (target - origin).normalize_or(Vec3::X))
        });
        let hits = nearest(&scene, &quality, &rays, u64::MAX, &mut counters);
        for lane in 0..8 {
            let one = nearest(&scene, &quality, &alone(&rays, lane), u64::MAX, &mut counters);
            assert_eq!(hits.t.to_array()[lane].to_bits(), one.t.to_array()[lane].to_bits(), "case {case}");
            assert_eq!(hits.id.to_array()[lane].to_bits(), one.id.to_array()[lane].to_bits(), "case {case}");
        }
        let hit = hits.id.simd_ge(F::ZERO);
        let t = hit.select(hits.t, F::ZERO);
        let s = surface(&scene, &quality, &rays, t, hits.id, splat(1e-3));
        for lane in (0..8).filter(|&lane| hits.id.to_array()[lane] >= 0.0) {
            let (n, p) = (s.facing.lane(lane), s.point.lane(lane));
            assert!(n.dot(rays.direction.lane(lane)) < 0.0, "case {case}: {n:?}");
            assert_eq!(s.normal.lane(lane), n);
            let clearance = s.clearance.to_array()[lane];
            // In front of the face is an empty cell, but perhaps not beside it.
            let within = ((p - grid.lo) / grid.cell).to_array().map(|x| (x - x.round()).abs());
            if (0..3).filter(|&axis| within[axis] < 1e-3).count() > 1 {
                continue;
            }
            let ray = Rays8 { origin: V3::splat(p + n * clearance), direction: V3::splat(n) };
            let next = nearest(&scene, &quality, &ray, u64::MAX, &mut counters).t.to_array()[0];
            assert!(next > 0.999 * grid.cell, "case {case}: {next} from {p:?} along {n:?}");
            left += 1;
        }
    }
    assert!(left > 500, "{left}");
}

#[test]
fn edits_do_what_they_say() {
    let mut grid = Voxels::new(Vec3::ZERO, 1.0, [9, 6, 5]);
    assert_eq!(grid.materials(), 0..0);
    grid.edit(Edit::Add(3), [1, 1, 1], [4, 3, 3]);
    let count = |grid: &Voxels, what: &dyn Fn(u8) -> bool| {
        let [nx, ny, nz] = grid.size().map(|n| n as i32);
        let all = (0..nx * ny * nz).map(|i| grid.get([i % nx, i / nx % ny, i / (nx * ny)]));
        all.filter(|&v| what(v)).count()
    };
    assert_eq!(count(&grid, &|v| v == 3), 12);
    assert_eq!(grid.bounds(), [Vec3::ONE, Vec3::new(4.0, 3.0, 3.0)]);
    assert_eq!(grid.materials(), 0..3);
    grid.edit_all(Edit::Add(1));
    assert_eq!(count(&grid, &|v| v == 3), 12, "what is there stays");
    grid.edit_all(Edit::Paint(2));
    assert_eq!(count(&grid, &|v| v == 2), 9 * 6 * 5);
    grid.edit_all(Edit::PaintRandomly(4, 64, 1));
    let some = count(&grid, &|v| v == 4);
    assert!((40..95).contains(&some), "a quarter of 270: {some}");
    grid.edit(Edit::Remove, [0, 0, 0], [9, 6, 1]);
    assert_eq!(count(&grid, &|v| v == 0), 54);
    grid.edit_layer(Edit::Convert, 5);
    assert_eq!(count(&grid, &|v| v == Voxels::SMOKE), 36, "one layer without the part removed");
    assert_eq!(grid.bounds()[1].y, 5.0, "smoke is not solid");
    grid.edit_all(Edit::Convert);
    assert_eq!(count(&grid, &|v| v == Voxels::SMOKE), 216);
    assert_eq!((grid.materials(), grid.bounds()), (0..0, [Vec3::ZERO; 2]));
    grid.edit_all(Edit::Overwrite(7));
    assert_eq!(count(&grid, &|v| v == 7), 270);
    assert_eq!(grid.get([-1, 0, 0]) + grid.get([9, 0, 0]) + grid.get([0, i32::MAX, 0]), 0);
}

#[test]
fn edits_of_a_region_leave_the_rest_and_what_they_are_not_for() {
    // Solid cells of values 1 to 3 and empty ones, mixed.
    let random = &mut Random::new(3);
    let mut before = Voxels::new(Vec3::ZERO, 1.0, [11, 9, 10]);
    before.edit_all_by(&mut |_, _| (random.bits() % 4) as u8);
    let (lo, hi) = ([2, 1, 3], [9, 7, 8]);
    let all = || (0..11 * 9 * 10).map(|i| [i % 11, i / 11 % 9, i / 99]);
    let edits = [
        Edit::Add(7),
        Edit::Remove,
        Edit::Paint(7),
        Edit::PaintRandomly(7, 128, 5),
        Edit::Overwrite(7),
        Edit::Convert,
    ];
    for edit in edits {
        let mut after = before.clone();
        after.edit(edit, lo, hi);
        let (mut painted, mut within) = (0, 0);
        for at in all() {
            let (old, new) = (before.get(at), after.get(at));
            let inside = (0..3).all(|axis| (lo[axis]..hi[axis]).contains(&at[axis]));
            let solid = old != Voxels::EMPTY;
            let expected = match edit {
                _ if !inside => old,
                Edit::Add(v) => [v, old][usize::from(solid)],
                Edit::Remove => Voxels::EMPTY,
                Edit::Paint(v) => [old, v][usize::from(solid)],
                Edit::PaintRandomly(v, ..) if solid && new == v => new,
                Edit::PaintRandomly(..) => old,
                Edit::Overwrite(v) => v,
                Edit::Convert => [old, Voxels::SMOKE][usize::from(solid)],
            };
            assert_eq!(new, expected, "{edit:?} at {at:?}, was {old}");
            within += u32::from(inside && solid);
            painted += u32::from(inside && new == 7);
        }
        if matches!(edit, Edit::PaintRandomly(..)) {
            // Four standard deviations of a half; the same cells again, others by another seed.
            assert!((f64::from(painted) / f64::from(within) - 0.5).abs() < 0.16, "{painted} of {within}");
            let again = |seed| {
                let mut grid = before.clone();
                grid.edit(Edit::PaintRandomly(7, 128, seed), lo, hi);
                grid
            };
            assert!(again(5) == after && again(6) != after);
        }
    }
    // A layer is the region of its height, all is the region of the grid.
    for edit in edits {
        let [mut layer, mut region, mut whole, mut most] = [0; 4].map(|_| before.clone());
        layer.edit_layer(edit, 4);
        region.edit(edit, [0, 4, 0], [11, 5, 10]);
        whole.edit_all(edit);
        most.edit(edit, [i32::MIN; 3], [i32::MAX; 3]);
        assert!(layer == region && whole == most, "{edit:?}");
    }
}

#[test]
fn the_largest_grid_is_walked_as_well() {
    let random = &mut Random::new(128);
    let mut grid = Voxels::new(Vec3::ZERO, 1.0, [200; 3]);
    assert_eq!(grid.size(), [Voxels::MOST; 3], "more cells than that there aren't");
    grid.edit_all_by(&mut |_, _| u8::from(random.one_in(150)));
    let mut hits = 0;
    for case in 0..24 {
        let (origin, direction) = any_ray(random, &grid);
        let found = walk(&grid, origin, direction, f32::INFINITY, &mut Counters::default());
        let every = brute(&grid, &Ray::new(origin, direction), f32::INFINITY);
        let bits = |found: Option<(f32, i32)>| found.map(|(t, axis)| (t.to_bits(), axis));
        assert_eq!(bits(found), bits(every), "ray {case}: {origin:?} {direction:?}");
        hits += u32::from(found.is_some());
    }
    assert!(hits > 2, "{hits} of 24 rays hit something");
}

#[test]
fn a_body_fills_the_cells_whose_middles_it_holds() {
    let body = Field::new(vec![
        Node::sphere(Vec3::ZERO, 1.0),
        Node::sphere(Vec3::X, 0.5).joined(Join::Subtraction, 0.0),
    ]);
    let mut grid = Voxels::new(Vec3::splat(-1.2), 0.1, [21, 24, 24]);
    grid.fill(&body, 1);
    let mut filled = 0;
    for i in 0..21 * 24 * 24 {
        let at = [i % 21, i / 21 % 24, i / (21 * 24)];
        let p = Vec3::splat(-1.2) + (Vec3::from_array(at.map(|i| i as f32)) + 0.5) * 0.1;
        let inside = (p.length() - 1.0).max(0.5 - (p - Vec3::X).length());
        if inside.abs() > 1e-5 {
            assert_eq!(grid.get(at) == 1, inside < 0.0, "{at:?}");
        }
        filled += u32::from(grid.get(at));
    }
    // The ball's volume but for the part cut away and what sticks out of the grid.
    let volume = filled as f32 * pow(0.1, 3.0);
    assert!((3.2..4.2).contains(&volume), "{volume}");
}
