//! Against roots whose digits are known by construction, and by their sign changes.

use super::roots;
use crate::math::check::ulp_error;
use crate::trace::check::{Random, two_to};

#[test]
fn hard_coefficients() {
    // Huge b beside small a and c: the naive lesser root is 0.
    assert_eq!(roots(1.0, -1e8, 1.0), Some([1e-8, 1e8]));
    assert_eq!(roots(0.0, 2.0, -3.0), Some([1.5, 1.5]));
    assert_eq!(roots(1e-45, 1.0, -1.0), Some([f32::NEG_INFINITY, 1.0]));
    assert_eq!(roots(0.0, 0.0, 0.0), None);
    assert_eq!(roots(0.0, 0.0, 1.0), None);
    assert_eq!(roots(1.0, 0.0, 0.0), Some([0.0, 0.0]));
    assert_eq!(roots(1.0, 0.0, -4.0), Some([-2.0, 2.0]));
    assert_eq!(roots(-1.0, 0.0, 4.0), Some([-2.0, 2.0]));
    assert_eq!(roots(1.0, -0.0, 1.0), None);
    // Double, and one bit to either side.
    assert_eq!(roots(1.0, 2.0, 1.0), Some([-1.0, -1.0]));
    assert_eq!(roots(1.0, 2.0, 1.0_f32.next_up()), None);
    assert!(roots(1.0, 2.0, 1.0_f32.next_down()).unwrap()[0] < -1.0);
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for [a, b, c] in [[odd, 1.0, 1.0], [1.0, odd, 1.0], [1.0, 1.0, odd]] {
            assert_eq!(roots(a, b, c), None, "{a} {b} {c}");
        }
    }
    assert_eq!(roots(f32::MAX, f32::MAX, f32::MIN).map(|r| r[1] > 0.0), Some(true));
}

/// With whole a, x and y, a (t - x)(t - y) has exact f32 coefficients, and x and y as roots.
#[test]
fn known_roots_come_back_exactly() {
    let mut random = Random::new(690);
    for _ in 0..100_000 {
        let mut whole = |bits: u32| (random.bits() % (1 << bits)) as f32 - (1 << (bits - 1)) as f32;
        let (a, x, y) = (whole(6), whole(9), whole(9));
        if a == 0.0 {
            continue;
        }
        let scale = two_to(random.bits() as i32 % 20);
        let got = roots(a * scale, -a * (x + y) * scale, a * x * y * scale);
        assert_eq!(got, Some([x.min(y), x.max(y)]), "{a} {x} {y} {scale:e}");
    }
}

/// Sums of products of f32 are held by two f64, so the oracle refines the root once in those.
#[test]
fn any_roots_are_within_half_an_ulp() {
    let mut random = Random::new(691);
    let (mut worst, mut found) = (0.0_f64, 0);
    for _ in 0..300_000 {
        let (a, b, c) = (random.signed(-20, 20), random.signed(-20, 20), random.signed(-20, 20));
        let Some(got) = roots(a, b, c) else { continue };
        found += 1;
        let (x, y, z) = (f64::from(a), f64::from(b), f64::from(c));
        for root in got {
            if a == 0.0 || root == 0.0 || !root.is_finite() {
                continue;
            }
            // A Newton step from the f64 root near it; at a double root it would divide by nothing.
            let t = f64::from(root);
            let slope = 2.0 * x * t + y;
            if slope.abs() < 1e-4 * y.abs().max((x * t).abs()) {
                continue;
            }
            let better = t - (t * (x * t + y) + z) / slope;
            worst = worst.max(ulp_error(root, better));
        }
    }
    println!("quadratic: {found} with roots, worst {worst:.4} ulp");
    assert!(worst <= 0.51 && found > 100_000);
}
