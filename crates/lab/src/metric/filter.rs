//! Separable filters over planes of numbers, with the picture's edges repeated beyond it.

use luc_core::parallel;

/// Numbers over a picture, row by row from the top.
pub type Plane = Vec<f64>;

/// Filters a plane `width` wide along the rows by `across` and along the columns by `down`, whose
/// middle weights stand in the middle.
pub fn separable(plane: &[f64], width: usize, across: &[f64], down: &[f64]) -> Plane {
    let height = plane.len() / width;
    let mut along = vec![0.0; plane.len()];
    parallel::each(along.chunks_mut(width).zip(plane.chunks(width)), |_, (to, from)| {
        let reach = across.len() / 2;
        let padded: Vec<f64> =
            (0..width + 2 * reach).map(|i| from[i.saturating_sub(reach).min(width - 1)]).collect();
        for (x, to) in to.iter_mut().enumerate() {
            *to = padded[x..].iter().zip(across).map(|(v, w)| v * w).sum();
        }
    });
    let mut out = vec![0.0; plane.len()];
    parallel::each(out.chunks_mut(width), |y, to| {
        for (k, weight) in down.iter().enumerate() {
            let row = (y + k).saturating_sub(down.len() / 2).min(height - 1);
            for (to, from) in to.iter_mut().zip(&along[row * width..]) {
                *to += weight * from;
            }
        }
    });
    out
}

/// Values of `f` at the whole numbers from `-radius` to `radius`.
pub fn taps(radius: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=2 * radius).map(|i| f(i as f64 - radius as f64)).collect()
}

/// The weights over their sum.
pub fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|w| *w /= sum);
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_that_sums_to_one_keeps_an_even_plane() {
        let weights = normalised(taps(3, |x| (-x * x / 5.0).exp()));
        let out = separable(&[0.25; 35], 7, &weights, &weights);
        assert!(out.iter().all(|v| (v - 0.25).abs() < 1e-12), "{out:?}");
    }

    #[test]
    fn a_single_one_becomes_the_product_of_the_weights() {
        let mut plane = vec![0.0; 49];
        plane[3 * 7 + 3] = 1.0;
        let (across, down) = ([1.0, 2.0, 3.0], [5.0, 7.0, 11.0]);
        let out = separable(&plane, 7, &across, &down);
        // A filter reads ahead by its later weights, so what it spreads is mirrored.
        assert_eq!(out[2 * 7 + 2], 3.0 * 11.0);
        assert_eq!(out[4 * 7 + 4], 1.0 * 5.0);
        assert_eq!(out.iter().sum::<f64>(), 6.0 * 23.0);
    }
}
