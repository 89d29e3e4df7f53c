//! Laws of fields: slopes stay under the stated constant, marching finds what dense stepping finds,
//! leaving bodies out changes no hit, normals agree with f64, nothing odd is NaN.

use super::*;
use crate::counters::Counters;
use crate::math::Mat3;
use crate::scene::{Material, Scene};
use crate::trace::check::{Random, packet, splat as alone};
use crate::trace::{nearest, surface};
use glam::DVec3;

/// The preset that the tests march with, but for its bound of steps.
const HIGH: Quality = Quality { steps: 4096, ..Quality::PRESETS[3].1 };

const ALL: Nodes = [TRUE; Field::MOST];

/// A node of any form and join, a few units from the origin.
fn any_node(random: &mut Random, first: bool) -> Node {
    let at = random.vector(-2, 1);
    let size = random.size(-2, 0);
    let half = Vec3::from_array([0; 3].map(|_| random.range(0.1, 0.6)));
    let node = match random.bits() % if first { 6 } else { 9 } {
        0 => Node::sphere(at, size),
        1 => Node::cuboid(at, half, 0.0),
        2 => Node::cuboid(at, half, 0.09),
        3 => Node::torus(at, size, 0.1),
        4 => Node::cylinder(at, half.y, half.x),
        5 => Node::capsule(at, half.y, half.x),
        6 => Node::plane(at, random.direction()),
        7 => Node::cross(half.x, 0.05),
        _ => return Node::swell(random.range(0.0, 0.1), random.range(1.0, 9.0)),
    };
    let axes = random.one_in(2).then(|| {
        let (y, (x, z)) = {
            let y = random.direction();
            (y, y.any_orthonormal_pair())
        };
        Mat3::from_cols(x, y, z)
    });
    let join = match random.bits() % 4 {
        _ if first => Join::Union,
        0 => Join::Intersection,
        1 => Join::Subtraction,
        _ => Join::Union,
    };
    let blend = if random.one_in(3) { 0.0 } else { random.range(0.0, 0.5) };
    Node { axes, mix: random.one_in(2), repeats: random.one_in(3), ..node.joined(join, blend) }
}

/// A field of one to six nodes; one in three repeats.
fn any_field(random: &mut Random) -> Field {
    let count = 1 + random.bits() as usize % 6;
    let mut field = Field::new((0..count).map(|i| any_node(random, i == 0)).collect());
    field.cell =
        Vec3::from_array([0; 3].map(|_| if random.one_in(2) { 0.0 } else { random.range(0.8, 2.5) }));
    field.copies = Vec3::from_array([0; 3].map(|_| if random.one_in(2) { f32::INFINITY } else { 2.0 }));
    (field.lo, field.hi) = (Vec3::splat(-4.0), Vec3::splat(4.0));
    field
}

fn at(field: &Field, p: Vec3) -> f32 {
    distance(field, V3::splat(p), &ALL, None).as_array()[3]
}

#[test]
fn values_change_no_faster_than_stated() {
    let mut random = Random::new(710);
    for case in 0..40_000 {
        let field = any_field(&mut random);
        let slope = f64::from(field.lipschitz());
        let p = random.vector(-3, 3);
        let q = p + random.vector(-9, 2);
        let (a, b) = (at(&field, p), at(&field, q));
        assert!(a.is_finite() && b.is_finite(), "{field:?} at {p:?} {q:?}: {a} {b}");
        let apart = (p.as_dvec3() - q.as_dvec3()).length();
        // Rounding of the points and of the few sums on the way to the value.
        let rounding = 4e-6 * slope * f64::from(1.0 + p.length() + q.length());
        let change = f64::from((a - b).abs());
        assert!(
            change <= slope * apart + rounding,
            "case {case}: {change} over {apart}, {slope}: {field:?} {p:?} {q:?}"
        );
    }
}

#[test]
fn values_are_finite_for_odd_data_and_far_away() {
    let mut random = Random::new(711);
    for _ in 0..3_000 {
        let mut field = any_field(&mut random);
        for node in &mut field.nodes {
            if random.one_in(3) {
                node.blend = [0.0, 1e-30, 1e-38][random.bits() as usize % 3];
            }
            if random.one_in(4) {
                node.axes = Some(Mat3::ZERO);
            }
            if random.one_in(4) {
                (node.form, node.rounding) = (Form::Round([0.0; 3]), 0.0);
            }
        }
        for p in [Vec3::ZERO, Vec3::splat(1e6), random.direction() * 1e15, field.nodes[0].centre] {
            let value = at(&field, p);
            assert!(value.is_finite(), "{field:?} at {p:?}: {value}");
            let found = locate(&field, V3::splat(p), F::ZERO, V3::splat(Vec3::X));
            let n = found.outward.lane(0);
            assert!(
                (n.length() - 1.0).abs() < 1e-5 && found.point.lane(0).is_finite(),
                "{field:?} at {p:?}: {n}"
            );
        }
    }
}

#[test]
fn a_field_that_is_scaled_turned_and_moved_has_the_same_values_times_the_scale() {
    let mut random = Random::new(714);
    for case in 0..4_000 {
        let field = Field { cell: Vec3::ZERO, ..any_field(&mut random) };
        let (scale, offset) = (random.size(-2, 2), random.vector(-2, 2));
        let y = random.direction();
        let (x, z) = y.any_orthonormal_pair();
        let turn = Mat3::from_cols(x, y, z);
        let place = |node: &Node| node.placed(scale, turn, offset);
        let placed = Field { nodes: field.nodes.iter().map(place).collect(), ..field.clone() };
        let p = random.vector(-2, 2);
        let (a, b) = (at(&field, p) * scale, at(&placed, turn * p * scale + offset));
        let slope = field.lipschitz();
        let rounding = 1e-5 * slope * (scale * (1.0 + p.length()) + offset.length());
        assert!((a - b).abs() <= rounding, "case {case}: {a} {b} {field:?} {placed:?} {p:?}");
        let off = (placed.lipschitz() - slope).abs();
        assert!(off <= 1e-5 * slope, "slopes stay: {slope} {}", placed.lipschitz());
    }
}

#[test]
fn shares_sum_to_one() {
    let mut random = Random::new(712);
    for _ in 0..5_000 {
        let field = any_field(&mut random);
        let mut shares = [F::ZERO; Field::MOST];
        distance(&field, V3::splat(random.vector(-3, 3)), &ALL, Some(&mut shares));
        let shares: Vec<f32> = shares.iter().map(|s| s.as_array()[0]).collect();
        let sum: f32 = shares.iter().sum();
        assert!((sum - 1.0).abs() < 1e-5 && shares.iter().all(|&s| s >= 0.0), "{field:?}: {shares:?}");
    }
}

/// First place, in steps of `step`, where the value changes its sign, and how near it comes before.
fn dense(field: &Field, o: Vec3, d: Vec3, step: f32, end: f32) -> Option<f32> {
    let begin = at(field, o) < 0.0;
    (1..(end / step) as usize).map(|i| i as f32 * step).find(|&t| (at(field, o + d * t) < 0.0) != begin)
}

#[test]
fn marching_finds_what_dense_stepping_finds() {
    // In all but the first a ray meets a swell outside of the body that it is on.
    for stream in [713, 4_809, 8_905, 33_481] {
        marching_against_dense_stepping(&mut Random::new(stream));
    }
}

fn marching_against_dense_stepping(random: &mut Random) {
    let (mut hits, mut misses) = (0, 0);
    while hits < 800 || misses < 200 {
        let field = any_field(random);
        let o = random.direction() * random.range(0.0, 3.5);
        let d = (random.vector(-2, 1) - o).normalize_or(Vec3::X);
        let rays = packet(|| (o, d));
        let (enter, exit) = rays.in_box(field.lo, field.hi, INFINITY);
        // Only rays that begin in the box, clear of the surface.
        let start = at(&field, o);
        if enter.as_array()[0] > 0.0 || start.abs() < 0.01 {
            continue;
        }
        let end = exit.as_array()[0];
        let span = super::field(&rays, &field, INFINITY, &HIGH, &mut Counters::default());
        let (t, _) = span.first();
        let t = t.as_array()[2];
        let truth = dense(&field, o, d, 2e-3, end);
        let replay = || format!("{field:?} origin {o:?} direction {d:?} from {start}: {t} truth {truth:?}");
        let blend = field.nodes.iter().fold(0.0, |k: f32, n| k.max(n.blend));
        // Where three bodies meet, one left out may move the surface by a hundredth of the join.
        let skin = 0.02 * blend + 2.0 * HIGH.epsilon * (1.0 + end);
        if t > 0.0 {
            hits += 1;
            assert!(truth.is_none_or(|truth| t <= truth + 2.0 * skin), "late {}", replay());
            assert!(
                at(&field, o + d * t).abs() <= field.lipschitz() * skin,
                "off by {}: {}",
                at(&field, o + d * t),
                replay()
            );
            assert_eq!(span.enter.as_array()[0] < 0.0, start < 0.0, "side {}", replay());
        } else {
            misses += 1;
            // What only dips in by less than the skin is no loss.
            let deep = truth.is_some_and(|t| {
                (0..200).any(|i| at(&field, o + d * (t + 2e-3 * i as f32).min(end)) * start.signum() < -skin)
            });
            assert!(!deep, "lost {}", replay());
        }
    }
}

#[test]
fn a_lane_marches_as_alone() {
    let mut random = Random::new(714);
    for _ in 0..500 {
        let field = any_field(&mut random);
        let rays = packet(|| (random.vector(-2, 3), random.direction() * random.size(-2, 2)));
        let march = |rays: &Rays8| super::field(rays, &field, splat(9.0), &HIGH, &mut Counters::default());
        let together = march(&rays);
        for lane in 0..8 {
            let one = march(&alone(&rays, lane));
            let bits = |s: &Span, i: usize| [s.enter, s.exit].map(|v| v.as_array()[i].to_bits());
            assert_eq!(
                bits(&together, lane),
                bits(&one, 0),
                "lane {lane}: {field:?} {:?} {:?}",
                rays.origin,
                rays.direction
            );
        }
    }
}

/// A scene of one field of one sharp convex body.
fn convex(random: &mut Random, kind: u32) -> (Scene, Node) {
    let at = random.vector(-2, 3);
    let node = match kind {
        0 => Node::sphere(at, random.size(-2, 1)),
        1 => Node::cuboid(at, Vec3::new(0.4, 0.7, 0.5), 0.1),
        2 => Node::cylinder(at, 0.6, 0.4),
        _ => Node::capsule(at, 0.6, 0.4),
    };
    let glass = Material { transparency: 1.0, ior: 1.5, ..Material::default() };
    (Scene { fields: vec![Field::new(vec![node])], materials: vec![glass], ..Scene::default() }, node)
}

/// Unit normal of a node's form in f64, at points not on an edge. Where a flat side meets a rounded one
/// of radius r, differences over h = 0.005 are off by h / 4r = 0.013, which is 8e-5 in the cosine.
fn truth(node: &Node, p: DVec3) -> DVec3 {
    let p = p - node.centre.as_dvec3();
    match node.form {
        Form::Round(_) if (p.y.abs() - 0.6).abs() < 1e-2 => DVec3::Y * p.y.signum(),
        Form::Round(_) => DVec3::new(p.x, 0.0, p.z).normalize(),
        Form::Box(half) => (p - p.clamp(-half.as_dvec3(), half.as_dvec3())).normalize(),
        _ => DVec3::ZERO,
    }
}

#[test]
fn normals_are_those_of_f64_and_rays_get_away() {
    // In the second a ray leaves a rim, down along the side.
    for stream in [715, 37_579] {
        normals_and_rays_away(&mut Random::new(stream));
    }
}

fn normals_and_rays_away(random: &mut Random) {
    let (mut seen, mut inner) = (0, 0);
    for case in 0..4_000 {
        let (scene, node) = convex(random, case % 4);
        let counters = &mut Counters::default();
        let rays = packet(|| {
            let d = random.direction();
            (node.centre + random.vector(-3, -1) - d * random.range(2.0, 20.0), d)
        });
        let hit = nearest(&scene, &HIGH, &rays, u64::MAX, counters);
        let solid = hit.id.simd_ge(F::ZERO);
        let s = surface(&scene, &HIGH, &rays, solid.select(hit.t, F::ZERO), hit.id, F::ZERO);
        // Away at more than 4° over the surface, and into the body.
        let any = packet(|| (Vec3::ZERO, random.direction()));
        let up = any.direction.dot(s.outward());
        let away = V3::select(up.simd_lt(F::ZERO), -any.direction, any.direction);
        let out = Rays8 { origin: s.point + s.outward() * s.clearance, direction: away };
        let steep = up.abs().simd_gt(splat(0.07));
        let again = solid & steep & nearest(&scene, &HIGH, &out, u64::MAX, counters).id.simd_ge(F::ZERO);
        let into = Rays8 { origin: s.point - s.outward() * s.clearance, direction: -s.outward() };
        let exit = nearest(&scene, &HIGH, &into, u64::MAX, counters);
        let far = surface(&scene, &HIGH, &into, exit.t, exit.id, F::ZERO);
        for lane in (0..8).filter(|&lane| solid.to_array()[lane].to_bits() != 0) {
            seen += 1;
            let (n, p) = (s.outward().lane(lane).as_dvec3(), s.point.lane(lane).as_dvec3());
            let q = p - node.centre.as_dvec3();
            let edge = matches!(node.form, Form::Round(_))
                && (q.y.abs() - 0.6).abs() < 0.03
                && DVec3::new(q.x, 0.0, q.z).length() > 0.37;
            // Where the normal is the mean of two sides', what leaves is over both.
            let sides = [DVec3::Y * q.y.signum(), DVec3::new(q.x, 0.0, q.z).normalize()];
            let leaves = |side: DVec3| side.dot(away.lane(lane).as_dvec3()) > 0.07;
            let mean = edge && sides.iter().all(|side| side.dot(n) < 0.9999);
            let again = again.to_array()[lane].to_bits() != 0 && (!mean || sides.into_iter().all(leaves));
            assert!(!again, "hits itself: {node:?} {:?} {:?} lane {lane}", rays.origin, rays.direction);
            let want = truth(&node, p);
            assert!(edge || n.dot(want) > 1.0 - 1e-4, "{node:?} at {p:?}: {n:?} not {want:?}");
            assert!(edge || at(&scene.fields[0], s.point.lane(lane)).abs() < 1e-5, "{node:?} at {p:?}");
            assert!(edge || exit.id.to_array()[lane] >= 0.0, "finds no way out: {node:?} at {p:?}");
            if !edge {
                inner += usize::from(far.inside.to_array()[lane].to_bits() != 0);
            }
        }
    }
    assert!(seen > 10_000 && inner > seen * 8 / 10, "{seen} {inner}");
}

#[test]
fn occlusion_is_a_share_and_grows_near_a_wall() {
    let field = Field::new(vec![Node::cuboid(Vec3::NEG_Y, Vec3::new(9.0, 1.0, 9.0), 0.0)]);
    let fields = [field];
    let mut last = -1.0;
    for i in 0..20 {
        let p = V3::splat(Vec3::Y * (0.1 * i as f32 + 0.01));
        let down = V3::splat(Vec3::NEG_Y);
        let open = ambient_share(&fields, 1.0, p, down, TRUE, &mut Counters::default()).as_array()[0];
        assert!((0.0..=1.0).contains(&open) && open >= last, "{open} after {last} at {i}");
        last = open;
    }
    assert_eq!(last, 1.0);
    let free =
        ambient_share(&fields, 1.0, V3::splat(Vec3::Y), V3::splat(Vec3::Y), TRUE, &mut Counters::default());
    assert_eq!(free, F::ONE);
}
