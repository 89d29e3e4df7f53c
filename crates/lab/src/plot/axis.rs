//! An axis: from values to places in the picture, and the values at which lines are drawn.

/// What runs along a side of a chart.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it measures, with its unit.
    pub label: String,
    /// Equal distances stand for equal factors.
    pub log: bool,
}

impl Axis {
    /// An axis of equal differences.
    pub fn linear(label: &str) -> Self {
        Self { label: label.into(), log: false }
    }

    /// An axis of equal factors.
    pub fn log(label: &str) -> Self {
        Self { label: label.into(), log: true }
    }

    /// Whether a value has a place on it.
    pub fn holds(&self, value: f64) -> bool {
        value.is_finite() && (!self.log || value > 0.0)
    }

    fn bend(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }

    /// The axis as needed for `values`, with some room at both ends.
    pub fn scale(&self, values: impl Iterator<Item = f64>) -> Scale {
        let bent = values.filter(|&v| self.holds(v)).map(|v| self.bend(v));
        let (lo, hi) = bent.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        let (lo, hi) = if lo <= hi { (lo, hi) } else { (0.0, 1.0) };
        let least = if self.log { 0.3 } else { 1e-9 };
        let room = ((hi - lo) * 0.07).max((least - (hi - lo)) * 0.5);
        Scale { log: self.log, lo: lo - room, hi: hi + room }
    }
}

/// An axis with its ends, in bent units.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    log: bool,
    lo: f64,
    hi: f64,
}

impl Scale {
    /// Where a value lies, 0 at the lower end to 1.
    pub fn place(&self, value: f64) -> f64 {
        let bent = if self.log { value.log10() } else { value };
        (bent - self.lo) / (self.hi - self.lo)
    }

    /// Values at which lines are drawn, with their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let values = if self.log { self.log_ticks() } else { self.linear_ticks() };
        values.into_iter().map(|v| (v, label(v))).collect()
    }

    fn log_ticks(&self) -> Vec<f64> {
        const WAYS: [&[f64]; 3] =
            [&[1.0], &[1.0, 2.0, 5.0], &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]];
        let with = |steps: &[f64]| -> Vec<f64> {
            let decades = self.lo.floor() as i32..=self.hi.ceil() as i32;
            let values = decades.flat_map(|d| steps.iter().map(move |s| s * 10_f64.powi(d)));
            values.filter(|v| (0.0..=1.0).contains(&self.place(*v))).collect()
        };
        let enough = WAYS.iter().map(|steps| with(steps)).find(|ticks| ticks.len() >= 4);
        enough.unwrap_or_else(|| with(WAYS[2]))
    }

    fn linear_ticks(&self) -> Vec<f64> {
        let rough = (self.hi - self.lo) / 6.0;
        let decade = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|s| s * decade).into_iter().find(|s| *s >= rough);
        let step = step.unwrap_or(decade);
        let range = (self.lo / step).ceil() as i64..=(self.hi / step).floor() as i64;
        range.map(|i| i as f64 * step).collect()
    }
}

/// A value on an axis, short.
fn label(v: f64) -> String {
    match v.abs() {
        0.0 => "0".into(),
        a if a >= 999_999.5 => format!("{} M", trim(v / 1e6, 1)),
        a if a >= 9_999.5 => format!("{} k", trim(v / 1e3, 1)),
        a => trim(v, (2 - a.log10().floor() as i32).clamp(0, 6) as usize),
    }
}

fn trim(v: f64, digits: usize) -> String {
    let text = format!("{v:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_and_tick_lies_on_the_axis() {
        for (axis, values) in [
            (Axis::log("a"), vec![0.003, 0.4, 70.0]),
            (Axis::log("b"), vec![5.0]),
            (Axis::log("c"), vec![5.0, 5.5]),
            (Axis::linear("d"), vec![-3.0, 0.0, 12.5]),
            (Axis::linear("e"), vec![1e-5, 2e-5]),
        ] {
            let scale = axis.scale(values.iter().copied());
            assert!(values.iter().all(|v| (0.0..=1.0).contains(&scale.place(*v))), "{axis:?}");
            let ticks = scale.ticks();
            assert!((2..=14).contains(&ticks.len()), "{axis:?}: {ticks:?}");
            assert!(ticks.iter().all(|(v, _)| (-1e-9..=1.0 + 1e-9).contains(&scale.place(*v))), "{axis:?}");
        }
    }

    #[test]
    fn labels_are_short() {
        for (v, text) in
            [(0.002, "0.002"), (1500.0, "1500"), (57_600.0, "57.6 k"), (2e6, "2 M"), (0.15, "0.15")]
        {
            assert_eq!(label(v), text);
        }
    }
}
