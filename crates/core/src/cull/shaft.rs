//! Shaft culling: which shapes may lie between a lamp and a set of points (Haines and Wallace 1991).
//!
//! For each lamp and shape a view from the lamp towards the shape, with the shape's bound in it.
//! A shape whose bound misses the bound of the points can't shadow any of them.

use super::dop::{Dop, View};
use crate::scene::Scene;
use crate::shade::Lamp;
use crate::trace::Shape;
use glam::Vec3;

/// A shape as the lamp sees it.
#[derive(Clone, Copy, Debug)]
pub struct Shaft {
    view: View,
    dop: Dop,
}

/// A point well inside a shape to turn the lamp's view to.
fn middle(shape: Shape) -> Vec3 {
    match shape {
        Shape::Sphere(s) => s.centre,
        Shape::Plane(s) => s.point,
        Shape::Cylinder(s) => s.base + s.axis * if s.length < f32::INFINITY { s.length * 0.5 } else { 0.0 },
        Shape::Cone(s) => {
            let end = if s.range[1] < f32::INFINITY { s.range[1] } else { s.range[0] + 1.0 };
            s.apex + s.axis * (0.5 * (s.range[0] + end))
        }
        Shape::Triangle(s) => (s.corners[0] + s.corners[1] + s.corners[2]) / 3.0,
    }
}

/// The shafts of one lamp to each shape.
pub fn shafts(scene: &Scene, lamp: &Lamp) -> Vec<Shaft> {
    (0..scene.shape_count())
        .map(|i| {
            let shape = scene.shape(i);
            let view = View::towards(lamp.position, middle(shape));
            Shaft { view, dop: Dop::of(&view, shape) }
        })
        .collect()
}

/// Candidate mask of the shapes that may hide some of the points in the ball from a lamp.
///
/// `own` is the shape that all the points lie on, if it is one: a plane, triangle or ball doesn't
/// shadow the side of itself that faces the lamp, and points that face away are not asked about.
pub fn occluders(scene: &Scene, shafts: &[Shaft], own: Option<usize>, centre: Vec3, radius: f32) -> u64 {
    let mut mask = 0;
    for (i, shaft) in shafts.iter().enumerate() {
        let shape = scene.shape(i);
        let convex = matches!(shape, Shape::Sphere(_) | Shape::Plane(_) | Shape::Triangle(_));
        if convex && own == Some(i) {
            continue;
        }
        let may = match shape {
            Shape::Plane(p) => {
                let lamp_side = p.normal.dot(shaft.view.origin - p.point);
                let points_side = p.normal.dot(centre - p.point);
                let slack = radius + 1e-5 * (centre.abs().max_element() + p.point.abs().max_element());
                points_side.abs() <= slack || (lamp_side > 0.0) != (points_side > 0.0)
            }
            _ => shaft.dop.meets_ball(shaft.view.local(centre), radius),
        };
        if may {
            mask |= 1 << (i & 63);
        }
    }
    mask
}
