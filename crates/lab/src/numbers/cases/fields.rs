//! Distances from the bodies that fields are made of.

use super::*;

pub const KERNELS: &[Kernel] = &[
    kernel!(
        "distance from a ball",
        sdf_sphere,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + x[3])),
        |random| {
            let r = random.range(0.01, 2.0);
            let p = if random.one_in(2) { random.vector(-6, 10) } else { random.direction() * r };
            list([&p.to_array(), &[r]])
        },
        |x, _| v3(x, 0).as_dvec3().length() - f64::from(x[3]),
        |x| of_one(ball, x),
        |x| of_eight(ball, x)
    ),
    kernel!(
        "distance from a box",
        sdf_box,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + v3(x, 3).length())),
        |random| {
            let half = Vec3::from_array([0; 3].map(|_| random.range(0.1, 1.0)));
            let p = random.vector(-6, 10);
            list([&p.to_array(), &half.to_array()])
        },
        |x, _| {
            let q = v3(x, 0).as_dvec3().abs() - v3(x, 3).as_dvec3();
            q.max(glam::DVec3::ZERO).length() + q.max_element().min(0.0)
        },
        |x| of_one(cuboid, x),
        |x| of_eight(cuboid, x)
    ),
    kernel!(
        "distance from a ring",
        sdf_torus,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + x[3] + x[4])),
        |random| {
            let (radius, thick) = (random.range(0.5, 2.0), random.range(0.01, 0.5));
            let p = if random.one_in(2) { random.vector(-6, 10) } else { random.direction() * radius };
            list([&p.to_array(), &[radius, thick]])
        },
        |x, _| {
            let p = v3(x, 0).as_dvec3();
            let out = (p.x * p.x + p.z * p.z).sqrt() - f64::from(x[3]);
            (out * out + p.y * p.y).sqrt() - f64::from(x[4])
        },
        |x| of_one(ring, x),
        |x| of_eight(ring, x)
    ),
    kernel!(
        "distance from a round box",
        sdf_round_box,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + v3(x, 3).length())),
        |random| {
            let half = [0; 3].map(|_| random.range(0.1, 1.0));
            list([&random.vector(-6, 10).to_array(), &half, &[random.range(0.0, 0.1)]])
        },
        |x, _| {
            // The engine's box knows its core, rounded once.
            let q = v3(x, 0).as_dvec3().abs() - (v3(x, 3).as_dvec3() - f64::from(x[6]));
            q.max(glam::DVec3::ZERO).length() + q.max_element().min(0.0) - f64::from(x[6])
        },
        |x| of_one(round_box, x),
        |x| of_eight(round_box, x)
    ),
    kernel!(
        "distance from a capsule",
        sdf_capsule,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + x[3] + x[4])),
        |random| list([
            &random.vector(-6, 10).to_array(),
            &[random.range(0.0, 2.0), random.range(0.01, 1.0)]
        ]),
        |x, _| {
            let (p, half) = (v3(x, 0).as_dvec3(), f64::from(x[3]));
            (p - glam::DVec3::Y * p.y.clamp(-half, half)).length() - f64::from(x[4])
        },
        |x| of_one(capsule, x),
        |x| of_eight(capsule, x)
    ),
    kernel!(
        "distance from a cylinder",
        sdf_cylinder,
        Measure::Unit(|x, _| f64::from(v3(x, 0).length() + x[3] + x[4])),
        |random| list([
            &random.vector(-6, 10).to_array(),
            &[random.range(0.1, 2.0), random.range(0.01, 1.0)]
        ]),
        |x, _| {
            let p = v3(x, 0).as_dvec3();
            let (out, up) = ((p.x * p.x + p.z * p.z).sqrt() - f64::from(x[4]), p.y.abs() - f64::from(x[3]));
            glam::DVec2::new(out.max(0.0), up.max(0.0)).length() + out.max(up).min(0.0)
        },
        |x| of_one(cylinder, x),
        |x| of_eight(cylinder, x)
    ),
    kernel!(
        "distance from a plane",
        sdf_plane,
        Measure::Unit(|x, _| distance(x, 0, 3)),
        |random| {
            let (p, n) = (random.vector(-6, 10), random.direction());
            let q = p + n.any_orthonormal_vector() * random.size(-6, 10) + n * random.signed(-20, 2);
            list([&q.to_array(), &p.to_array(), &n.to_array()])
        },
        |x, _| (v3(x, 0).as_dvec3() - v3(x, 3).as_dvec3()).dot(v3(x, 6).as_dvec3()),
        |x| of_one(plane, x),
        |x| of_eight(plane, x)
    ),
];

/// Distance from the form that a list of arguments makes, of the point that it begins with.
fn of_one(form: fn(&Arguments<f32>) -> Node, x: &Arguments<f32>) -> f32 {
    kernels::sdf(&form(x), v3(x, 0).into())
}

fn of_eight(form: fn(&Arguments<f32>) -> Node, x: &Arguments<F>) -> F {
    trace::form(&form(&shape(x)), packet(x, 0))
}

fn ball(x: &Arguments<f32>) -> Node {
    Node::sphere(Vec3::ZERO, x[3])
}

fn cuboid(x: &Arguments<f32>) -> Node {
    Node::cuboid(Vec3::ZERO, v3(x, 3), 0.0)
}

fn ring(x: &Arguments<f32>) -> Node {
    Node::torus(Vec3::ZERO, x[3], x[4])
}

fn round_box(x: &Arguments<f32>) -> Node {
    Node::cuboid(Vec3::ZERO, v3(x, 3), x[6])
}

fn capsule(x: &Arguments<f32>) -> Node {
    Node::capsule(Vec3::ZERO, x[3], x[4])
}

fn cylinder(x: &Arguments<f32>) -> Node {
    Node::cylinder(Vec3::ZERO, x[3], x[4])
}

fn plane(x: &Arguments<f32>) -> Node {
    Node::plane(v3(x, 3), v3(x, 6))
}
