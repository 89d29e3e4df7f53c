//! Bodies as signed distance fields: a flat list of forms, joined one after another.
//!
//! The distance starts at infinity and each node joins its own to it. A smooth join of radius k is
//! the quadratic one, `min - h² k / 4` with `h = max(k - |a - b|, 0) / k`: both gradients enter
//! with weights that sum to 1, so the result changes no faster than its parts, and the body grows
//! by at most k where several meet. Operands are joined in list order, as smooth joins are not
//! associative.

use crate::math::{Mat3, Vec3};

/// What a node adds. Sizes are in world units, before [`Node::rounding`] grows them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// The half space on the inner side of a plane with this unit normal.
    Plane(Vec3),
    /// Three endless bars along the axes, square with this half side; round ones for 0.
    Cross(f32),
    /// A box with these half sides; a point or line for spheres and capsules.
    Box(Vec3),
    /// A rectangle, turned about the y axis at a distance: half width, half height, distance.
    Round([f32; 3]),
    /// Not a body but a swell to be added: `amplitude` times a wave of `frequency` (radians per
    /// unit) along each axis, multiplied.
    Swell {
        /// Greatest value, world units.
        amplitude: f32,
        /// Radians per world unit.
        frequency: f32,
    },
}

/// How a node's distance is joined to that of the nodes before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// The body is added.
    Union,
    /// Only what lies in both stays.
    Intersection,
    /// The body is cut away.
    Subtraction,
    /// The distances are added: for swells.
    Sum,
}

/// A form at a place, and how it joins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// What.
    pub form: Form,
    /// How far it is grown, world units.
    pub rounding: f32,
    /// Where its middle is, in the world or, if `repeats`, in the cell.
    pub centre: Vec3,
    /// Its axes as columns, orthonormal; `None` for those of the world.
    pub axes: Option<Mat3>,
    /// How it joins.
    pub join: Join,
    /// Radius k of a smooth join, world units; 0 for a sharp one.
    pub blend: f32,
    /// Whether the materials too flow into each other where a join is smooth.
    pub mix: bool,
    /// Whether it takes part in the field's repetition.
    pub repeats: bool,
    /// Index into the scene's materials.
    pub material: usize,
}

/// A body that is found by marching along rays.
///
/// Repetition mirrors every other cell. Folding space so moves no two points apart, so distances
/// stay true bounds across the cells' borders whatever the cell holds, and for symmetric contents
/// it is plain repetition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// The list; at most [`Field::MOST`] nodes count.
    pub nodes: Vec<Node>,
    /// Sides of the cell that repeats about the origin, world units; 0 for none along an axis.
    pub cell: Vec3,
    /// How many cells there are to either side of the middle one; may be infinite.
    pub copies: Vec3,
    /// Least corner of a box around the whole body. What sticks out of it may be missing.
    pub lo: Vec3,
    /// Greatest corner.
    pub hi: Vec3,
    /// It casts no shadow, for bodies so wide that marching to each lamp is not worth it.
    pub shadowless: bool,
}

/// Room in a field's box beyond its bodies, world units: more than the distance at which a ray has
/// arrived, so that one which leaves a body does so within the box.
const ROOM: f32 = 0.01;

impl Node {
    const fn new(form: Form, rounding: f32, centre: Vec3) -> Self {
        Self {
            form,
            rounding,
            centre,
            axes: None,
            join: Join::Union,
            blend: 0.0,
            mix: true,
            repeats: false,
            material: 0,
        }
    }

    /// A ball.
    pub const fn sphere(centre: Vec3, radius: f32) -> Self {
        Self::new(Form::Box(Vec3::ZERO), radius, centre)
    }

    /// A box with half sides `half`, its edges rounded with a radius.
    pub const fn cuboid(centre: Vec3, half: Vec3, rounding: f32) -> Self {
        let [x, y, z] = half.to_array();
        Self::new(Form::Box(Vec3::new(x - rounding, y - rounding, z - rounding)), rounding, centre)
    }

    /// A ball drawn out to both sides along y.
    pub const fn capsule(centre: Vec3, half_length: f32, radius: f32) -> Self {
        Self::new(Form::Box(Vec3::new(0.0, half_length, 0.0)), radius, centre)
    }

    /// A cylinder about y with flat ends.
    pub const fn cylinder(centre: Vec3, half_length: f32, radius: f32) -> Self {
        Self::new(Form::Round([radius, half_length, 0.0]), 0.0, centre)
    }

    /// A ring about y.
    pub const fn torus(centre: Vec3, radius: f32, thickness: f32) -> Self {
        Self::new(Form::Round([0.0, 0.0, radius]), thickness, centre)
    }

    /// All on the inner side of the plane through `point` with this unit normal.
    pub const fn plane(point: Vec3, normal: Vec3) -> Self {
        Self::new(Form::Plane(normal), 0.0, point)
    }

    /// Three endless bars along the axes, their edges rounded.
    pub const fn cross(half: f32, rounding: f32) -> Self {
        Self::new(Form::Cross(half - rounding), rounding, Vec3::ZERO)
    }

    /// Waves on what was joined so far.
    pub const fn swell(amplitude: f32, frequency: f32) -> Self {
        let form = Form::Swell { amplitude, frequency };
        Self { join: Join::Sum, ..Self::new(form, 0.0, Vec3::ZERO) }
    }

    /// The same, joined so.
    pub const fn joined(self, join: Join, blend: f32) -> Self {
        Self { join, blend, ..self }
    }

    /// The same in a space that is scaled evenly, turned and moved: where `p` was, `turn * p * scale + offset`
    /// is. Repeated space stays where it is, so this is for nodes that don't repeat. `turn` is orthonormal,
    /// `scale` over 0.
    pub fn placed(self, scale: f32, turn: Mat3, offset: Vec3) -> Self {
        let form = match self.form {
            Form::Plane(normal) => Form::Plane(turn * self.axes.map_or(normal, |axes| axes * normal)),
            Form::Cross(half) => Form::Cross(half * scale),
            Form::Box(half) => Form::Box(half * scale),
            Form::Round(sizes) => Form::Round(sizes.map(|size| size * scale)),
            Form::Swell { amplitude, frequency } => {
                Form::Swell { amplitude: amplitude * scale, frequency: frequency / scale }
            }
        };
        let is_plane = matches!(form, Form::Plane(_));
        Self {
            form,
            rounding: self.rounding * scale,
            centre: turn * self.centre * scale + offset,
            axes: (!is_plane).then(|| turn * self.axes.unwrap_or(Mat3::IDENTITY)),
            blend: self.blend * scale,
            ..self
        }
    }

    /// Greatest slope of the form's own distance.
    fn slope(&self) -> f32 {
        match self.form {
            // The wave 4 x (1 - |x|) is steepest where it crosses 0: 4 / pi per radian.
            Form::Swell { amplitude, frequency } => amplitude * frequency * std::f32::consts::FRAC_2_PI * 2.0,
            _ => 1.0,
        }
    }

    /// Half sides of a box around the form along its own axes, before rounding, if it is a finite
    /// body that adds to the field once.
    pub fn core(&self) -> Option<Vec3> {
        let half = match self.form {
            Form::Box(half) => half,
            Form::Round([half, height, distance]) => Vec3::new(half + distance, height, half + distance),
            _ => return None,
        };
        (self.join == Join::Union && !self.repeats).then_some(half)
    }
}

impl Field {
    /// Nodes that a field can have.
    pub const MOST: usize = 32;

    /// A field of finite bodies, with the box around it.
    pub fn new(nodes: Vec<Node>) -> Self {
        let (mut lo, mut hi) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let field = Self { nodes, ..Self::default() };
        let growth = field.growth();
        for node in &field.nodes {
            let Some(half) = node.core() else { continue };
            let [x, y, z] = node.axes.unwrap_or_default().to_cols_array_2d().map(|c| Vec3::from(c).abs());
            let half = x * half.x + y * half.y + z * half.z + node.rounding + growth + ROOM;
            lo = lo.min(node.centre - half);
            hi = hi.max(node.centre + half);
        }
        Self { lo, hi, ..field }
    }

    /// How far at most it reaches beyond its bodies, world units: the radius of the widest smooth join, and what
    /// swells add.
    pub fn growth(&self) -> f32 {
        let (mut widest, mut swells) = (0.0_f32, 0.0);
        for node in &self.nodes {
            widest = widest.max(node.blend);
            if let Form::Swell { amplitude, .. } = node.form {
                swells += amplitude;
            }
        }
        widest + swells
    }

    /// How much the field's value may change per unit of distance, at most.
    pub fn lipschitz(&self) -> f32 {
        self.nodes.iter().fold(0.0, |slope: f32, node| match node.join {
            Join::Sum => slope + node.slope(),
            _ => slope.max(node.slope()),
        })
    }
}
