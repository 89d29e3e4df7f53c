//! Shaft culling: which shapes may lie between a lamp and a set of points (Haines and Wallace 1991).
//!
//! For each lamp and shape a view from the lamp towards the shape, with the shape's bound in it.
//! A shape whose bound misses the bound of the points can't shadow any of them.

use super::dop::{Dop, View, nearest_in_cone};
use crate::features;
use crate::math::{Vec3, cross};
use crate::scene::{Field, Scene};
use crate::shade::Lamp;
use crate::trace::Shape;

/// A shape as the lamp sees it.
#[derive(Clone, Copy, Debug)]
pub struct Shaft {
    view: View,
    dop: Dop,
}

/// A point well inside a shape to turn the lamp's view to; of an infinite bar the nearest, so that
/// its bound holds all around.
#[cfg_attr(luc_size, optimize(size))]
fn middle(shape: Shape, lamp: Vec3) -> Vec3 {
    match shape {
        Shape::Sphere(s) => s.centre,
        Shape::Plane(s) => s.point,
        Shape::Cylinder(s) if s.length < f32::INFINITY => s.base + s.axis * (s.length * 0.5),
        Shape::Cylinder(s) => s.base + s.axis * s.axis.dot(lamp - s.base),
        Shape::Cone(s) => {
            let end = if s.range[1] < f32::INFINITY { s.range[1] } else { s.range[0] + 1.0 };
            s.apex + s.axis * (0.5 * (s.range[0] + end))
        }
        Shape::Triangle(s) if features::TRIANGLES => (s.corners[0] + s.corners[1] + s.corners[2]) / 3.0,
        Shape::Triangle(_) | Shape::Facet(..) => Vec3::ZERO,
        Shape::Voxels(s) => (s.bounds()[0] + s.bounds()[1]) * 0.5,
        Shape::Field(s) => (s.lo + s.hi) * 0.5,
    }
}

/// The shafts of each lamp to each shape, lamp after lamp, in place of what `out` held.
#[cfg_attr(luc_size, optimize(size))]
pub fn shafts(scene: &Scene, lamps: &[Lamp], out: &mut Vec<Shaft>) {
    let count = scene.shape_count();
    out.clear();
    out.extend((0..lamps.len() * count).map(|i| {
        let (origin, shape) = (lamps[i / count].position, scene.shape(i % count));
        let view = View::towards(origin, middle(shape, origin));
        Shaft { view, dop: Dop::of(&view, shape) }
    }));
}

/// Where points lie that may be in shadow: within a distance of the hull of some corners.
pub struct Region {
    corners: [Vec3; 8],
    count: usize,
    slack: f32,
    /// A ball around all of it.
    centre: Vec3,
    radius: f32,
}

impl Region {
    fn new(corners: &[Vec3], slack: f32) -> Self {
        let centre = corners.iter().sum::<Vec3>() / corners.len() as f32;
        let r2 = corners.iter().fold(0.0_f32, |m, p| m.max((p - centre).length_squared()));
        let mut own = [centre; 8];
        own[..corners.len()].copy_from_slice(corners);
        Self { corners: own, count: corners.len(), slack, centre, radius: r2.sqrt() + slack }
    }

    /// A ball, world.
    pub fn ball(centre: Vec3, radius: f32) -> Self {
        Self::new(&[centre], radius)
    }

    /// Within `slack` of the hull of four points, world.
    pub fn patch(corners: &[Vec3; 4], slack: f32) -> Self {
        Self::new(corners, slack)
    }

    /// Within `slack` of a box, world.
    pub fn cuboid(lo: Vec3, hi: Vec3, slack: f32) -> Self {
        let corner = |i: usize| {
            let pick = |bit: usize, lo: f32, hi: f32| if i & bit == 0 { lo } else { hi };
            Vec3::new(pick(1, lo.x, hi.x), pick(2, lo.y, hi.y), pick(4, lo.z, hi.z))
        };
        Self::new(&std::array::from_fn::<_, 8, _>(corner), slack)
    }
}

impl Shaft {
    /// Whether the shape may lie between the lamp and some point of the region.
    fn may_hide(&self, shape: Shape, region: &Region) -> bool {
        let Region { centre, radius, .. } = *region;
        let plane = match shape {
            Shape::Plane(p) => Some((p.point, p.normal)),
            Shape::Triangle(t) if features::TRIANGLES => {
                let [a, b, c] = t.corners;
                Some((a, cross(b - a, c - a).normalize_or_zero()))
            }
            _ => None,
        };
        if let Some((point, normal)) = plane {
            let lamp = normal.dot(self.view.origin - point);
            let points = normal.dot(centre - point);
            let slack = radius + 1e-5 * (centre.abs().max_element() + point.abs().max_element());
            if points.abs() > slack && (lamp > 0.0) == (points > 0.0) {
                return false;
            }
        }
        let c = self.view.local(centre);
        let farthest = c.length() + radius;
        if self.dop.unbounded {
            return true;
        }
        if farthest < self.dop.near {
            return false;
        }
        let mut corners = region.corners;
        let corners = &mut corners[..region.count];
        for p in corners.iter_mut() {
            *p = self.view.local(*p);
        }
        let meets = self.dop.meets_hull(corners, region.slack);
        if let (true, Shape::Sphere(s)) = (meets, shape) {
            let distance = c.length();
            let reach = radius / (distance - radius).max(1e-6);
            let middle = self.view.local(s.centre);
            return nearest_in_cone(middle, s.radius, c / distance, reach) <= farthest * 1.000_01;
        }
        meets
    }
}

/// Candidate mask of the shapes that may hide some of the region's points from a lamp, out of the
/// shapes in the mask `among`.
///
/// `own` is the shape that all the points lie on, if it is one: a plane, triangle or ball doesn't
/// shadow the side of itself that faces the lamp, and points that face away are not asked about.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn occluders(scene: &Scene, shafts: &[Shaft], among: u64, own: Option<usize>, region: &Region) -> u64 {
    let mut mask = 0;
    for (i, shaft) in shafts.iter().enumerate() {
        if among >> (i & 63) & 1 == 0 {
            continue;
        }
        let shape = scene.shape(i);
        if matches!(shape, Shape::Field(Field { shadowless: true, .. })) {
            continue;
        }
        let convex = matches!(shape, Shape::Sphere(_) | Shape::Plane(_) | Shape::Triangle(_));
        if !(convex && own == Some(i)) && shaft.may_hide(shape, region) {
            mask |= 1 << (i & 63);
        }
    }
    mask
}
