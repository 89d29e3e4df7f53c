//! Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) of luma in display values.
//!
//! SSIM = (2 μx μy + C1)(2 σxy + C2) / ((μx² + μy² + C1)(σx² + σy² + C2)), with means, variances
//! and covariance over a Gaussian window of eleven taps, sigma 1.5; C1 = 0.01², C2 = 0.03². The
//! mean over the picture: 1 for equal pictures.

use super::filter::{Plane, normalised, separable, taps};
use super::{Picture, channels};

const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Mean structural similarity of two pictures of one size.
pub fn ssim(a: &Picture, b: &Picture) -> f64 {
    let luma = |p: &Picture| -> Plane {
        let of = |&pixel: &u32| {
            let [r, g, b] = channels(pixel);
            0.299 * r + 0.587 * g + 0.114 * b
        };
        p.pixels.iter().map(of).collect()
    };
    let (x, y) = (luma(a), luma(b));
    let window = normalised(taps(5, |t| (-t * t / (2.0 * 1.5 * 1.5)).exp()));
    let mean = |plane: &[f64]| separable(plane, a.size.0 as usize, &window, &window);
    let product = |x: &[f64], y: &[f64]| -> Plane { x.iter().zip(y).map(|(x, y)| x * y).collect() };
    let [mx, my, xx, yy, xy] =
        [mean(&x), mean(&y), mean(&product(&x, &x)), mean(&product(&y, &y)), mean(&product(&x, &y))];
    let at = |i: usize| {
        let (mx, my) = (mx[i], my[i]);
        let (vx, vy, cov) = (xx[i] - mx * mx, yy[i] - my * my, xy[i] - mx * my);
        (2.0 * mx * my + C1) * (2.0 * cov + C2) / ((mx * mx + my * my + C1) * (vx + vy + C2))
    };
    (0..x.len()).map(at).sum::<f64>() / x.len() as f64
}

#[cfg(test)]
mod tests {
    use super::super::examples::{pair, picture};
    use super::*;

    #[test]
    fn one_for_equal_pictures_less_for_others_and_the_same_both_ways() {
        let (a, b) = pair();
        assert!((ssim(&a, &a) - 1.0).abs() < 1e-12);
        let similarity = ssim(&a, &b);
        assert!((0.0..0.95).contains(&similarity), "{similarity}");
        assert_eq!(similarity, ssim(&b, &a));
    }

    #[test]
    fn even_pictures_differ_by_their_means_alone() {
        let [a, b] = [51, 102].map(|v| picture((20, 16), |_, _| [v; 3]));
        let expected = (2.0 * 0.2 * 0.4 + C1) / (0.2 * 0.2 + 0.4 * 0.4 + C1);
        assert!((ssim(&a, &b) - expected).abs() < 1e-9);
    }
}
