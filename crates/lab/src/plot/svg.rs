//! Charts drawn as SVG.

use super::axis::Scale;
use super::labels::{Box4, HEIGHT, LETTER, place};
use super::{Chart, Look, Point};

/// Room around the axes: left, top, right, bottom, px.
const ROOM: [f64; 4] = [64.0, 40.0, 18.0, 46.0];
/// Radius of dots and of large ones, px.
const DOT: f64 = 3.2;
const MARK: f64 = 5.5;

/// Text as it stands in SVG and HTML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// An SVG file of drawings `width` by `height` px in rows of `across`.
pub fn page(charts: &[Chart], across: usize, (width, height): (f64, f64)) -> String {
    let across = across.min(charts.len()).max(1);
    let rows = charts.len().div_ceil(across);
    let (w, h) = (width * across as f64, height * rows as f64);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
    );
    for (i, chart) in charts.iter().enumerate() {
        let (x, y) = ((i % across) as f64 * width, (i / across) as f64 * height);
        out += &format!("<g transform=\"translate({x} {y})\">\n{}</g>\n", body(chart, width, height));
    }
    out + "</svg>\n"
}

/// An SVG file of one chart.
pub fn draw(chart: &Chart, size: (f64, f64)) -> String {
    page(std::slice::from_ref(chart), 1, size)
}

/// Where a chart's values lie in the picture.
struct Frame {
    inside: Box4,
    x: Scale,
    y: Scale,
}

impl Frame {
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let Box4(left, top, right, bottom) = self.inside;
        (left + self.x.place(x) * (right - left), bottom - self.y.place(y) * (bottom - top))
    }
}

fn body(chart: &Chart, width: f64, height: f64) -> String {
    let shown = |p: &&Point| chart.x.holds(p.x) && chart.y.holds(p.y);
    let all = || chart.series.iter().flat_map(|s| &s.points).filter(shown);
    let [left, top, right, bottom] = ROOM;
    let frame = Frame {
        inside: Box4(left, top, width - right, height - bottom),
        x: chart.x.scale(all().map(|p| p.x)),
        y: chart.y.scale(all().map(|p| p.y)),
    };
    let mut out = grid(chart, &frame, width, height);
    let mut taken: Vec<Box4> = Vec::new();
    let mut labels = Vec::new();
    for series in &chart.series {
        let points: Vec<&Point> = series.points.iter().filter(shown).collect();
        let places: Vec<(f64, f64)> = points.iter().map(|p| frame.at(p.x, p.y)).collect();
        let colour = series.colour;
        if matches!(series.look, Look::Line | Look::Dashes | Look::Path) && places.len() > 1 {
            let d: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
            let dash = if series.look == Look::Dashes { " stroke-dasharray=\"5 4\"" } else { "" };
            out += &format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-linejoin=\"round\"{dash}/>\n",
                d.join(" ")
            );
        }
        let radius = match series.look {
            Look::Line | Look::Dashes => 0.0,
            Look::Dots => DOT * 0.75,
            Look::Path => DOT,
            Look::Marks => MARK,
        };
        for (point, &(x, y)) in points.iter().zip(&places) {
            if let Some((from, to)) = point.spread.filter(|s| chart.x.holds(s.0) && chart.x.holds(s.1)) {
                let [from, to] = [from, to].map(|v| frame.at(v, point.y).0.clamp(left, width - right));
                out += &format!(
                    "<path d=\"M{from:.1} {y:.1}H{to:.1}\" stroke=\"{colour}\" stroke-opacity=\".45\"/>\n"
                );
            }
            if radius > 0.0 {
                out += &format!(
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\" stroke=\"#fff\" stroke-width=\".7\"/>\n"
                );
                taken.push(Box4(x - radius, y - radius, x + radius, y + radius));
            }
            if !point.label.is_empty() {
                labels.push((point.label.clone(), (x, y), radius + 4.0, series));
            }
        }
    }
    out += &legend(chart, &frame, &mut taken);
    // The latest series lies on top and chooses its places first.
    for (text, at, off, series) in labels.into_iter().rev() {
        let (x, y) = place(&text, at, off, &frame.inside, &mut taken);
        let weight = if series.look == Look::Marks { " font-weight=\"bold\"" } else { "" };
        // A halo of its own, because not every viewer knows the order of painting.
        let halo = " stroke=\"#fff\" stroke-width=\"3\" stroke-opacity=\".8\"";
        for (colour, halo) in [("#fff", halo), (series.colour, "")] {
            out += &format!(
                "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{colour}\"{halo}{weight}>{}</text>\n",
                escape(&text)
            );
        }
    }
    out
}

/// Title, lines of the ticks and their labels.
fn grid(chart: &Chart, frame: &Frame, width: f64, height: f64) -> String {
    let Box4(left, top, right, bottom) = frame.inside;
    let mut out = format!(
        "<text x=\"{left}\" y=\"20\" font-size=\"14\" font-weight=\"bold\" fill=\"#222\">{}</text>\n",
        escape(&chart.title)
    );
    for (v, label) in frame.x.ticks() {
        let x = left + frame.x.place(v) * (right - left);
        out += &format!(
            "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"#e4e4e4\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">{label}</text>\n",
            bottom + 15.0
        );
    }
    for (v, label) in frame.y.ticks() {
        let y = bottom - frame.y.place(v) * (bottom - top);
        out += &format!(
            "<path d=\"M{left} {y:.1}H{right}\" stroke=\"#e4e4e4\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">{label}</text>\n",
            left - 6.0,
            y + 4.0
        );
    }
    let (across, middle) = ((left + right) * 0.5, (top + bottom) * 0.5);
    out += &format!(
        "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"#555\"/>\n\
         <text x=\"{across:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#222\">{}</text>\n\
         <text transform=\"translate(15 {middle:.1}) rotate(-90)\" text-anchor=\"middle\" fill=\"#222\">{}</text>\n",
        height - 10.0,
        escape(&chart.x.label),
        escape(&chart.y.label)
    );
    let _ = width;
    out
}

/// Names of the series, in the corner where the fewest points lie.
fn legend(chart: &Chart, frame: &Frame, taken: &mut Vec<Box4>) -> String {
    let named: Vec<_> = chart.series.iter().filter(|s| !s.name.is_empty()).collect();
    let Some(longest) = named.iter().map(|s| s.name.chars().count()).max() else { return String::new() };
    let (width, height) = (longest as f64 * LETTER + 26.0, named.len() as f64 * 15.0 + 6.0);
    let Box4(left, top, right, bottom) = frame.inside;
    let corners = [
        (right - width - 6.0, top + 6.0),
        (left + 6.0, bottom - height - 6.0),
        (left + 6.0, top + 6.0),
        (right - width - 6.0, bottom - height - 6.0),
    ];
    let crowd = |&(x, y): &(f64, f64)| {
        let inside =
            |b: &&Box4| b.2 > x - 8.0 && b.0 < x + width + 8.0 && b.3 > y - 8.0 && b.1 < y + height + 8.0;
        taken.iter().filter(inside).count()
    };
    let (x, y) = corners.into_iter().min_by_key(crowd).unwrap_or(corners[0]);
    taken.push(Box4(x, y, x + width, y + height));
    let mut out = format!(
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"#fff\" fill-opacity=\".85\" stroke=\"#ccc\"/>\n"
    );
    for (i, series) in named.iter().enumerate() {
        let line = y + 15.0 * i as f64 + HEIGHT;
        let colour = series.colour;
        let sign = match series.look {
            Look::Dots | Look::Marks => format!(
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{DOT}\" fill=\"{colour}\"/>",
                x + 12.0,
                line - 3.0
            ),
            Look::Dashes => format!(
                "<path d=\"M{:.1} {:.1}h14\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-dasharray=\"4 3\"/>",
                x + 5.0,
                line - 3.0
            ),
            _ => format!(
                "<path d=\"M{:.1} {:.1}h14\" stroke=\"{colour}\" stroke-width=\"2\"/>",
                x + 5.0,
                line - 3.0
            ),
        };
        out += &format!(
            "{sign}<text x=\"{:.1}\" y=\"{line:.1}\" fill=\"#222\">{}</text>\n",
            x + 23.0,
            escape(&series.name)
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Series};
    use super::*;

    fn chart(points: Vec<Point>) -> Chart {
        let series = Series { name: "a < b".into(), colour: "#000", look: Look::Path, points };
        Chart { title: "T & t".into(), x: Axis::log("x"), y: Axis::log("y"), series: vec![series] }
    }

    #[test]
    fn text_is_escaped_and_what_has_no_place_is_left_out() {
        let svg = draw(
            &chart(vec![Point::at(1.0, 2.0), Point::at(0.0, 2.0), Point::at(2.0, f64::NAN)]),
            (400.0, 300.0),
        );
        assert!(svg.contains("T &amp; t") && svg.contains("a &lt; b"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 1);
    }

    #[test]
    fn an_empty_chart_is_still_a_picture() {
        let svg = page(&[chart(Vec::new()), chart(Vec::new())], 2, (200.0, 150.0));
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"));
    }
}
