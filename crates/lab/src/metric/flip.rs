//! ꟻLIP: what a viewer notices who flips between two pictures (Andersson, Nilsson, Akenine-Möller,
//! Oskarsson, Åström, Fairchild 2020, "ꟻLIP: A Difference Evaluator for Alternating Images").
//!
//! Colour: both pictures in the opponent space YCxCz are blurred by what the eye can't resolve
//! (contrast sensitivity as sums of Gaussians), go to CIELAB with Hunt's adjustment, and their HyAB
//! distance to the power 0.7 is mapped to 0..1. Features: edges and points are sought in the
//! lightness by first and second derivatives of a Gaussian. Together: colour^(1 - feature).

use super::filter::{Plane, normalised, separable, taps};
use super::{Picture, channels, decode};
use std::f64::consts::PI;

/// Pixels per degree of vision: 0.7 m from a screen 0.7 m wide with 3840 px, about.
const PER_DEGREE: f64 = 67.0;

/// White of sRGB (D65) as the sums of the matrix below.
const WHITE: [f64; 3] = [0.950428545, 1.0, 1.088900371];

/// From linear sRGB to XYZ.
const XYZ: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

/// From XYZ to linear sRGB.
const RGB: [[f64; 3]; 3] = [
    [3.241003275, -1.537398934, -0.498615861],
    [-0.969224334, 1.875930071, 0.041554224],
    [0.055639423, -0.204011202, 1.057148933],
];

/// Two Gaussians (weight, width) for each channel of YCxCz.
const SENSITIVITY: [[(f64, f64); 2]; 3] =
    [[(1.0, 0.0047), (0.0, 1e-5)], [(1.0, 0.0053), (0.0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]];

/// Exponent of colour distances, and the point (share of the greatest, error) where the map bends.
const COLOUR_POWER: f64 = 0.7;
const BEND: (f64, f64) = (0.4, 0.95);
/// Width of the feature detectors, degrees, and exponent of feature differences.
const FEATURE_WIDTH: f64 = 0.082;
const FEATURE_POWER: f64 = 0.5;

fn apply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn ycxcz([x, y, z]: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = [x / WHITE[0], y / WHITE[1], z / WHITE[2]];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn xyz_of([y, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (y + 16.0) / 116.0;
    [(y + cx / 500.0) * WHITE[0], y * WHITE[1], (y - cz / 200.0) * WHITE[2]]
}

/// CIELAB of XYZ, its colours scaled by lightness as Hunt found.
fn hunt(xyz: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| {
        const D: f64 = 6.0 / 29.0;
        if t > D * D * D { t.cbrt() } else { t / (3.0 * D * D) + 4.0 / 29.0 }
    };
    let [x, y, z] = [f(xyz[0] / WHITE[0]), f(xyz[1] / WHITE[1]), f(xyz[2] / WHITE[2])];
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

/// City-block distance in lightness plus Euclidean distance in colour.
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + ((a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt()
}

/// Blurs one channel by its contrast sensitivity.
fn resolve(plane: &[f64], width: usize, gaussians: &[(f64, f64); 2]) -> Plane {
    let widest = SENSITIVITY[2][0].1;
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * PER_DEGREE).ceil() as usize;
    let mut sum = vec![0.0; plane.len()];
    let mut total = 0.0;
    for &(a, b) in gaussians.iter().filter(|g| g.0 > 0.0) {
        let weights = taps(radius, |x| (-PI * PI * (x / PER_DEGREE).powi(2) / b).exp());
        let weight = a * (PI / b).sqrt();
        total += weight * weights.iter().sum::<f64>().powi(2);
        for (to, v) in sum.iter_mut().zip(separable(plane, width, &weights, &weights)) {
            *to += weight * v;
        }
    }
    sum.iter_mut().for_each(|v| *v /= total);
    sum
}

/// Strength of edges and of points in a plane of lightness.
fn features(lightness: &[f64], width: usize) -> [Plane; 2] {
    let sigma = 0.5 * FEATURE_WIDTH * PER_DEGREE;
    let radius = (3.0 * sigma).ceil() as usize;
    let bell = |x: f64| (-x * x / (2.0 * sigma * sigma)).exp();
    let along = normalised(taps(radius, bell));
    let detect = |shape: &dyn Fn(f64) -> f64| -> Plane {
        let mut weights = taps(radius, |x| shape(x) * bell(x));
        let sum = |sign: f64| weights.iter().map(|w| (sign * w).max(0.0)).sum::<f64>();
        let (positive, negative) = (sum(1.0), sum(-1.0));
        weights.iter_mut().for_each(|w| *w /= if *w > 0.0 { positive } else { negative });
        let across = separable(lightness, width, &weights, &along);
        let down = separable(lightness, width, &along, &weights);
        across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
    };
    [detect(&|x| -x), detect(&|x| x * x / (sigma * sigma) - 1.0)]
}

/// What flip needs of one picture.
struct Seen {
    /// Hunt-adjusted CIELAB of what the eye resolves.
    lab: Vec<[f64; 3]>,
    features: [Plane; 2],
}

fn see(picture: &Picture) -> Seen {
    let width = picture.size.0 as usize;
    let opponent = picture.pixels.iter().map(|&p| ycxcz(apply(&XYZ, channels(p).map(decode))));
    let opponent: Vec<[f64; 3]> = opponent.collect();
    let plane = |k: usize| opponent.iter().map(|c| c[k]).collect::<Plane>();
    let planes = [0, 1, 2].map(plane);
    let lightness: Plane = planes[0].iter().map(|y| (y + 16.0) / 116.0).collect();
    let [y, cx, cz] = [0, 1, 2].map(|k| resolve(&planes[k], width, &SENSITIVITY[k]));
    let lab = |i: usize| {
        let rgb = apply(&RGB, xyz_of([y[i], cx[i], cz[i]]));
        hunt(apply(&XYZ, rgb.map(|c| c.clamp(0.0, 1.0))))
    };
    Seen { lab: (0..opponent.len()).map(lab).collect(), features: features(&lightness, width) }
}

/// Error of each pixel, 0 for none to 1, row by row.
pub fn flip(truth: &Picture, test: &Picture) -> Plane {
    assert_eq!(truth.size, test.size, "pictures of one size");
    let (truth, test) = (see(truth), see(test));
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|c| hunt(apply(&XYZ, c)));
    let most = hyab(green, blue).powf(COLOUR_POWER);
    let bend = BEND.0 * most;
    let at = |i: usize| {
        let distance = hyab(truth.lab[i], test.lab[i]).powf(COLOUR_POWER);
        let colour = if distance < bend {
            BEND.1 / bend * distance
        } else {
            BEND.1 + (distance - bend) / (most - bend) * (1.0 - BEND.1)
        };
        let strongest = truth
            .features
            .iter()
            .zip(&test.features)
            .fold(0.0_f64, |most, (a, b)| most.max((a[i] - b[i]).abs()));
        let feature = (strongest / 2_f64.sqrt()).powf(FEATURE_POWER).clamp(0.0, 1.0);
        colour.clamp(0.0, 1.0).powf(1.0 - feature)
    };
    (0..truth.lab.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::super::examples::{pair, picture};
    use super::*;

    fn mean(errors: &[f64]) -> f64 {
        errors.iter().sum::<f64>() / errors.len() as f64
    }

    #[test]
    fn equal_pictures_have_no_error_and_order_makes_no_difference() {
        let (a, b) = pair();
        assert!(flip(&a, &a).iter().all(|&e| e == 0.0));
        let (there, back) = (flip(&a, &b), flip(&b, &a));
        assert!(there.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!(there.iter().all(|e| (0.0..=1.0).contains(e)));
    }

    /// Expected: what NVIDIA's implementation finds, in f32.
    #[test]
    fn even_colours_differ_as_the_authors_say() {
        for (a, b, expected) in [
            ([0, 255, 0], [0, 0, 255], 1.0),
            ([0, 0, 0], [255, 255, 255], 0.96739185),
            ([100, 100, 100], [110, 100, 100], 0.11636571),
        ] {
            let [p, q] = [a, b].map(|c| picture((24, 18), |_, _| c));
            for error in flip(&p, &q) {
                assert!((error - expected).abs() < 1e-4, "{a:?} {b:?}: {error}, not {expected}");
            }
        }
    }

    #[test]
    fn a_picture_of_all_kinds_of_faults_is_rated_as_the_authors_say() {
        let (a, b) = pair();
        let errors = flip(&a, &b);
        assert!((mean(&errors) - 0.2743587613689236).abs() < 1e-4, "{}", mean(&errors));
        for (x, y, expected) in [
            (5, 5, 0.093219146),
            (11, 40, 0.36496493),
            (30, 20, 0.60191727),
            (40, 60, 0.65676856),
            (55, 31, 0.030932095),
            (50, 10, 0.21095209),
            (70, 33, 0.19682842),
            (90, 60, 0.0),
        ] {
            let error = errors[y * 96 + x];
            assert!((error - expected).abs() < 3e-3, "({x}, {y}): {error}, not {expected}");
        }
    }
}
