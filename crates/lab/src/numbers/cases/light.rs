//! Light: microfacets, reflectance, refraction, scattering and extinction.

use super::*;

pub const KERNELS: &[Kernel] = &[
    kernel!(
        "GGX D of n·h",
        ggx,
        Measure::Ulp,
        |random| {
            let alpha = random.size(-13, 0);
            list([&[random.cosine(), alpha]])
        },
        |x, _| ggx_truth((1.0 - f64::from(x[0])) * (1.0 + f64::from(x[0])), x[0].into(), x[1].into()),
        |x| kernels::ggx_of_cosine(x[0], x[1]),
        |x| {
            let sine2 = (F::ONE - x[0]) * (F::ONE + x[0]);
            shade::distribution(sine2, x[0], x[1]) * splat(std::f32::consts::FRAC_1_PI)
        }
    ),
    kernel!(
        "GGX D of n and h",
        ggx_vectors,
        // Of the rounding of the vectors themselves.
        Measure::Unit(|x, d| d * 4.0 / f64::from(x[6])),
        |random| {
            let alpha = random.size(-10, 0);
            let n = random.direction();
            let h = (n + random.direction() * (alpha * random.size(-6, 3))).normalize();
            list([&n.to_array(), &h.to_array(), &[alpha]])
        },
        |x, _| {
            let (n, h) = (v3(x, 0).as_dvec3(), v3(x, 3).as_dvec3());
            ggx_truth(n.cross(h).length_squared(), n.dot(h), x[6].into())
        },
        |x| scalar(ggx_packet(&x.map(splat))),
        ggx_packet
    ),
    kernel!(
        "Smith G1",
        smith_g1,
        Measure::Ulp,
        |random| {
            let cos = random.cosine();
            list([&[cos, random.size(-13, 0)]])
        },
        |x, _| {
            let (c, a) = (f64::from(x[0]), f64::from(x[1]));
            2.0 * c / (c + (a * a * (1.0 - c) * (1.0 + c) + c * c).sqrt())
        },
        |x| kernels::smith_g1(x[0], x[1]),
        |x| shade::masking(x[0], x[1])
    ),
    kernel!(
        "Smith G2",
        smith_g2,
        Measure::Ulp,
        |random| {
            let (l, v) = (random.cosine(), random.cosine());
            list([&[l, v, random.size(-13, 0)]])
        },
        |x, _| {
            let [l, v, a] = vector(x, 0).map(f64::from);
            let smith = |c: f64| (a * a * (1.0 - c) * (1.0 + c) + c * c).sqrt();
            2.0 * l * v / (l * smith(v) + v * smith(l))
        },
        |x| kernels::smith_g2(x[0], x[1], x[2]),
        |x| (shade::visibility(x[0], x[1], x[2]) * (x[0] + x[0])) * (x[1] + x[1])
    ),
    kernel!(
        "Beckmann D",
        beckmann,
        // The exponent's rounding.
        Measure::Unit(|x, d| d * (4.0 + 4.0 * exponent(x[0].into(), x[1].into()))),
        |random| loop {
            let (cos, m) = (random.cosine(), random.size(-9, 1));
            if exponent(cos.into(), m.into()) < 60.0 {
                return list([&[cos, m]]);
            }
        },
        |x, _| {
            let (c, m) = (f64::from(x[0]), f64::from(x[1]));
            exact_exp(-exponent(c, m)) / (PI * m * m * c * c * c * c)
        },
        |x| scalar(beckmann_packet(&x.map(splat))),
        beckmann_packet
    ),
    kernel!(
        "Schlick",
        schlick,
        Measure::Ulp,
        |random| {
            let f0 = random.range(0.0, 1.0);
            list([&[f0, random.cosine()]])
        },
        |x, _| {
            let (f0, m) = (f64::from(x[0]), 1.0 - f64::from(x[1]));
            f0 + (1.0 - f0) * m * m * m * m * m
        },
        |x| kernels::schlick(x[0], x[1]),
        |x| shade::schlick(V3::new(x[0], x[0], x[0]), F::ONE, x[1]).x
    ),
    kernel!(
        "Fresnel",
        fresnel,
        Measure::Ulp,
        |random| {
            let n_i = if random.one_in(2) { 1.0 } else { random.range(1.0, 3.0) };
            let n_t = if random.one_in(8) { n_i + random.signed(-20, -4) } else { random.range(1.0, 3.0) };
            list([&[near_critical(random, n_i, n_t), n_i, n_t]])
        },
        |x, _| {
            let [c, i, t] = vector(x, 0).map(f64::from);
            let g2 = (t - i) * (t + i) + (i * c) * (i * c);
            if g2 < 0.0 {
                return 1.0;
            }
            let g = g2.sqrt();
            let s = (i - t) * (i + t) / ((i * c + g) * (i * c + g));
            let p = (t * t * c - i * g) / (t * t * c + i * g);
            if i == t && c == 0.0 { 0.0 } else { 0.5 * (s * s + p * p) }
        },
        |x| kernels::fresnel(x[0], x[1], x[2]),
        |x| dielectric::reflectance(x[0], x[1], x[2])
    ),
    kernel!(
        "refraction",
        refract,
        Measure::Unit(|x, cos| {
            let eta = f64::from(x[6]);
            (1.0 + eta * eta) * (1.0 + 1.0 / cos.abs().max(1e-3))
        }),
        |random| {
            let n = random.direction();
            let eta = if random.one_in(2) { random.range(1.0, 2.5) } else { random.range(0.4, 1.0) };
            let any = random.direction();
            let cos = near_critical(random, eta, 1.0).max(1e-6);
            let across = (any - n * any.dot(n)).normalize_or(n.any_orthonormal_vector());
            let d = (across * ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt() - n * cos).normalize();
            list([&d.to_array(), &n.to_array(), &[eta]])
        },
        |x, _| {
            let (d, n, eta) = (v3(x, 0).as_dvec3(), v3(x, 3).as_dvec3(), f64::from(x[6]));
            let sine: f64 = eta * n.cross(d).length();
            // Within the rounding of n and d either is right.
            if (sine - 1.0).abs() < 8.0 * U { f64::INFINITY } else { -((1.0 - sine) * (1.0 + sine)).sqrt() }
        },
        |x| {
            let all = x.map(splat);
            let found = refracted(&all);
            if scalar(found.total).to_bits() != 0 {
                f32::NAN
            } else {
                scalar(found.direction.dot(packet(&all, 3)))
            }
        },
        |x| refracted(x).direction.x
    ),
    kernel!(
        "Henyey-Greenstein",
        phase,
        Measure::Ulp,
        |random| {
            let g = if random.one_in(2) { 1.0 - random.size(-13, 0) } else { random.range(-0.999, 0.999) };
            let cos = random.cosine();
            list([&[if random.one_in(4) { -cos } else { cos }, g.min(phase::STEEPEST)]])
        },
        |x, _| {
            let (c, g) = (f64::from(x[0]), f64::from(x[1]));
            let (c, g) = if g < 0.0 { (-c, -g) } else { (c, g) };
            let d = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - c);
            (1.0 - g) * (1.0 + g) / (4.0 * PI * d * d.sqrt())
        },
        |x| kernels::henyey_greenstein(x[0], x[1]),
        |x| phase::phase(scalar(x[1]), x[0])
    ),
    kernel!(
        "HG, drawn cosine",
        turn,
        Measure::Unit(|_, _| 1.0),
        |random| {
            let g = match random.bits() % 3 {
                0 => random.size(-30, -1),
                1 => 1.0 - random.size(-13, 0),
                _ => random.range(-0.999, 0.999),
            };
            let u = random.range(0.0, 1.0);
            list([&[u, if g == 0.0 { 0.5 } else { g.min(phase::STEEPEST) }]])
        },
        |x, _| {
            let (u, g) = (f64::from(x[0]), f64::from(x[1]));
            let (u, sign, g) = if g < 0.0 { (1.0 - u, -1.0, -g) } else { (u, 1.0, g) };
            let e = (1.0 - g) / (1.0 - g + 2.0 * g * u);
            sign * (1.0 - 2.0 * e * e * (1.0 - u) * (1.0 + g * u))
        },
        |x| kernels::sample_henyey_greenstein(x[0], x[1])[0],
        |x| phase::turn(scalar(x[1]), x[0]).cos
    ),
    kernel!(
        "extinction, 1024 steps",
        extinction,
        Measure::Ulp,
        |random| list([&[random.size(-34, -4)]]),
        |x, _| -exact_exp_m1(-1024.0 * f64::from(x[0])),
        |x| {
            let mut sum = kernels::Extinction::default();
            (0..1024).for_each(|_| sum.add(x[0]));
            sum.lost()
        },
        |x| {
            let mut sum = extinction::Depth::default();
            (0..1024).for_each(|_| sum.add(x[0]));
            sum.lost()
        }
    ),
    kernel!(
        "even medium",
        homogeneous,
        Measure::Ulp,
        |random| list([&[random.size(-40, 6), random.size(-10, 10)]]),
        |x, _| {
            let (sigma, t) = (f64::from(x[0]), f64::from(x[1]));
            -exact_exp_m1(-sigma * t) / sigma
        },
        |x| kernels::homogeneous(x[0], x[1]),
        |x| extinction::reach(x[0], x[1])
    ),
];

/// D from two vectors, as the engine's packets have it.
fn ggx_packet(x: &Arguments<F>) -> F {
    let (n, h) = (packet(x, 0), packet(x, 3));
    let across = n.cross(h);
    shade::distribution(across.dot(across), n.dot(h), x[6]) * splat(std::f32::consts::FRAC_1_PI)
}

fn beckmann_packet(x: &Arguments<F>) -> F {
    let sine2 = (F::ONE - x[0]) * (F::ONE + x[0]);
    shade::beckmann(sine2, x[0], x[1]) * splat(std::f32::consts::FRAC_1_PI)
}

fn refracted(x: &Arguments<F>) -> shade::Refracted {
    let (d, n) = (packet(x, 0), packet(x, 3));
    shade::refract(n, d, -d.dot(n), x[6])
}
