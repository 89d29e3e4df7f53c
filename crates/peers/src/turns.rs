//! Times of works that take turns, so that what disturbs the machine disturbs all alike.
//!
//! Processor time of all threads together: other programs hardly show in it, and a second thread that a work
//! starts counts too.

use crate::figures::{processor_ms, quantile};

/// Median times, ms, of passes in which each work has one turn; a pass before those isn't counted.
pub fn medians(passes: usize, works: &mut [Box<dyn FnMut() + '_>]) -> Vec<f64> {
    let mut times = vec![Vec::new(); works.len()];
    for pass in 0..=passes {
        for (work, times) in works.iter_mut().zip(&mut times) {
            let begin = processor_ms();
            work();
            let time = processor_ms() - begin;
            times.extend((pass > 0).then_some(time));
        }
    }
    times.iter().map(|times| quantile(times, 0.5)).collect()
}
