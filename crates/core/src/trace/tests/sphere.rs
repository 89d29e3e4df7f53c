//! Sphere: both roots against the f64 chord about the point nearest to the centre.

use crate::math::Vec3;
use crate::math::lanes::splat;
use crate::scene::Sphere;
use crate::trace::check::{Inside, Line, Random, Tally, packet, sweep, two_to};
use crate::trace::{Rays8, sphere};

fn ball(centre: Vec3, radius: f32) -> Sphere {
    Sphere { centre, radius, material: 0, blend: 0.0 }
}

/// Half a chord either way of the point nearest to the centre.
fn truth(s: &Sphere, ray: &Line, [skin, ..]: [f64; 3]) -> Option<Inside> {
    let f = ray.o - s.centre.as_dvec3();
    let r = f64::from(s.radius) + skin;
    let nearest = -f.dot(ray.d) / ray.d.length_squared();
    let off = (f + ray.d * nearest).length();
    let half = ((r - off) * (r + off)).sqrt() / ray.d.length();
    (r > 0.0 && half >= 0.0).then_some(Inside { t: [nearest - half, nearest + half], part: [0, 0] })
}

fn judge(tally: &mut Tally, s: &Sphere, rays: &Rays8) {
    let reach = |ray: &Line| (ray.o - s.centre.as_dvec3()).length() + f64::from(s.radius);
    tally.body(rays, &sphere(rays, s), |ray, skin| truth(s, ray, skin), reach, [false; 2], s);
}

#[test]
fn named_cases() {
    let unit = ball(Vec3::ZERO, 1.0);
    let v = Vec3::new;
    let cases = [
        // Far: the naive discriminant is 0.
        (unit, v(0.0, 0.5, -1e4), Vec3::Z),
        (unit, v(0.0, 0.0, -1e4), Vec3::Z),
        (unit, v(0.0, 1.01, -1e4), Vec3::Z),
        (unit, v(0.0, 0.999, -1e4), Vec3::Z),
        (unit, v(0.3, 0.2, -1e7), Vec3::Z),
        // Tiny.
        (ball(v(0.0, 0.0, 10.0), 1e-4), v(0.0, 5e-5, 0.0), Vec3::Z),
        (ball(v(3.0, 0.0, 10.0), 1e-7), v(3.0, 0.0, 0.0), Vec3::Z),
        // Tangent, to the bit and one off.
        (unit, v(0.0, 1.0, -3.0), Vec3::Z),
        (unit, v(0.0, 1.0_f32.next_up(), -3.0), Vec3::Z),
        (unit, v(0.0, 1.0_f32.next_down(), -3.0), Vec3::Z),
        // On the surface, inside, in the middle, leaving.
        (unit, v(0.0, 0.0, -1.0), Vec3::Z),
        (unit, v(0.0, 0.0, -1.0), -Vec3::Z),
        (unit, v(0.0, 0.0, -1.0), Vec3::X),
        (unit, Vec3::ZERO, v(0.6, -0.8, 0.0)),
        (unit, v(0.0, 0.0, 0.999_999_9), Vec3::Z),
        (unit, v(0.0, 0.0, 1.000_000_1), Vec3::Z),
        // Signed zeros.
        (unit, v(-0.0, 0.0, -2.0), v(-0.0, 0.0, 1.0)),
        (unit, v(0.0, -0.0, 2.0), v(0.0, -0.0, -1.0)),
        // A planet below one's feet.
        (ball(v(0.0, -1e6, 0.0), 1e6), v(0.0, 0.001, 0.0), v(1.0, -1e-3, 0.0)),
        (ball(v(0.0, -1e6, 0.0), 1e6), v(0.0, 1.0, 0.0), -Vec3::Y),
    ];
    let mut tally = Tally::new("sphere, named");
    for (s, o, d) in cases {
        judge(&mut tally, &s, &packet(|| (o, d)));
    }
    tally.finish(4.0);
}

#[test]
fn random_cases() {
    let mut tally = Tally::new("sphere");
    sweep(1, 1, 50_000, |random| {
        let r = random.size(-14, 14);
        let s = ball(random.vector(-3, 12) * r, r);
        let rays = packet(|| {
            let n = random.direction();
            let lift = if random.one_in(2) { random.signed(-20, 1) } else { 0.0 };
            random.ray(s.centre + n * r * (1.0 + lift), n, random_axis(n), r)
        });
        judge(&mut tally, &s, &rays);
    });
    assert!(tally.hits > 100_000, "{} hits", tally.hits);
    tally.finish(4.0);
}

/// Some direction for the generator: a ball has no axis.
fn random_axis(n: Vec3) -> Vec3 {
    Vec3::new(n.y, n.z, n.x)
}

#[test]
fn a_larger_ball_is_never_missed_by_a_ray_that_hits_a_smaller_one() {
    let mut random = Random::new(2);
    for _ in 0..20_000 {
        let rays = packet(|| {
            let target = random.direction();
            random.ray(target, Vec3::Y, Vec3::X, 1.0)
        });
        let r = 1.0 + random.signed(-22, -1);
        let (small, large) =
            (sphere(&rays, &ball(Vec3::ZERO, r)), sphere(&rays, &ball(Vec3::ZERO, r * 1.000_001)));
        let lost = small.enter.simd_ne(splat(-1.0)) & large.enter.simd_eq(splat(-1.0));
        assert!(!lost.any(), "{r:?} {:?} {:?}", rays.origin, rays.direction);
    }
}

#[test]
fn scaling_by_a_power_of_two_gives_the_same_bits() {
    let mut random = Random::new(3);
    for _ in 0..20_000 {
        let s = ball(random.vector(-4, 4), random.size(-4, 4));
        let rays = packet(|| {
            let target = s.centre + random.direction() * s.radius;
            random.ray(target, Vec3::Y, Vec3::X, s.radius)
        });
        let k = two_to(random.bits() as i32 % 20);
        let plain = sphere(&rays, &s);
        let scaled = Rays8 { origin: rays.origin * splat(k), direction: rays.direction * splat(k) };
        let scaled = sphere(&scaled, &ball(s.centre * k, s.radius * k));
        assert_eq!(
            (plain.enter, plain.exit),
            (scaled.enter, scaled.exit),
            "{s:?} {:?} {:?} times {k}",
            rays.origin,
            rays.direction
        );
    }
}
