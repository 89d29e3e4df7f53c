//! Shapes in f64: every distance is within 1 ulp, as the exact polynomial of the surface changes its sign there.

use super::draw::*;
use dashu_ratio::RBig;
use glam::Vec3;
use luc_core::kernels::{self, Crossing, Ray, wide as kernel};
use proptest::prelude::*;

/// A t² + B t + C, exactly.
struct Polynomial([RBig; 3]);

impl Polynomial {
    fn at(&self, t: f32) -> RBig {
        let ([a, b, c], t) = (&self.0, exact(t));
        (a * &t + b) * &t + c
    }

    /// Whether a root lies within an ulp of `t`.
    fn has_root_at(&self, t: f32) -> bool {
        let (below, above) = (self.at(t.next_down()), self.at(t.next_up()));
        (below <= RBig::ZERO) != (above < RBig::ZERO) || below == RBig::ZERO || above == RBig::ZERO
    }

    fn discriminant(&self) -> f64 {
        let [a, b, c] = &self.0;
        near(&(b * b - RBig::from(4) * a * c)) / near(&(b * b + RBig::from(4) * a * c)).abs().max(1e-300)
    }
}

fn cross(a: &[RBig; 3], b: &[RBig; 3]) -> [RBig; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

/// |u + v t|² - r²
fn length(u: &[RBig; 3], v: &[RBig; 3], r: RBig) -> Polynomial {
    Polynomial([dot(v, v), RBig::from(2) * dot(u, v), dot(u, u) - &r * &r])
}

/// Crossings with the side of rays that neither begin next to it nor are tangents.
fn sound(found: Option<Crossing>, surface: &Polynomial, reach: f64, length: f64) -> Result<(), String> {
    let Some(found) = found else { return Ok(()) };
    let least = 1e-6 * reach;
    if surface.discriminant().abs() < 1e-5 || near(&surface.0[2]).abs() < 1e-6 * reach * reach {
        return Ok(());
    }
    for (t, part) in [(found.enter, found.enter_part), (found.exit, found.exit_part)] {
        let plain = t.is_finite() && f64::from(t.abs()) * length > least && part == 0;
        if plain && !surface.has_root_at(t) {
            return Err(format!("{t} of {found:?}"));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(10_000))]

    #[test]
    fn distances_in_f64_are_within_an_ulp(
        place in vector(-6, 8),
        axis in direction(),
        around in direction(),
        way in direction(),
        radius in size(-13, 4),
        slope in size(-5, 3),
        height in signed(-4, 6),
        back in size(-6, 16),
        long in size(-8, 8),
    ) {
        let out = (around - axis * around.dot(axis)).normalize_or(axis.any_orthonormal_vector());
        let target = place + (out + axis * height) * radius;
        let ray = Ray { origin: target - way * (back * radius), direction: way * long };
        let (f, d, a) = (minus(&exact3(ray.origin), &exact3(place)), exact3(ray.direction), exact3(axis));
        let (speed, reach) = (near(&dot(&d, &d)).sqrt(), near(&dot(&f, &f)).sqrt() + f64::from(radius));
        let least = 1e-6 * reach;
        let failed = |name: &str, what: String| TestCaseError::fail(
            format!("{name} {what}: {ray:?} {place:?} {axis:?} {radius:?} {slope:?}"));

        let ball = length(&f, &d, exact(radius));
        sound(kernel::sphere(&ray, place, radius), &ball, reach, speed).map_err(|e| failed("sphere", e))?;

        // Times |axis|².
        let (m, n) = (cross(&f, &a), cross(&d, &a));
        let mut bar = length(&m, &n, RBig::ZERO);
        let reach2 = exact(radius) * exact(radius) * dot(&a, &a);
        bar.0[2] -= &reach2;
        sound(kernel::cylinder(&ray, place, axis, radius), &bar, reach, speed).map_err(|e| failed("cylinder", e))?;

        let (h, rise) = (exact(slope) * dot(&f, &a), exact(slope) * dot(&d, &a));
        let mut hat = length(&m, &n, RBig::ZERO);
        for (to, from) in hat.0.iter_mut().zip([&rise * &rise, RBig::from(2) * &h * &rise, &h * &h]) {
            *to -= from;
        }
        // Along the side the far root is anywhere.
        let slant = near(&hat.0[0]).abs() / near(&(&rise * &rise)).max(1e-300);
        if slant > 1e-5 {
            sound(kernel::cone(&ray, place, axis, slope), &hat, reach, speed).map_err(|e| failed("cone", e))?;
        }

        let floor = Polynomial([RBig::ZERO, dot(&a, &d), dot(&a, &f)]);
        if let Some(t) = kernel::plane(&ray, place, axis) {
            let steep = near(&dot(&a, &d)).abs() > 1e-6 * speed && f64::from(t) * speed > least;
            prop_assert!(!steep || floor.has_root_at(t), "plane {t}: {ray:?} {place:?} {axis:?}");
        }

        // Where both see a body far from tangents they see the same.
        if ball.discriminant().abs() > 1e-3 {
            let (wide, narrow) = (kernel::sphere(&ray, place, radius), kernels::sphere(&ray, place, radius));
            let apart = wide.is_some() != narrow.is_some();
            let close = wide.or(narrow).is_some_and(|c| f64::from(c.exit.abs()) * speed < 1e-5 * reach);
            prop_assert!(!apart || close, "{wide:?} {narrow:?}: {ray:?} {place:?} {radius:?}");
        }
    }

    #[test]
    fn nothing_odd_is_hit_at_nan(origin in odd_vector(), direction in odd_vector(), a in odd_vector(), b in odd_vector(), c in odd_vector(), x in odd(), y in odd()) {
        let ray = Ray { origin, direction };
        let axis = b.normalize_or(Vec3::Y);
        let sound = |c: Option<Crossing>| c.is_none_or(|c| c.enter <= c.exit && c.first() > 0.0);
        prop_assert!(sound(kernel::sphere(&ray, a, x)));
        prop_assert!(sound(kernel::cylinder(&ray, a, axis, x)) && sound(kernel::capped_cylinder(&ray, a, axis, x, y)));
        prop_assert!(sound(kernel::cone(&ray, a, axis, x)) && sound(kernel::capped_cone(&ray, a, axis, x, [y, y + 1.0])));
        prop_assert!(kernel::plane(&ray, a, axis).is_none_or(|t| t > 0.0));
        prop_assert!(kernel::triangle(&ray, [a, b, c]).is_none_or(|h| h.t > 0.0));
        prop_assert!(kernel::slab(&ray, a, b).is_none_or(|t| !t[0].is_nan() && !t[1].is_nan()));
    }
}

/// What f32 can't see: an eye 1 mm over a planet of 1000 km.
#[test]
fn a_planet_below_the_feet_is_hit_at_a_millimetre() {
    let (centre, radius) = (Vec3::new(0.0, -1e6, 0.0), 1e6);
    let ray = Ray { origin: Vec3::new(0.0, 0.001, 0.0), direction: -Vec3::Y };
    let found = kernel::sphere(&ray, centre, radius).unwrap();
    assert!((found.enter - 0.001).abs() < 1e-8, "{found:?}");
}
