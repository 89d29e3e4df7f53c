//! How the size came about: a line for each commit, in a table and in a drawing.
//!
//! `cargo pack --history` adds the commit that is checked out to `docs/size-history.csv`, or replaces its line,
//! and draws `docs/size-history.svg` anew: the program before and after packing over commits, the limit as a line.

use super::{LIMIT, Report};
use crate::Error;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

const HEAD: &str = "commit,date,linked,stripped,payload,launcher,total\n";

/// Adds the sizes of the commit that is checked out in `root`.
pub fn record(root: &Path, report: &Report) -> Result<(), Error> {
    let output = Command::new("git").args(["log", "-1", "--format=%h,%cs"]).current_dir(root).output();
    let commit = output.ok().filter(|output| output.status.success());
    let commit = commit.and_then(|output| String::from_utf8(output.stdout).ok());
    let commit = commit.ok_or(Error::Command("git doesn't tell which commit this is".to_owned()))?;
    let (table, drawing) = (root.join("docs/size-history.csv"), root.join("docs/size-history.svg"));
    let text = with(&std::fs::read_to_string(&table).unwrap_or_default(), commit.trim(), report);
    std::fs::write(&drawing, draw(&points(&text))).map_err(Error::file(&drawing))?;
    std::fs::write(&table, text).map_err(Error::file(&table))
}

/// The table with one more line, or with that of the last commit replaced.
fn with(table: &str, commit: &str, report: &Report) -> String {
    let name = commit.split(',').next().unwrap_or_default();
    let mut text = String::from(HEAD);
    for line in table.lines().skip(1).filter(|line| line.split(',').next() != Some(name)) {
        let _ = writeln!(text, "{line}");
    }
    let Report { linked, stripped, payload, launcher, total, .. } = report;
    let _ = writeln!(text, "{commit},{linked},{stripped},{payload},{launcher},{total}");
    text
}

/// What the drawing shows of a commit.
#[derive(Debug, PartialEq)]
struct Point<'a> {
    commit: &'a str,
    date: &'a str,
    stripped: usize,
    total: usize,
}

fn points(table: &str) -> Vec<Point<'_>> {
    let point = |line| {
        let columns: Vec<&str> = str::split(line, ',').collect();
        let [commit, date, _, stripped, _, _, total] = columns[..] else { return None };
        Some(Point { commit, date, stripped: stripped.parse().ok()?, total: total.parse().ok()? })
    };
    table.lines().skip(1).filter_map(point).collect()
}

/// Curves of the sizes before and after packing from left to right, 0 at the bottom, the limit as a dashed line.
fn draw(points: &[Point]) -> String {
    const WIDTH: f64 = 760.0;
    const HEIGHT: f64 = 240.0;
    let largest = points.iter().map(|point| point.stripped.max(point.total)).max();
    let top = LIMIT.max(largest.unwrap_or(0)) as f64 * 1.05;
    let y = |bytes: usize| HEIGHT - bytes as f64 / top * HEIGHT;
    let x = |i: usize| WIDTH * (i as f64 + 0.5) / points.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-10 -20 780 290\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <title>Size of the intro by commit, bytes, before and after packing</title>\n\
         <rect x=\"-10\" y=\"-20\" width=\"780\" height=\"290\" fill=\"#fff\"/>\n\
         <path d=\"M0 {HEIGHT}H{WIDTH}\" stroke=\"#999\"/>\n\
         <path d=\"M0 {0:.1}H{WIDTH}\" stroke=\"#b33\" stroke-dasharray=\"6 4\"/>\n\
         <text x=\"0\" y=\"{1:.1}\" fill=\"#b33\">{LIMIT}</text>\n",
        y(LIMIT),
        y(LIMIT) - 6.0,
    );
    let stripped: Vec<usize> = points.iter().map(|point| point.stripped).collect();
    let totals: Vec<usize> = points.iter().map(|point| point.total).collect();
    for (name, colour, curve) in [("program", "#888", stripped), ("packed", "#236", totals)] {
        let places = curve.iter().enumerate();
        let places: Vec<_> = places.map(|(i, &bytes)| format!("{:.1},{:.1}", x(i), y(bytes))).collect();
        let last = curve.last().copied().unwrap_or(0);
        let _ = write!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n\
             <text x=\"{WIDTH}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"{colour}\">{name} {last}</text>\n",
            places.join(" "),
            y(last) + 16.0,
        );
    }
    for (point, at, anchor) in [(points.first(), 0.0, "start"), (points.last(), WIDTH, "end")] {
        let Some(Point { commit, date, .. }) = point else { continue };
        let _ = writeln!(
            svg,
            "<text x=\"{at}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"#666\">{commit}, {date}</text>",
            HEIGHT + 18.0
        );
    }
    svg.push_str("</svg>\n");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    const REPORT: Report = Report { linked: 5, stripped: 4, payload: 2, launcher: 1, total: 3, limit: 3 };

    #[test]
    fn a_commit_has_one_line() {
        let one = with("", "abc,2001-02-03", &REPORT);
        assert_eq!(one, format!("{HEAD}abc,2001-02-03,5,4,2,1,3\n"));
        let two = with(&one, "def,2001-02-04", &Report { total: 7, ..REPORT });
        let totals = |table: &str| points(table).iter().map(|point| point.total).collect::<Vec<_>>();
        assert_eq!(totals(&two), [3, 7]);
        assert_eq!(totals(&with(&two, "abc,2001-02-03", &Report { total: 9, ..REPORT })), [7, 9]);
        assert_eq!(points(&one), [Point { commit: "abc", date: "2001-02-03", stripped: 4, total: 3 }]);
    }

    #[test]
    fn the_limit_is_drawn_below_what_exceeds_it() {
        let point = |total| Point { commit: "abc", date: "2001-02-03", stripped: 0, total };
        let drawing = draw(&[point(LIMIT), point(2 * LIMIT)]);
        assert!(drawing.contains("points=\"190.0,125.7 570.0,11.4\""), "{drawing}");
        assert!(drawing.contains("M0 125.7H760") && drawing.contains(">packed 131072<"), "{drawing}");
        let ends = ["\"start\"", "\"end\""].map(|end| format!("text-anchor={end} fill=\"#666\">abc, 2001"));
        assert!(ends.iter().all(|end| drawing.contains(end)), "{drawing}");
        assert!(draw(&[]).ends_with("</svg>\n"));
    }
}
