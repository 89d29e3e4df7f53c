//! The plots of the study.

use super::front::{Averaged, averaged, front};
use super::growth::exponent;
use super::knob::{BASE, Knob, On};
use super::page::Data;
use super::table::{Figure, Row};
use crate::plot::{Axis, COLOURS, Chart, Look, Point, Series, draw, page};
use std::fs::write as write_file;
use std::path::Path;

const TIME: &str = "milliseconds a frame on one core";
const FLIP: &str = "mean FLIP error against the truth";
const FRONT: &str = "#bbbbbb";
const PRESETS: &str = "#c0182b";

/// Writes all plots into a folder.
pub fn write(data: &Data, out: &Path) -> Result<(), String> {
    let save = |name: &str, text: String| {
        let path = out.join(name);
        write_file(&path, text).map_err(|e| format!("{}: {e}", path.display()))
    };
    let all = averaged(data.common_rows());
    save("front.svg", draw(&front_chart("All parts", &all, Figure::Flip, FLIP), (860.0, 520.0)))?;
    for (name, figure, label) in [
        ("front-rmse.svg", Figure::Rmse, "root mean square error in linear light"),
        ("front-flicker.svg", Figure::Flicker, "flicker: error of frame differences"),
    ] {
        save(name, draw(&front_chart("All parts", &all, figure, label), (860.0, 460.0)))?;
    }
    let parts: Vec<Chart> = data
        .parts()
        .iter()
        .map(|part| {
            front_chart(part, &averaged(data.show_rows().filter(|r| r.part == *part)), Figure::Flip, FLIP)
        })
        .collect();
    save("parts.svg", page(&parts, 2, (560.0, 380.0)))?;
    for knob in &data.knobs {
        save(&format!("knob-{}.svg", knob.name), knob_charts(data, knob))?;
    }
    save("resolution.svg", growth_charts(data))
}

/// A point of an averaged setting, with the quartiles of its times.
fn point(a: &Averaged, figure: Figure) -> Point {
    Point {
        spread: Some((a.mean(Figure::MsLow), a.mean(Figure::MsHigh))),
        label: a.value.clone(),
        ..Point::at(a.mean(Figure::Ms), a.mean(figure))
    }
}

/// All settings, the front, and the presets by name.
fn front_chart(title: &str, all: &[Averaged], figure: Figure, label: &str) -> Chart {
    let named = |a: &&Averaged| a.knob == "preset";
    let plain = |a: &Averaged| Point::at(a.mean(Figure::Ms), a.mean(figure));
    let places: Vec<(f64, f64)> = all.iter().map(|a| (a.mean(Figure::Ms), a.mean(figure))).collect();
    // What the front owes to single knobs is named too.
    let line = front(&places);
    let mark = |&i: &usize| {
        let a = &all[i];
        let label = if a.knob == "preset" { String::new() } else { format!("{} {}", a.knob, a.value) };
        Point { label, ..plain(a) }
    };
    Chart {
        title: title.into(),
        x: Axis::log(TIME),
        y: Axis::log(label),
        series: vec![
            Series {
                name: format!("one knob of {BASE} turned"),
                colour: "#7aa6c2",
                look: Look::Dots,
                points: all.iter().filter(|a| a.knob != "preset").map(plain).collect(),
            },
            Series {
                name: "Pareto front".into(),
                colour: "#555555",
                look: Look::Dashes,
                points: line.iter().map(mark).collect(),
            },
            Series {
                name: String::new(),
                colour: FRONT,
                look: Look::Line,
                points: all.iter().filter(named).map(plain).collect(),
            },
            Series {
                name: "presets".into(),
                colour: PRESETS,
                look: Look::Marks,
                points: all
                    .iter()
                    .filter(named)
                    .map(|a| Point { spread: None, ..point(a, figure) })
                    .collect(),
            },
        ],
    }
}

/// Rows of a knob.
fn rows_of<'a>(data: &'a Data, knob: &Knob) -> impl Iterator<Item = &'a Row> {
    let name = knob.name;
    data.rows.iter().filter(move |r| r.knob == name)
}

/// A knob's error over time: each part, and the mean of all.
fn knob_charts(data: &Data, knob: &Knob) -> String {
    if knob.on == On::Fireflies || rows_of(data, knob).all(|r| r.get(Figure::Flip).is_nan()) {
        return draw(&work_chart(data, knob), (560.0, 380.0));
    }
    let chart = |figure, label: &str| {
        let parts = data.parts();
        let mut series: Vec<Series> = parts
            .iter()
            .zip(COLOURS.iter().cycle())
            .map(|(part, colour)| Series {
                name: part.clone(),
                colour,
                look: Look::Path,
                points: averaged(rows_of(data, knob).filter(|r| r.part == *part))
                    .iter()
                    .map(|a| Point { label: String::new(), ..point(a, figure) })
                    .collect(),
            })
            .collect();
        series.push(Series {
            name: "mean of all".into(),
            colour: "#000000",
            look: Look::Path,
            points: averaged(rows_of(data, knob))
                .iter()
                .map(|a| Point { spread: None, ..point(a, figure) })
                .collect(),
        });
        Chart { title: knob.title.into(), x: Axis::log(TIME), y: Axis::log(label), series }
    };
    let second = if knob.samples {
        chart(Figure::Flicker, "flicker: error of frame differences")
    } else {
        chart(Figure::Rmse, "root mean square error in linear light")
    };
    page(&[chart(Figure::Flip, FLIP), Chart { title: String::new(), ..second }], 2, (560.0, 380.0))
}

/// A knob that doesn't change the picture: time and steps over its positions.
fn work_chart(data: &Data, knob: &Knob) -> Chart {
    let settings = averaged(rows_of(data, knob));
    let place = |a: &Averaged, figure| {
        let at = a.value.parse().unwrap_or(f64::NAN);
        Point { label: a.value.clone(), spread: None, ..Point::at(at, a.mean(figure)) }
    };
    Chart {
        title: knob.title.into(),
        x: Axis::log(knob.title),
        y: Axis::log(TIME),
        series: vec![Series {
            name: String::new(),
            colour: COLOURS[0],
            look: Look::Path,
            points: settings.iter().map(|a| place(a, Figure::Ms)).collect(),
        }],
    }
}

/// Time and rays over the size of the picture, with the exponents of growth.
fn growth_charts(data: &Data) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for point in &data.growth {
        if !parts.contains(&point.part.as_str()) {
            parts.push(&point.part);
        }
    }
    let chart = |title: &str, label: &str, value: fn(&super::growth::Point) -> f64| {
        let of = |(part, colour): (&&str, &'static str)| Series {
            name: format!("{part}: pixels^{:.2}", exponent(&data.growth, part, value).0),
            colour,
            look: Look::Path,
            points: data
                .growth
                .iter()
                .filter(|p| p.part == **part)
                .map(|p| Point::at(p.pixels(), value(p)))
                .collect(),
        };
        let series = parts.iter().zip(COLOURS).map(of).collect();
        Chart { title: title.into(), x: Axis::log("pixels of the picture"), y: Axis::log(label), series }
    };
    page(
        &[
            chart(&format!("Cost over size, {BASE}, 320x180 to 3840x2160"), TIME, |p| p.ms),
            chart("", "rays of all kinds", |p| p.rays),
        ],
        2,
        (560.0, 420.0),
    )
}
