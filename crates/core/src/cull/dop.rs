//! Bounds of projected shapes: discrete oriented polytopes of eight axes (Klosowski et al. 1998).
//!
//! A shape seen from a point projects to a region of the plane one unit ahead. The region's
//! extents along eight axes, 22.5° apart and turned so that one lies along the shape, bound it
//! tightly even if it is long and thin. Eight axes are eight lanes. The extents of a ball along
//! an axis u come from the two tangents through the eye in the plane (u, z):
//! k = (u z ± r sqrt(u² + z² - r²)) / (z² - r²).

use crate::features;
use crate::math::lanes::{Bound, F, splat};
use crate::math::{Mat3, Vec3, cross};
use crate::scene::{Beam, Scene};
use crate::trace::Shape;
use glam::Vec2;

/// Cosine and sine of k * 22.5°, k = 0..8.
const COS: [f32; 8] =
    [1.0, 0.923_879_5, 0.707_106_77, 0.382_683_43, 0.0, -0.382_683_43, -0.707_106_77, -0.923_879_5];
const SIN: [f32; 8] =
    [0.0, 0.382_683_43, 0.707_106_77, 0.923_879_5, 1.0, 0.923_879_5, 0.707_106_77, 0.382_683_43];

/// Nearest depth at which points are projected, world units.
const NEAR: f32 = 1e-3;

/// Two unit vectors across a third and each other.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
fn across(axis: Vec3) -> (Vec3, Vec3) {
    axis.any_orthonormal_pair()
}

/// A point to look from and the directions right, up and forward.
#[derive(Clone, Copy, Debug, Default)]
pub struct View {
    /// The eye, world.
    pub origin: Vec3,
    /// Columns right, up, forward: unit vectors in the world.
    pub world_from_view: Mat3,
}

impl View {
    /// Coordinates right, up, forward of a world point.
    pub fn local(&self, p: Vec3) -> Vec3 {
        self.world_from_view.transpose() * (p - self.origin)
    }

    /// A view from `origin` towards `target`.
    pub fn towards(origin: Vec3, target: Vec3) -> Self {
        let forward = (target - origin).normalize_or(Vec3::NEG_Y);
        let (right, up) = across(forward);
        Self { origin, world_from_view: Mat3::from_cols(right, up, forward) }
    }
}

/// Extents of a projected shape along eight axes, and the depths it lies between.
#[derive(Clone, Copy, Debug)]
pub struct Dop {
    axis_x: F,
    axis_y: F,
    lo: F,
    hi: F,
    /// Least depth (distance along forward) of the shape, world units.
    pub near: f32,
    /// The shape can't be bounded: it is infinite, or reaches behind the eye.
    pub unbounded: bool,
}

/// A lower bound of the distance at which rays from the eye may meet the ball at `c`, for rays
/// within an angle of sine at most `reach` around the unit direction `e`.
pub fn nearest_in_cone(c: Vec3, radius: f32, e: Vec3, reach: f32) -> f32 {
    let distance = c.length();
    let across = (c - e * c.dot(e)).length();
    let (least, most) = ((across - distance * reach).max(0.0), across + distance * reach);
    let along = (distance * distance - most * most).max(0.0).sqrt();
    along - (radius * radius - least * least).max(0.0).sqrt()
}

/// Extents of the ball at `c` (view coordinates) along axes; `c.z > r`.
fn ball_extents(x: F, y: F, c: Vec3, r: f32) -> (F, F) {
    let r = r + 2e-6 * (r + c.abs().max_element());
    let u = x * splat(c.x) + y * splat(c.y);
    let (z, r2) = (splat(c.z), splat(r * r));
    let root = splat(r) * (u * u + z * z - r2).at_least(F::ZERO).sqrt();
    let scale = F::ONE / (z * z - r2);
    ((u * z - root) * scale, (u * z + root) * scale)
}

impl Dop {
    const EVERYWHERE: Dop = Dop {
        axis_x: F::ZERO,
        axis_y: F::ZERO,
        lo: F::splat(f32::NEG_INFINITY),
        hi: F::splat(f32::INFINITY),
        near: 0.0,
        unbounded: true,
    };
    const NOWHERE: Dop = Dop {
        lo: F::splat(f32::INFINITY),
        hi: F::splat(f32::NEG_INFINITY),
        near: f32::INFINITY,
        unbounded: false,
        ..Dop::EVERYWHERE
    };

    #[cfg_attr(luc_size, optimize(size))]
    fn along(direction: Vec2) -> Dop {
        let u = direction.normalize_or(Vec2::X);
        let (cos, sin) = (F::new(COS), F::new(SIN));
        let (x, y) = (splat(u.x), splat(u.y));
        Dop { axis_x: cos * x - sin * y, axis_y: sin * x + cos * y, ..Dop::NOWHERE }
    }

    /// The same with two axes turned to be normal to these edges.
    #[cfg_attr(luc_size, optimize(size))]
    fn with_edges(direction: Vec2, edges: [Vec2; 2]) -> Dop {
        let mut dop = Dop::along(direction);
        for (lane, edge) in [3, 5].into_iter().zip(edges) {
            let n = edge.perp().normalize_or(Vec2::X);
            dop.axis_x.as_mut_array()[lane] = n.x;
            dop.axis_y.as_mut_array()[lane] = n.y;
        }
        dop
    }

    /// Bound of the ball at `c`, view coordinates.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn ball(c: Vec3, r: f32) -> Dop {
        if c.z + r < 0.0 {
            return Dop::NOWHERE;
        }
        if c.z < r * 1.001 + NEAR {
            return Dop::EVERYWHERE;
        }
        let dop = Dop::along(Vec2::X);
        let (lo, hi) = ball_extents(dop.axis_x, dop.axis_y, c, r);
        Dop { lo, hi, near: c.z - r, unbounded: false, ..dop }
    }

    /// Least and greatest coordinate of a ball's bound, to the right (axis 0) or down (1).
    pub fn extent(&self, axis: usize) -> [f32; 2] {
        let [lo, hi] = [self.lo, self.hi].map(|bound| bound.as_array()[4 * axis]);
        if axis == 0 { [lo, hi] } else { [-hi, -lo] }
    }

    /// Bounds the convex hull of `count` points (view coordinates) along the axes given.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn hull(mut dop: Dop, count: usize, point: &dyn Fn(usize) -> Vec3) -> Dop {
        for p in (0..count).map(point) {
            if p.z < NEAR {
                return Dop::EVERYWHERE;
            }
            dop.add(p);
            dop.near = dop.near.min(p.z);
        }
        dop
    }

    /// Adds the projection of `p`, with room for the rounding of the two products.
    fn add(&mut self, p: Vec3) {
        let inv = splat(1.0 / p.z);
        let (x, y) = (self.axis_x * splat(p.x) * inv, self.axis_y * splat(p.y) * inv);
        let (e, slack) = (x + y, (x.abs() + y.abs()) * splat(1e-6) + splat(1e-6));
        self.lo = self.lo.at_most(e - slack);
        self.hi = self.hi.at_least(e + slack);
    }

    /// Bound of a box with these half sides along `axes` (columns, world).
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn cuboid(view: &View, centre: Vec3, axes: Mat3, half: Vec3) -> Dop {
        let sign = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
        Dop::hull(Dop::along(Vec2::X), 8, &|i| {
            let out = Vec3::new(sign(i, 1), sign(i, 2), sign(i, 4)) * half;
            view.local(centre + axes * out)
        })
    }

    /// Bound of the box between two corners, world.
    pub fn aligned(view: &View, [lo, hi]: [Vec3; 2]) -> Dop {
        Dop::cuboid(view, (lo + hi) * 0.5, Mat3::IDENTITY, (hi - lo) * 0.5)
    }

    /// Bound of the hull of two discs across `axis` (world) of radii `r` around `a` and `b`.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    fn discs(view: &View, axis: Vec3, (a, ra): (Vec3, f32), (b, rb): (Vec3, f32)) -> Dop {
        let (u, v) = across(axis);
        // A regular polygon of sixteen corners around a circle: 1 / cos(pi/16).
        let around = 1.019_591_2;
        let corner = move |k: usize| {
            let (c, s) = (COS[k & 7], SIN[k & 7]);
            (u * c + v * s) * if k < 8 { around } else { -around }
        };
        let flat = |p: Vec3| {
            let p = view.local(p);
            Vec2::new(p.x, p.y) / p.z.max(NEAR)
        };
        let point = |k: usize| {
            let (centre, r) = if k < 16 { (a, ra) } else { (b, rb) };
            view.local(centre + corner(k & 15) * r)
        };
        // The hull's long sides run about from rim to rim, where it is widest across the axis.
        let along = flat(b) - flat(a);
        let side = view.world_from_view * Vec3::from(along.perp().normalize_or(Vec2::X).extend(0.0));
        let edge = |sign: f32| flat(b + side * (rb * sign)) - flat(a + side * (ra * sign));
        Dop::hull(Dop::with_edges(along, [edge(1.0), edge(-1.0)]), 32, &point)
    }

    /// Adds the point infinitely far in direction `v` (view coordinates), if it is not behind.
    fn towards(mut self, v: Vec3) -> Dop {
        if v.z > 1e-3 {
            self.add(v);
        } else if v.z > -1e-3 {
            // Seen from the side: without end along all axes but those across it. Not infinite, so
            // that products with a depth of 0 are numbers.
            let e = self.axis_x * splat(v.x) + self.axis_y * splat(v.y);
            let (far, across) = (splat(1e15), splat(1e-3));
            self.lo = e.simd_lt(-across).select(-far, self.lo);
            self.hi = e.simd_gt(across).select(far, self.hi);
        }
        self
    }

    /// Bound of an infinite bar: its part well in front of the eye, or everything if it passes
    /// close to the eye. It holds in directions up to 55° off forward, and in all if forward is
    /// across the bar.
    fn bar(view: &View, base: Vec3, axis: Vec3, r: f32) -> Dop {
        let from_axis = cross(view.origin - base, axis).length();
        if from_axis < 8.0 * r + 8.0 * NEAR {
            return Dop::EVERYWHERE;
        }
        let middle = base + axis * (view.origin - base).dot(axis);
        let far = 1e3 * from_axis;
        let (a, b) = (view.local(middle - axis * far), view.local(middle + axis * far));
        // Clip the axis where it is 3 r (and a little) before the eye.
        let least = 3.0 * r + from_axis * 0.02;
        let (mut s, mut e) = (0.0_f32, 1.0_f32);
        let dz = b.z - a.z;
        if a.z < least && b.z < least {
            return Dop::NOWHERE;
        }
        if a.z < least {
            s = (least - a.z) / dz;
        }
        if b.z < least {
            e = (least - a.z) / dz;
        }
        let at = |x: f32| middle + axis * (far * (2.0 * x - 1.0));
        let v = view.world_from_view.transpose() * axis;
        Dop::discs(view, axis, (at(s), r), (at(e), r)).towards(v).towards(-v)
    }

    /// Bound of all that a beam lights up, as seen in `view` by rays whose footprints have the
    /// width `pixel` at one unit.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn of_beam(view: &View, beam: &Beam, pixel: f32) -> Dop {
        let far = (beam.from - view.origin).length().max((beam.to - view.origin).length());
        let blur = 0.5 * pixel * far;
        let reach = Beam::END * (beam.width * beam.width + blur * blur).sqrt();
        let (axis, length) = beam.along();
        if length > 0.0 {
            let beyond = axis * reach;
            Dop::discs(view, axis, (beam.from - beyond, reach), (beam.to + beyond, reach))
        } else {
            Dop::ball(view.local(beam.from), reach)
        }
    }

    /// Bound of a shape as seen in `view`.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn of(view: &View, shape: Shape) -> Dop {
        match shape {
            Shape::Sphere(s) => Dop::ball(view.local(s.centre), s.radius),
            Shape::Cylinder(s) if s.length < f32::INFINITY => {
                let end = s.base + s.axis * s.length;
                Dop::discs(view, s.axis, (s.base, s.radius), (end, s.radius))
            }
            Shape::Cylinder(s) if features::ENDLESS => Dop::bar(view, s.base, s.axis, s.radius),
            Shape::Cylinder(_) => Dop::EVERYWHERE,
            Shape::Cone(s) if s.range[1] < f32::INFINITY => {
                let end = |h: f32| (s.apex + s.axis * h, s.slope * h);
                Dop::discs(view, s.axis, end(s.range[0]), end(s.range[1]))
            }
            Shape::Cone(_) => Dop::EVERYWHERE,
            Shape::Triangle(s) if features::TRIANGLES => {
                let corners = s.corners.map(|p| view.local(p));
                let [a, b, c] = corners.map(|p| (p / p.z.max(NEAR)).truncate());
                let edges = [b - a, c - b, a - c];
                let longest = edges
                    .into_iter()
                    .fold(Vec2::ZERO, |m, e| if e.length_squared() > m.length_squared() { e } else { m });
                Dop::hull(Dop::with_edges(longest, [edges[0], edges[1]]), 3, &|i| corners[i])
            }
            Shape::Plane(_) | Shape::Triangle(_) | Shape::Facet(..) => Dop::EVERYWHERE,
            Shape::Voxels(s) => Dop::aligned(view, s.bounds()),
            Shape::Field(s) => Dop::aligned(view, [s.lo, s.hi]),
        }
    }

    /// Whether the shape may appear in the rectangle around `centre` with these half sides, on
    /// the plane one unit ahead.
    pub fn meets_rectangle(&self, centre: Vec2, half: Vec2) -> bool {
        let e = self.axis_x * splat(centre.x) + self.axis_y * splat(centre.y);
        let h = self.axis_x.abs() * splat(half.x) + self.axis_y.abs() * splat(half.y);
        ((e + h).simd_ge(self.lo) & (e - h).simd_le(self.hi)).all()
    }

    /// Whether the pyramid from the eye around the shape comes within `slack` of the hull of
    /// `points` (view coordinates).
    ///
    /// Each axis gives two planes through the eye, a·p = lo z and a·p = hi z. The hull is apart if
    /// all points are farther than `slack` on the outer side of one of them, or behind the eye.
    #[inline(never)]
    pub fn meets_hull(&self, points: &[Vec3], slack: f32) -> bool {
        if self.unbounded || self.near == f32::INFINITY {
            return self.unbounded;
        }
        let slack8 = splat(slack);
        let room = |bound: F| slack8 * (F::ONE + bound * bound).sqrt();
        let (inside_lo, inside_hi) = (self.lo, self.hi);
        let (mut over_lo, mut under_hi, mut ahead) = (F::ZERO, F::ZERO, false);
        for p in points {
            let (e, z) = (self.axis_x * splat(p.x) + self.axis_y * splat(p.y), splat(p.z));
            over_lo |= (e - inside_lo * z).simd_ge(-room(inside_lo));
            under_hi |= (e - inside_hi * z).simd_le(room(inside_hi));
            ahead |= p.z > -slack;
        }
        ahead && (over_lo & under_hi).all()
    }
}

/// Bounds of all shapes of a scene in a view, in place of what `out` held.
#[cfg_attr(luc_size, optimize(size))]
pub fn dops(scene: &Scene, view: &View, out: &mut Vec<Dop>) {
    out.clear();
    out.extend((0..scene.shape_count()).map(|i| Dop::of(view, scene.shape(i))));
}
