//! Differences pixel by pixel: root mean square and peak signal-to-noise ratio, the greatest
//! difference, and flicker.

use super::{Picture, channels, decode};

/// Root of the mean square of numbers.
fn root_mean_square(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.fold((0.0, 0), |(sum, count), d| (sum + d * d, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// Differences of two pictures' channels, as `value` tells them from display values.
fn differences<'a>(a: &'a [u32], b: &'a [u32], value: &'a [f64; 256]) -> impl Iterator<Item = f64> + use<'a> {
    assert_eq!(a.len(), b.len(), "pictures of one size");
    let level = |pixel: u32, shift: u32| value[(pixel >> shift & 255) as usize];
    let difference = move |(&a, &b): (&u32, &u32)| [16, 8, 0].map(|shift| level(a, shift) - level(b, shift));
    a.iter().zip(b).flat_map(difference)
}

/// Linear light of each display value.
fn light() -> [f64; 256] {
    std::array::from_fn(|i| decode(i as f64 / 255.0))
}

/// Display values from 0 to 1.
fn display() -> [f64; 256] {
    std::array::from_fn(|i| i as f64 / 255.0)
}

/// Root mean square error in linear light.
pub fn linear_rmse(a: &Picture, b: &Picture) -> f64 {
    root_mean_square(differences(&a.pixels, &b.pixels, &light()))
}

/// Peak signal-to-noise ratio, dB, of a root mean square error where 1 is white.
pub fn psnr_of_rmse(rmse: f64) -> f64 {
    -20.0 * rmse.log10()
}

/// Peak signal-to-noise ratio of display values, dB; infinite for equal pictures.
pub fn psnr(a: &[u32], b: &[u32]) -> f64 {
    psnr_of_rmse(root_mean_square(differences(a, b, &display())))
}

/// Greatest difference of display values, 0 to 1.
pub fn greatest(a: &Picture, b: &Picture) -> f64 {
    differences(&a.pixels, &b.pixels, &display()).fold(0.0, |most, d| most.max(d.abs()))
}

/// Flicker of one step in time: root mean square of what changes from one frame to the next beyond
/// what changes in truth, in display values. `frames` and `truth` hold this frame and the next.
pub fn flicker(frames: [&Picture; 2], truth: [&Picture; 2]) -> f64 {
    let changes = |[now, next]: [&Picture; 2]| -> Vec<f64> {
        let pixels = now.pixels.iter().zip(&next.pixels);
        pixels
            .flat_map(|(&now, &next)| {
                let (now, next) = (channels(now), channels(next));
                [0, 1, 2].map(|i| next[i] - now[i])
            })
            .collect()
    };
    root_mean_square(changes(frames).iter().zip(changes(truth)).map(|(a, b)| a - b))
}

#[cfg(test)]
mod tests {
    use super::super::examples::{pair, picture};
    use super::*;

    #[test]
    fn equal_pictures_differ_by_nothing() {
        let (a, _) = pair();
        assert_eq!((linear_rmse(&a, &a), greatest(&a, &a)), (0.0, 0.0));
        assert_eq!(psnr(&a.pixels, &a.pixels), f64::INFINITY);
    }

    #[test]
    fn black_and_white_differ_by_one() {
        let [black, white] = [0, 255].map(|v| picture((5, 3), |_, _| [v; 3]));
        assert_eq!((linear_rmse(&black, &white), greatest(&black, &white)), (1.0, 1.0));
        assert_eq!(psnr_of_rmse(1.0), 0.0);
        assert!((psnr_of_rmse(0.01) - 40.0).abs() < 1e-9);
    }

    #[test]
    fn one_wrong_level_in_one_channel() {
        let a = picture((10, 10), |_, _| [128; 3]);
        let b = picture((10, 10), |x, y| [128 + u32::from(x + y == 0), 128, 128]);
        let step = decode(129.0 / 255.0) - decode(128.0 / 255.0);
        assert!((linear_rmse(&a, &b) - step / 300_f64.sqrt()).abs() < 1e-12);
        assert_eq!(greatest(&a, &b), 129.0 / 255.0 - 128.0 / 255.0);
    }

    #[test]
    fn an_error_that_stands_still_does_not_flicker() {
        let grey = |v| picture((4, 4), |_, _| [v; 3]);
        let [dark, less, light] = [51, 102, 153].map(grey);
        assert!(flicker([&less, &light], [&dark, &less]) < 1e-12);
        assert!((flicker([&dark, &light], [&dark, &less]) - 0.2).abs() < 1e-12);
    }
}
