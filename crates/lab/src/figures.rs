//! Figures of lists of numbers, and the clock that counts the processor's time.

use rustix::time::{ClockId, clock_gettime};

/// Processor time of this program so far, ms: what other programs do hardly shows in it.
pub fn processor_ms() -> f64 {
    let t = clock_gettime(ClockId::ProcessCPUTime);
    t.tv_sec as f64 * 1e3 + t.tv_nsec as f64 / 1e6
}

/// The value that the share `q` of `numbers` lies under, between the two nearest; NaN for none.
pub fn quantile(numbers: &[f64], q: f64) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q * last as f64;
    let (i, x) = (at as usize, at.fract());
    sorted[i] + (sorted[(i + 1).min(last)] - sorted[i]) * x
}

/// Mean; NaN for none.
pub fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// Standard deviation of a sample; 0 for one number.
pub fn deviation(numbers: &[f64]) -> f64 {
    let mean = mean(numbers);
    let squares: f64 = numbers.iter().map(|x| (x - mean) * (x - mean)).sum();
    (squares / (numbers.len().max(2) - 1) as f64).sqrt()
}

/// Exponent b of the power law y = a x^b through points, and a: a straight line through logarithms.
pub fn power_law(points: &[(f64, f64)]) -> (f64, f64) {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let over: f64 = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    let b = over / logs.iter().map(|(x, _)| (x - mx) * (x - mx)).sum::<f64>();
    (b, (my - b * mx).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_the_nearest_numbers() {
        let numbers = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(quantile(&numbers, 0.0), 1.0);
        assert_eq!(quantile(&numbers, 0.5), 2.5);
        assert_eq!(quantile(&numbers, 1.0), 4.0);
        assert_eq!(quantile(&[7.0], 0.3), 7.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn deviation_is_that_of_a_sample() {
        assert_eq!(deviation(&[5.0]), 0.0);
        assert!((deviation(&[1.0, 2.0, 3.0, 4.0]) - (5.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_power_law_is_found_again() {
        let points: Vec<(f64, f64)> = [1.0_f64, 2.0, 5.0, 9.0].map(|x| (x, 3.0 * x.powf(0.7))).into();
        let (b, a) = power_law(&points);
        assert!((b - 0.7).abs() < 1e-12 && (a - 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_processors_clock_counts_work() {
        let before = processor_ms();
        let mut x = 1.0_f64;
        while processor_ms() < before + 1.0 {
            x = x.sin() + 1.0;
        }
        assert!(x.is_finite());
    }
}
