//! Means over frames and parts, and the Pareto front: settings that no other setting beats in both
//! time and error.

use super::table::{Figure, Row};
use crate::figures::mean;

/// A setting, averaged.
#[derive(Clone, Debug)]
pub struct Averaged {
    /// Name of the knob.
    pub knob: String,
    /// Its position.
    pub value: String,
    /// Rows that went in.
    pub rows: Vec<Row>,
}

impl Averaged {
    /// Mean of a figure over the rows that have it; NaN if none has. Geometric where factors are what
    /// counts, so that no part outweighs the others by being slow or hard.
    pub fn mean(&self, figure: Figure) -> f64 {
        use Figure::*;
        let values = self.rows.iter().map(|r| r.get(figure)).filter(|v| v.is_finite());
        let share =
            matches!(figure, Traced | Interpolated | Filled | Psnr | Ssim | Greatest | PsnrOfSampling);
        if share {
            return mean(&values.collect::<Vec<_>>());
        }
        mean(&values.filter(|v| *v > 0.0).map(f64::ln).collect::<Vec<_>>()).exp()
    }
}

/// Rows by setting, in the order in which settings first come.
pub fn averaged<'a>(rows: impl Iterator<Item = &'a Row>) -> Vec<Averaged> {
    let mut all: Vec<Averaged> = Vec::new();
    for row in rows {
        match all.iter_mut().find(|a| a.knob == row.knob && a.value == row.value) {
            Some(a) => a.rows.push(row.clone()),
            None => all.push(Averaged {
                knob: row.knob.clone(),
                value: row.value.clone(),
                rows: vec![row.clone()],
            }),
        }
    }
    all
}

/// Which of `points` (time, error) lie on the front, from fast to exact.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].1.is_finite()).collect();
    order.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)));
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].1 < least;
        least = least.min(points[i].1);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points =
            [(1.0, 9.0), (2.0, 4.0), (2.0, 5.0), (3.0, 4.0), (4.0, 1.0), (0.5, f64::NAN), (9.0, 2.0)];
        let found = front(&points);
        assert_eq!(found, [0, 1, 4]);
        for i in 0..points.len() {
            let beaten =
                (0..points.len()).any(|k| k != i && points[k].0 <= points[i].0 && points[k].1 <= points[i].1);
            assert_eq!(found.contains(&i), !beaten && points[i].1.is_finite(), "{i}");
        }
    }
}
