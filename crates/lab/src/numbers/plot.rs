//! The worst errors as a picture: a row per formula on a logarithmic axis.

use super::Row;
use super::report::{raised, short};
use std::fmt::Write;

const LEFT: f64 = 230.0;
const WIDE: f64 = 560.0;
const ROW: f64 = 19.0;
const TOP: f64 = 92.0;
/// Ends of the axis, powers of ten.
const AXIS: [f64; 2] = [-2.0, 8.0];
/// Textbook f32, engine, textbook f64.
const COLOURS: [&str; 3] = ["#d1495b", "#1f6fb2", "#8a8f98"];
const INK: &str = "#1b1f24";
const GREY: &str = "#57606a";

fn across(error: f64) -> f64 {
    #[allow(clippy::disallowed_methods, reason = "a place on paper")]
    let log = if error > 0.0 { error.log10() } else { AXIS[0] };
    LEFT + WIDE * ((log - AXIS[0]) / (AXIS[1] - AXIS[0])).clamp(0.0, 1.0)
}

/// A power of ten, with its exponent raised from 10⁴ on.
fn power_of_ten(power: i32) -> String {
    let mut whole = 1.0;
    (0..power.abs()).for_each(|_| whole *= 10.0);
    match power {
        4.. => raised("10", power),
        0.. => format!("{whole}"),
        _ => format!("{}", 1.0 / whole),
    }
}

/// A line of text whose `anchor` is at (x, y).
fn text(svg: &mut String, (x, y): (f64, f64), anchor: &str, colour: &str, line: &str) {
    writeln!(svg, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{line}</text>")
        .unwrap();
}

/// The picture as SVG.
pub fn picture(rows: &[Row]) -> String {
    let bottom = TOP + ROW * rows.len() as f64;
    let (width, height) = (LEFT + WIDE + 166.0, bottom + 30.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\" stroke=\"none\"/>\n\
         <text x=\"16\" y=\"28\" font-size=\"17\" fill=\"#1b1f24\">Worst error of each formula on hard cases</text>\n"
    );
    let legend = ["textbook, f32", "engine", "textbook, f64"];
    for ((name, colour), x) in legend.into_iter().zip(COLOURS).zip([LEFT, LEFT + 130.0, LEFT + 220.0]) {
        writeln!(svg, "<circle cx=\"{x}\" cy=\"50\" r=\"4\" fill=\"{colour}\" stroke=\"none\"/>").unwrap();
        text(&mut svg, (x + 10.0, 54.0), "start", INK, name);
    }
    // What the tests allow.
    let gate = across(4.0);
    writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"#eaf4ea\" stroke=\"none\"/>",
        gate - LEFT,
        bottom - TOP
    )
    .unwrap();
    text(&mut svg, (gate - 4.0, bottom + 16.0), "end", "#3d7a45", "gate of the tests: 4");
    for power in AXIS[0] as i32..=AXIS[1] as i32 {
        let x = LEFT + WIDE * (f64::from(power) - AXIS[0]) / (AXIS[1] - AXIS[0]);
        writeln!(svg, "<line x1=\"{x}\" y1=\"{TOP}\" x2=\"{x}\" y2=\"{bottom}\" stroke=\"#d8dce2\"/>")
            .unwrap();
        text(&mut svg, (x, TOP - 7.0), "middle", GREY, &power_of_ten(power));
    }
    let columns = [LEFT + WIDE + 50.0, LEFT + WIDE + 100.0, LEFT + WIDE + 150.0];
    for (x, (name, colour)) in columns.into_iter().zip(["f32", "engine", "f64"].into_iter().zip(COLOURS)) {
        text(&mut svg, (x, TOP - 7.0), "end", colour, name);
    }
    text(&mut svg, (columns[2], TOP - 24.0), "end", GREY, "ns per ray or number");
    for (i, row) in rows.iter().enumerate() {
        let y = TOP + ROW * (i as f64 + 0.5);
        let right = LEFT + WIDE;
        writeln!(svg, "<line x1=\"{LEFT}\" y1=\"{y}\" x2=\"{right}\" y2=\"{y}\" stroke=\"#eef0f3\"/>")
            .unwrap();
        text(&mut svg, (LEFT - 50.0, y + 4.0), "end", INK, row.name);
        text(&mut svg, (LEFT - 10.0, y + 4.0), "end", GREY, row.measure);
        // The engine's on top.
        for k in [2, 0, 1] {
            let (column, colour) = (&row.columns[k], COLOURS[k]);
            let x = across(column.worst);
            writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y}\" r=\"4\" fill=\"{colour}\" stroke=\"none\"/>")
                .unwrap();
            if x >= right && k == 0 {
                text(&mut svg, (x - 9.0, y + 4.0), "end", colour, &short(column.worst));
            }
        }
        for (x, (column, colour)) in columns.into_iter().zip(row.columns.iter().zip(COLOURS)) {
            text(&mut svg, (x, y + 4.0), "end", colour, &format!("{:.1}", column.time));
        }
    }
    svg.push_str("</svg>\n");
    svg
}
