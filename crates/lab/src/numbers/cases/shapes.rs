//! Shapes, slabs and the quadratic under them.

use super::*;

pub const KERNELS: &[Kernel] = &[
    kernel!(
        "sphere",
        sphere,
        Measure::Score(|x| distance(x, 0, 6) + f64::from(x[9])),
        |random| {
            let radius = random.size(-13, 10);
            let centre = random.vector(-6, 10);
            let normal = random.direction();
            let (o, d) = random.ray(centre + normal * radius, normal, normal, radius);
            list([&o.to_array(), &d.to_array(), &centre.to_array(), &[radius]])
        },
        truth::sphere,
        |x| some(kernels::sphere(&ray(x), v3(x, 6).into(), x[9]).map(|c| c.first())),
        |x| {
            let s = shape(x);
            let ball = Sphere { centre: v3(&s, 6), radius: s[9], material: 0, blend: 0.0 };
            trace::sphere(&rays(x), &ball).first().0
        }
    ),
    kernel!(
        "plane",
        plane,
        Measure::Score(|x| distance(x, 0, 6)),
        |random| {
            let (point, normal) = (random.vector(-6, 20), random.direction());
            let across = normal.any_orthonormal_vector();
            let target = point + across * random.size(-8, 8);
            let size = random.size(-8, 8);
            let (o, d) = random.ray(target, normal, across, size);
            list([&o.to_array(), &d.to_array(), &point.to_array(), &normal.to_array()])
        },
        truth::plane,
        |x| some(kernels::plane(&ray(x), v3(x, 6).into(), v3(x, 9).into())),
        |x| {
            let s = shape(x);
            let plane = Plane { point: v3(&s, 6), normal: v3(&s, 9), reach: f32::INFINITY, material: 0 };
            trace::plane(&rays(x), &plane).first().0
        }
    ),
    kernel!(
        "cylinder",
        cylinder,
        Measure::Score(|x| 2.0 * distance(x, 0, 6) + f64::from(x[12])),
        |random| {
            let height = random.signed(-4, 6);
            let (r, place, axis, (o, d)) = about_axis(random, 1.0, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[r]])
        },
        truth::cylinder,
        |x| some(kernels::cylinder(&ray(x), v3(x, 6).into(), v3(x, 9).into(), x[12]).map(|c| c.first())),
        |x| trace::cylinder(&rays(x), &bar(&shape(x), f32::INFINITY)).first().0
    ),
    kernel!(
        "capped cylinder",
        capped_cylinder,
        Measure::Score(|x| 2.0 * distance(x, 0, 6) + f64::from(x[12] + x[13])),
        |random| {
            let (across, height) = if random.one_in(2) {
                (1.0, random.range(0.0, 2.0))
            } else {
                (random.range(0.0, 1.0), if random.one_in(2) { 0.0 } else { 2.0 })
            };
            let (r, place, axis, (o, d)) = about_axis(random, across, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[r, 2.0 * r]])
        },
        truth::capped_cylinder,
        |x| some(
            kernels::capped_cylinder(&ray(x), v3(x, 6).into(), v3(x, 9).into(), x[12], x[13])
                .map(|c| c.first())
        ),
        |x| {
            let s = shape(x);
            trace::cylinder(&rays(x), &bar(&s, s[13])).first().0
        }
    ),
    kernel!(
        "cone",
        cone,
        Measure::Score(|x| 2.0 * distance(x, 0, 6)),
        |random| {
            let (slope, height) = (random.size(-7, 3), random.size(-6, 6));
            let (_, place, axis, (o, d)) = about_axis(random, slope * height, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[slope]])
        },
        truth::cone,
        |x| some(kernels::cone(&ray(x), v3(x, 6).into(), v3(x, 9).into(), x[12]).map(|c| c.first())),
        |x| {
            let s = shape(x);
            let (apex, axis, range) = (v3(&s, 6), v3(&s, 9), [0.0, f32::INFINITY]);
            let cone = Cone { apex, axis, slope: s[12], range, caps: [false; 2], material: 0 };
            trace::cone(&rays(x), &cone).first().0
        }
    ),
    kernel!(
        "capped cone",
        capped_cone,
        Measure::Score(|x| 2.0 * distance(x, 0, 6) + f64::from(x[14])),
        |random| {
            let (slope, height) = (random.size(-7, 3), random.range(0.9, 2.1));
            let across = slope * height * if random.one_in(2) { 1.0 } else { random.range(0.0, 1.0) };
            let (h, place, axis, (o, d)) = about_axis(random, across, height);
            list([&o.to_array(), &d.to_array(), &place.to_array(), &axis.to_array(), &[slope, h, 2.0 * h]])
        },
        truth::capped_cone,
        |x| {
            let (apex, axis) = (v3(x, 6).into(), v3(x, 9).into());
            some(kernels::capped_cone(&ray(x), apex, axis, x[12], [x[13], x[14]]).map(|c| c.first()))
        },
        |x| {
            let s = shape(x);
            let (apex, axis, range) = (v3(&s, 6), v3(&s, 9), [s[13], s[14]]);
            let cone = Cone { apex, axis, slope: s[12], range, caps: [true; 2], material: 0 };
            trace::cone(&rays(x), &cone).first().0
        }
    ),
    kernel!(
        "triangle",
        triangle,
        Measure::Score(|x| distance(x, 0, 6).max(distance(x, 0, 9)).max(distance(x, 0, 12))),
        |random| {
            let size = random.size(-12, 12);
            let at = random.vector(-6, 8) * size;
            let e = [random.direction() * size, random.direction() * (size * random.size(-8, 1))];
            let n = e[0].cross(e[1]).normalize_or(Vec3::Y);
            let (mut a, mut b) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
            match random.bits() % 4 {
                0 => a = random.signed(-20, 0),
                1 => b = 1.0 - a + random.signed(-20, 0),
                _ => {}
            }
            let (o, d) = random.ray(at + e[0] * a + e[1] * b, n, e[0].normalize_or(n), size);
            let corners = [at, at + e[0], at + e[1]].map(|p| p.to_array());
            list([&o.to_array(), &d.to_array(), &corners[0], &corners[1], &corners[2]])
        },
        truth::triangle,
        |x| some(
            kernels::triangle(&ray(x), [v3(x, 6).into(), v3(x, 9).into(), v3(x, 12).into()]).map(|h| h.t)
        ),
        |x| {
            let s = shape(x);
            let triangle = Triangle { corners: [v3(&s, 6), v3(&s, 9), v3(&s, 12)], material: 0 };
            trace::triangle(&rays(x), &triangle).first().0
        }
    ),
    kernel!(
        "box slab",
        slab,
        Measure::Score(|x| distance(x, 0, 6).max(distance(x, 0, 9))),
        |random| {
            let size = random.size(-8, 8);
            let lo = random.vector(-6, 8) * size;
            let mut side = Vec3::from_array([0; 3].map(|_| size * random.range(0.1, 1.0)));
            if random.one_in(8) {
                side[random.bits() as usize % 3] = 0.0;
            }
            let hi = lo + side;
            // At a face, an edge or a corner, or along one.
            let mut target = lo + side * Vec3::from_array([0; 3].map(|_| random.range(0.0, 1.0)));
            for axis in 0..3 {
                match random.bits() % 4 {
                    0 => target[axis] = lo[axis],
                    1 => target[axis] = hi[axis],
                    _ => {}
                }
            }
            let axis = Vec3::AXES[random.bits() as usize % 3];
            let normal = Vec3::AXES[random.bits() as usize % 3];
            let (o, d) = random.ray(target, normal, axis, size);
            list([&o.to_array(), &d.to_array(), &lo.to_array(), &hi.to_array()])
        },
        truth::slab,
        |x| some(kernels::slab(&ray(x), v3(x, 6).into(), v3(x, 9).into()).map(|t| t[0])),
        |x| {
            let s = shape(x);
            rays(x).in_box(v3(&s, 6), v3(&s, 9), lanes::INFINITY).0
        }
    ),
    kernel!(
        "quadratic",
        quadratic,
        Measure::Ulp,
        |random| {
            let (a, b, c) = (random.signed(-20, 20), random.signed(-20, 20), random.signed(-20, 20));
            // Nearly double roots too.
            let c = if random.one_in(3) && a != 0.0 { b * b / (4.0 * a) } else { c };
            list([&[a, b, c]])
        },
        |x, _| {
            let [a, b, c] = vector(x, 0).map(f64::from);
            let square = b * b - 4.0 * a * c;
            if a == 0.0 {
                return if b == 0.0 { f64::NAN } else { -c / b };
            }
            let q = -0.5 * (b + square.sqrt().copysign(b));
            if square < 0.0 {
                f64::NAN
            } else if q == 0.0 {
                0.0
            } else {
                (q / a).max(c / q)
            }
        },
        |x| some(kernels::quadratic(x[0], x[1], x[2]).map(|r| r[1])),
        |x| {
            let [a, b, c] = [x[0], x[1], x[2]].map(|x| x.to_array());
            F::new(std::array::from_fn(|i| some(kernels::quadratic(a[i], b[i], c[i]).map(|r| r[1]))))
        }
    ),
    kernel!(
        "ab - cd",
        products,
        Measure::Ulp,
        |random| {
            let [a, b, c] =
                [0; 3].map(|_| random.range(1e4, 5e4) * if random.one_in(2) { 1.0 } else { -1.0 });
            let d = a * b / c * (1.0 + random.signed(-23, -4));
            list([&[a, b, c, d]])
        },
        |x, _| {
            let [a, b, c, d] = [x[0], x[1], x[2], x[3]].map(f64::from);
            a * b - c * d
        },
        |x| kernels::difference_of_products(x[0], x[1], x[2], x[3]),
        |x| lanes::difference_of_products(x[0], x[1], x[2], x[3])
    ),
];
