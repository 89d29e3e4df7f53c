//! The table as Markdown.

use super::{Column, Row};
use std::fmt::Write;

/// A number with a raised exponent of 0 or more.
pub fn raised(base: &str, power: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let power = power.to_string();
    let up = power.bytes().filter_map(|b| digits.get(usize::from(b.wrapping_sub(b'0'))));
    base.chars().chain(up.copied()).collect()
}

/// Three digits at most, or a power of ten.
pub fn short(x: f64) -> String {
    if x.is_infinite() {
        "∞".into()
    } else if x >= 1e4 {
        let text = format!("{x:.0e}");
        let (digit, power) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{digit}·{}", raised("10", power.parse().unwrap_or(0)))
    } else if x >= 100.0 {
        format!("{x:.0}")
    } else if x >= 10.0 {
        format!("{x:.1}")
    } else {
        format!("{x:.2}")
    }
}

fn failures(column: &Column) -> String {
    format!("{}/{}", column.lost, column.invented)
}

/// A row for the terminal.
pub fn line(row: &Row) -> String {
    let mut text = format!("{:24} {:6}", row.name, row.measure);
    for column in &row.columns {
        let (worst, usual) = (short(column.worst), short(column.usual));
        write!(text, " | {worst:>9} {usual:>9} {:>11} {:>6.2} ns", failures(column), column.time).unwrap();
    }
    text
}

/// What f32 and f64 come to, comma separated: the worst error, and the time, of each form.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "formula,error in,textbook f32,engine,textbook f64,ns f32,ns engine,ns f64,engine's time over f64's\n",
    );
    for row in rows {
        let [naive, ours, wide] = &row.columns;
        let worst = [naive, ours, wide].map(|c| short(c.worst)).join(",");
        let time = [naive.time, ours.time, wide.time, ours.time / wide.time].map(|t| format!("{t:.2}"));
        writeln!(text, "{},{},{worst},{}", row.name, row.measure, time.join(",")).unwrap();
    }
    text
}

/// The whole page.
pub fn page(rows: &[Row]) -> String {
    let mut text = String::from(HEAD);
    for row in rows {
        let [naive, ours, wide] = &row.columns;
        let cell = |c: &Column| format!("{} ({})", short(c.worst), short(c.usual));
        let shape = row.measure == "score" || row.columns.iter().any(|c| c.lost + c.invented > 0);
        let lost = if shape { [naive, ours, wide].map(failures).join(", ") } else { String::new() };
        writeln!(
            text,
            "| {} | {} | {} | **{}** | {} | {} | {:.1} | {:.1} | {:.1} |",
            row.name,
            row.measure,
            cell(naive),
            cell(ours),
            cell(wide),
            lost,
            naive.time,
            ours.time,
            wide.time
        )
        .unwrap();
    }
    let cases = rows.iter().map(|r| r.cases).max().unwrap_or(0);
    write!(text, "\n{cases} cases a row; made by `cargo lab numbers`.\n").unwrap();
    text
}

const HEAD: &str = "\
# What the numbers hold

Each formula of the engine beside the form that textbooks have, in f32 and in f64, on hard cases drawn at random:
rays that graze, run along an axis or begin on a surface, bodies of 0.0001 to 1000 seen from up to 10,000 times their
size, angles at 0, 90° and the critical angle, mirrors and media with peaks as narrow as 0.0001. The truth is computed in
f64 in a form that doesn't cancel.

![Worst errors](numbers.svg)

- **score**: the error of the nearest crossing in front of the ray over what moving the surface by u (distance + size),
  u = 2⁻²⁴, changes in the exact one, or over half an ulp where that is more. What f32 must lose by rounding the ray alone
  scores about 1; the gate of the tests is 4.
- **ulp**: the error in units of the last digit of the exact result; the gate is 4.
- **u**: the error over u times the problem's condition, such as the size of the arguments.
- Worst error first, in brackets what 99 of 100 cases are within. ∞: not a number, or infinite, where the result is neither.
- **lost/invented**: hits missing though the shape is hit even if smaller by four such units, and hits found though it is
  missed even if so much larger.
- **ns**: nanoseconds per ray or number in packets of eight (f64: four), all three forms alike, one thread. Differences under a
  third are noise on a machine that does other things too. \"extinction\" is 1024 steps, the walk 127. Elementary
  functions are called one number at a time, but for those \"of eight\", for frames, which give up a digit for their speed.
- Of GGX's and Beckmann's D, and of refraction, the engine's column is that of its packets; one at a time, by
  `luc_core::kernels`, they are within an ulp.

| formula | in | textbook f32 | engine | textbook f64 | lost/invented: f32, engine, f64 | ns f32 | ns engine | ns f64 |
|---|---|---:|---:|---:|---|---:|---:|---:|
";
