//! The walk through cells against exact arithmetic.

use super::draw::*;
use dashu_ratio::RBig;
use glam::Vec3;
use luc_core::kernels::{self, Ray, Visit};
use luc_core::math::hash::hash2;
use luc_core::math::lanes::{INFINITY, V3};
use luc_core::scene::Voxels;
use luc_core::trace::{self, Rays8};
use proptest::prelude::*;

/// Where a ray is within a cell, closed: exact distances at which it enters and leaves. `None` if it never is.
fn within(ray: &Ray, cell: [i32; 3]) -> Option<(RBig, Option<RBig>)> {
    let (o, d) = (exact3(ray.origin), exact3(ray.direction));
    let (mut enter, mut exit) = (RBig::ZERO, None::<RBig>);
    for axis in 0..3 {
        let (lo, hi) = (RBig::from(cell[axis]), RBig::from(cell[axis] + 1));
        if d[axis] == RBig::ZERO {
            // Along a face a ray is in the cell above.
            if o[axis] < lo || o[axis] >= hi {
                return None;
            }
            continue;
        }
        let (a, b) = ((lo - &o[axis]) / &d[axis], (hi - &o[axis]) / &d[axis]);
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        enter = enter.max(near);
        exit = Some(exit.map_or(far.clone(), |e| e.min(far)));
    }
    exit.as_ref().is_none_or(|exit| &enter <= exit).then_some((enter, exit))
}

/// Begins anywhere, or on a face, an edge or a corner, within the grid or not; goes anywhere, along
/// axes, or through edges and corners.
fn rays() -> impl Strategy<Value = Ray> + Clone {
    let place = || prop_oneof![3 => range(-4.0, 16.0), 2 => (-3..16_i32).prop_map(|i| i as f32), 1 => signed(-40, 12)];
    let way = prop_oneof![
        3 => [range(-1.0, 1.0), range(-1.0, 1.0), range(-1.0, 1.0)],
        2 => [signed(0, 1), signed(0, 1), signed(0, 1)].prop_map(|v| v.map(|x| x.signum() * x.abs().floor())),
        2 => [signed(-3, 0), signed(-24, 0), signed(-60, -59)],
    ];
    ([place(), place(), place()], way, size(-8, 8)).prop_map(|(origin, way, length)| Ray {
        origin: Vec3::from_array(origin),
        direction: Vec3::from_array(way) * length,
    })
}

fn sizes() -> impl Strategy<Value = [usize; 3]> + Clone {
    [1..13_usize, 1..13_usize, 1..13_usize]
}

/// The exact walk, for rays whose crossings f32 has exactly: from face to face, x before y before z.
fn exact_walk(ray: &Ray, size: [usize; 3]) -> Vec<Visit> {
    let (o, d) = (exact3(ray.origin), exact3(ray.direction));
    let up = |axis: usize| d[axis] >= RBig::ZERO;
    // Far enough outside to come in by a face.
    let mut cell: [i32; 3] = std::array::from_fn(|axis| {
        if d[axis] == RBig::ZERO {
            ray.origin.to_array()[axis].floor() as i32
        } else if up(axis) {
            -64
        } else {
            64
        }
    });
    let mut visits = Vec::new();
    let mut enter = RBig::ZERO;
    for _ in 0..1000 {
        let faces = (0..3).filter(|&axis| d[axis] != RBig::ZERO);
        let far =
            faces.map(|axis| ((RBig::from(cell[axis] + i32::from(up(axis))) - &o[axis]) / &d[axis], axis));
        let leave = far.min();
        let inside = (0..3).all(|axis| cell[axis] >= 0 && cell[axis] < size[axis] as i32);
        if inside && leave.as_ref().is_none_or(|(leave, _)| leave > &RBig::ZERO) {
            visits.push(Visit { cell, enter: near(&enter) as f32 });
        }
        // Without a direction it stays where it is.
        let Some((leave, axis)) = leave else { break };
        enter = leave.max(RBig::ZERO);
        cell[axis] += if up(axis) { 1 } else { -1 };
    }
    visits
}

proptest! {
    #![proptest_config(config(20_000))]

    #[test]
    fn a_walk_passes_what_the_line_passes(ray in rays(), size in sizes()) {
        let visits = kernels::walk(&ray, size);
        let room = |t: &RBig| wide(8.0 * U * near(t).abs() + 1e-40);
        for pair in visits.windows(2) {
            let step: Vec<i32> = (0..3).map(|axis| pair[1].cell[axis] - pair[0].cell[axis]).collect();
            let length: i32 = step.iter().map(|s| s.abs()).sum();
            let along = (0..3).all(|axis| step[axis] as f32 * ray.direction[axis] >= 0.0);
            prop_assert!(length == 1 && along && pair[0].enter <= pair[1].enter, "{pair:?}: {ray:?} {size:?}");
        }
        for visit in &visits {
            // The cell, or one beside it that rounding can't tell from it, is there when it is said to be.
            let t = exact(visit.enter);
            let Some((enter, exit)) = within(&ray, visit.cell) else {
                let near_by = (0..3).any(|axis| {
                    let at = f64::from(ray.origin[axis]) + f64::from(ray.direction[axis]) * f64::from(visit.enter);
                    (at - at.round()).abs() <= 16.0 * U * (1.0 + at.abs() + f64::from(ray.origin[axis].abs()))
                });
                prop_assert!(near_by, "not there: {visit:?} {ray:?} {size:?}");
                continue;
            };
            prop_assert!(t >= &enter - room(&enter) && exit.is_none_or(|exit| t <= &exit + room(&exit)), "{visit:?} {ray:?} {size:?}");
            prop_assert!(near(&(&t - &enter)).abs() <= 8.0 * U * near(&enter) + 1e-40, "{visit:?} {enter}: {ray:?} {size:?}");
        }
        for i in 0..size.iter().product::<usize>() {
            let cell = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])].map(|x| x as i32);
            let Some((enter, Some(exit))) = within(&ray, cell) else { continue };
            // Longer within than rounding, and than the faces' own.
            let certain = &exit - &enter > room(&exit) + room(&enter);
            if certain && ray.origin.abs().max_element() < 1e5 {
                prop_assert!(visits.iter().any(|v| v.cell == cell), "lost {cell:?} at {enter}: {ray:?} {size:?}");
            }
        }
    }

    /// Along axes and diagonals, from faces, edges and corners: nothing is rounded, so all is exact.
    #[test]
    fn where_nothing_is_rounded_a_walk_is_exact(
        origin in prop::array::uniform3((-40..60_i32).prop_map(|i| i as f32 * 0.25)),
        way in prop::array::uniform3(prop::sample::select(vec![0.0_f32, -0.0, 1.0, -1.0, 0.5, -0.5, 2.0, -4.0])),
        size in sizes(),
    ) {
        let ray = Ray { origin: Vec3::from_array(origin), direction: Vec3::from_array(way) };
        prop_assert_eq!(kernels::walk(&ray, size), exact_walk(&ray, size), "{:?} {:?}", ray, size);
    }

    /// The engine's walk over bricks meets the first solid cell of this one, bit for bit.
    #[test]
    fn voxels_are_met_where_the_walk_passes_them(ray in rays(), size in sizes(), seed in any::<u32>()) {
        let mut grid = Voxels::new(Vec3::ZERO.into(), 1.0, size);
        let mut cell = 0;
        grid.edit_all_by(&mut |_, _| {
            cell += 1;
            u8::from(hash2(cell, seed) < u32::MAX / 16)
        });
        let rays = Rays8 { origin: V3::splat(ray.origin), direction: V3::splat(ray.direction) };
        let met = trace::voxels(&rays, &grid, INFINITY, &mut Default::default()).enter.as_array()[0];
        let first = kernels::walk(&ray, size).into_iter().find(|v| v.enter > 0.0 && grid.get(v.cell) == 1);
        prop_assert_eq!(met, first.map_or(-1.0, |v| v.enter), "{:?} {:?} {}", ray, size, seed);
    }
}
