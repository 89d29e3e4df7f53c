//! Forms of fields, bases and elementary functions.

use super::*;

pub const KERNELS: &[Kernel] = &[
    kernel!(
        "smooth minimum",
        smooth_min,
        Measure::Unit(|x, _| f64::from(x[0].abs().max(x[1].abs()).max(x[2]))),
        |random| {
            let (a, k) = (random.signed(-10, 10), random.size(-10, 4));
            let b = if random.one_in(2) { a + k * random.range(-1.5, 1.5) } else { random.signed(-10, 10) };
            list([&[a, b, if random.one_in(16) { 0.0 } else { k }]])
        },
        |x, _| {
            let [a, b, k] = vector(x, 0).map(f64::from);
            let h = (k - (a - b).abs()).max(0.0);
            a.min(b) - if h > 0.0 { h * h / (4.0 * k) } else { 0.0 }
        },
        |x| kernels::smooth_union(x[0], x[1], x[2]),
        |x| trace::smooth_min(x[0], x[1], scalar(x[2])).0
    ),
    kernel!(
        "repetition",
        repeat,
        Measure::Unit(|x, _| f64::from(x[0].abs() + x[1])),
        |random| loop {
            let (x, side) = (random.signed(-4, 17), random.size(-4, 4));
            let cell = f64::from(x) / f64::from(side) + 0.5;
            // Next to a border either cell is right.
            if (cell - cell.round()).abs() > 4.0 * U * cell.abs() {
                return list([&[x, side]]);
            }
        },
        |x, _| {
            let (x, side) = (f64::from(x[0]), f64::from(x[1]));
            x - side * (x / side + 0.5).floor()
        },
        |x| kernels::repeat(x[0], x[1], f32::INFINITY),
        |x| trace::repeated(x[0], scalar(x[1]), f32::INFINITY).1
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
        |x| kernels::sdf(&Node::cuboid(Vec3::ZERO, v3(x, 3), 0.0), v3(x, 0).into()),
        |x| trace::form(&Node::cuboid(Vec3::ZERO, v3(&shape(x), 3), 0.0), packet(x, 0))
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
        |x| kernels::sdf(&Node::torus(Vec3::ZERO, x[3], x[4]), v3(x, 0).into()),
        |x| {
            let s = shape(x);
            trace::form(&Node::torus(Vec3::ZERO, s[3], s[4]), packet(x, 0))
        }
    ),
    kernel!(
        "basis of a normal",
        basis,
        // Three products, each of two rounded numbers.
        Measure::Unit(|_, _| 3.0),
        |random| {
            let tilt = Vec3::new(random.signed(-40, 0), random.signed(-40, 0), -1.0);
            let n = if random.one_in(2) { random.direction() } else { tilt.normalize() };
            list([&n.to_array()])
        },
        |_, _| 0.0,
        |x| {
            let (u, v) = kernels::basis(v3(x, 0).into());
            let wide = |v: Vec3| v.as_dvec3().to_array();
            naive::unlike(wide(u.into()), wide(v.into()), wide(v3(x, 0))) as f32
        },
        |x| {
            let (u, v) = sampling::basis(packet(x, 0));
            u.x + v.x
        }
    ),
    kernel!(
        "exp",
        exp,
        Measure::Ulp,
        |random| list([&[
            random.range(-87.0, 88.0) * if random.one_in(2) { 1.0 } else { random.size(-20, 0) }
        ]]),
        |x, _| exact_exp(x[0].into()),
        |x| kernels::scalar::exp(x[0]),
        |x| lanes_fn::exp(x[0])
    ),
];
