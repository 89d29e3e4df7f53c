//! Places for labels: beside their points, off other labels and points, within the chart.

/// A rectangle: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box4(pub f64, pub f64, pub f64, pub f64);

impl Box4 {
    /// Area common with another.
    fn overlap(&self, o: &Box4) -> f64 {
        let width = self.2.min(o.2) - self.0.max(o.0);
        let height = self.3.min(o.3) - self.1.max(o.1);
        width.max(0.0) * height.max(0.0)
    }

    /// Area outside `o`.
    fn outside(&self, o: &Box4) -> f64 {
        (self.2 - self.0) * (self.3 - self.1) - self.overlap(o)
    }
}

/// Height of text, and width of a letter, px.
pub const HEIGHT: f64 = 12.0;
pub const LETTER: f64 = 6.2;

/// Takes the place for `text` beside (x, y) that overlaps `taken` the least, and adds it to them.
/// Returns the left end of its baseline.
pub fn place(text: &str, (x, y): (f64, f64), off: f64, within: &Box4, taken: &mut Vec<Box4>) -> (f64, f64) {
    let width = text.chars().count() as f64 * LETTER;
    let mut best: Option<(f64, Box4)> = None;
    for (ring, far) in [off, off + 9.0, off + 20.0].into_iter().enumerate() {
        for (k, (dx, dy)) in [
            (1.0, -0.7),
            (1.0, 0.7),
            (-1.0, -0.7),
            (-1.0, 0.7),
            (0.0, -1.0),
            (0.0, 1.0),
            (1.0, 0.0),
            (-1.0, 0.0),
        ]
        .into_iter()
        .enumerate()
        {
            let left = x + dx * far - width * (1.0 - dx) * 0.5;
            let middle = y + dy * far + dy * HEIGHT * 0.4;
            let rect = Box4(left, middle - HEIGHT * 0.5, left + width, middle + HEIGHT * 0.5);
            let overlaps: f64 = taken.iter().map(|t| rect.overlap(t)).sum();
            let cost = overlaps + 4.0 * rect.outside(within) + 0.01 * k as f64 + 3.0 * ring as f64;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, rect));
            }
        }
    }
    let (_, rect) = best.unwrap_or((0.0, Box4(x, y, x, y)));
    taken.push(rect);
    (rect.0, rect.3 - 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_near_points_do_not_overlap_and_stay_within() {
        let within = Box4(0.0, 0.0, 300.0, 200.0);
        let mut taken = Vec::new();
        for i in 0..8 {
            place(
                "medium",
                (290.0 - 6.0 * f64::from(i), 100.0 + 9.0 * f64::from(i)),
                6.0,
                &within,
                &mut taken,
            );
        }
        for (i, a) in taken.iter().enumerate() {
            assert!(a.outside(&within) < 1e-9, "{a:?}");
            assert!(taken[..i].iter().all(|b| a.overlap(b) < 1e-9), "{taken:?}");
        }
    }
}
