//! The page that ties the study together: plots, tables, pictures. It needs no network and no scripts.

use super::front::{Averaged, averaged};
use super::growth::Point;
use super::knob::{BASE, Knob, On};
use super::pictures::{FOLDER, SHOWN, file_name, mapped};
use super::table::{Figure, Row};
use luc_core::quality::Quality;
use std::fs::write as write_file;
use std::path::Path;

/// What was measured.
pub struct Data {
    /// All rows.
    pub rows: Vec<Row>,
    /// Under what conditions.
    pub conditions: String,
    /// The knobs, with their words.
    pub knobs: Vec<Knob>,
    /// Cost over size.
    pub growth: Vec<Point>,
    /// Formulas in f32 and f64, comma separated.
    pub numbers: String,
}

impl Data {
    /// Rows that compare the show as it is with its truth.
    pub fn show_rows(&self) -> impl Iterator<Item = &Row> {
        let shown =
            |row: &Row| self.knobs.iter().any(|k| k.name == row.knob && k.truth == super::Truth::Show);
        self.rows.iter().filter(move |row| shown(row) && row.get(Figure::Flip).is_finite())
    }

    /// Those of knobs that all parts have, so that means over all parts can be compared.
    pub fn common_rows(&self) -> impl Iterator<Item = &Row> {
        let common = |row: &Row| self.knobs.iter().any(|k| k.name == row.knob && k.on == On::Show);
        self.show_rows().filter(move |row| common(row))
    }

    /// Names of the parts, in the order of the rows.
    pub fn parts(&self) -> Vec<String> {
        let mut parts: Vec<String> = Vec::new();
        for row in self.show_rows() {
            if !parts.contains(&row.part) {
                parts.push(row.part.clone());
            }
        }
        parts
    }

    fn of<'a>(&'a self, knob: &'a str) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |r| r.knob == knob)
    }
}

const STYLE: &str = "\
body{font:16px/1.5 Helvetica,Arial,sans-serif;color:#222;max-width:1160px;margin:0 auto;padding:1em;background:#fff}\
h1{margin-bottom:0}h2{margin-top:2.2em;border-bottom:1px solid #ccc}h3{margin:1.8em 0 .2em}p{max-width:46em}\
img{max-width:100%;height:auto}table{border-collapse:collapse;font-size:13px;margin:.6em 0}\
td,th{padding:.15em .7em;text-align:right;border-bottom:1px solid #e4e4e4;font-variant-numeric:tabular-nums}\
td:first-child,th:first-child{text-align:left}tr.base td{font-weight:bold}\
.row{display:flex;flex-wrap:wrap;gap:6px}.row figure{margin:0;font-size:12px;color:#555}\
.row img{display:block;width:222px;background:#000}nav a{margin-right:.8em}code{background:#f3f3f3;padding:0 .2em}";

/// Columns of tables: a figure, its head, its digits after the point, and a factor.
const COLUMNS: [(Figure, &str, usize, f64); 12] = [
    (Figure::Ms, "ms", 1, 1.0),
    (Figure::Rays, "rays, M", 2, 1e-6),
    (Figure::Steps, "steps, M", 1, 1e-6),
    (Figure::Traced, "traced %", 1, 1.0),
    (Figure::Interpolated, "between %", 1, 1.0),
    (Figure::Filled, "filled %", 1, 1.0),
    (Figure::Psnr, "PSNR dB", 1, 1.0),
    (Figure::Ssim, "SSIM", 4, 1.0),
    (Figure::Flip, "FLIP", 4, 1.0),
    (Figure::Greatest, "greatest", 2, 1.0),
    (Figure::PsnrOfSampling, "sampling dB", 1, 1.0),
    (Figure::Flicker, "flicker, of 255", 2, 255.0),
];

/// A table of settings, one a row; the position that stands in the base preset is bold.
fn table(first: &str, settings: &[Averaged], base: &str) -> String {
    let filled = |figure| settings.iter().any(|a| a.mean(figure).is_finite());
    let columns: Vec<_> = COLUMNS.into_iter().filter(|c| filled(c.0)).collect();
    let heads: String = columns.iter().map(|c| format!("<th>{}</th>", c.1)).collect();
    let mut out = format!("<table><tr><th>{first}</th>{heads}</tr>\n");
    for a in settings {
        let class = if a.value == base { " class=\"base\"" } else { "" };
        out += &format!("<tr{class}><td>{}</td>", a.value);
        for &(figure, _, digits, factor) in &columns {
            let mean = a.mean(figure) * factor;
            out +=
                &if mean.is_finite() { format!("<td>{mean:.digits$}</td>") } else { "<td>–</td>".into() };
        }
        out += "</tr>\n";
    }
    out + "</table>\n"
}

fn image(file: &str, words: &str) -> String {
    format!("<img src=\"{file}\" alt=\"{words}\" loading=\"lazy\">\n")
}

fn figure(part: &str, what: &str, words: &str) -> String {
    let file = format!("{FOLDER}/{part}-{}.png", file_name(what));
    format!(
        "<figure>{}<figcaption>{words}</figcaption></figure>\n",
        image(&file, &format!("{part}, {words}"))
    )
}

/// Writes the page into a study's folder.
pub fn write(data: &Data, out: &Path) -> Result<(), String> {
    let path = out.join("index.html");
    write_file(&path, text(data)).map_err(|e| format!("{}: {e}", path.display()))
}

fn text(data: &Data) -> String {
    let parts = data.parts();
    let mut t = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Lúč: what accuracy costs in time</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head><body>\n\
         <h1>What accuracy costs in time</h1>\n\
         <p>Every part of the show, drawn under every position of every knob alone and under the six presets, \
         against a truth that traces every pixel many times over. Made by <code>cargo lab accuracy</code>; all \
         figures are in <a href=\"study.csv\">study.csv</a> and <a href=\"resolution.csv\">resolution.csv</a>.</p>\n\
         <nav><a href=\"#presets\">Presets</a><a href=\"#knobs\">Knobs</a><a href=\"#size\">Size</a>\
         <a href=\"#numbers\">f32 and f64</a><a href=\"#pictures\">Pictures</a><a href=\"#how\">How it was measured</a></nav>\n\
         <h2 id=\"presets\">Presets and the front</h2>\n\
         <p>Lower is closer to the truth, further left is faster. The dashed line joins what no other setting \
         beats in both; its labels name the knob and the position. Small dots: the preset {BASE} with one knob \
         turned.</p>\n"
    );
    t += &image("front.svg", "Error over time of all settings, mean of all parts");
    t += &table("preset", &averaged(data.of("preset")), BASE);
    t += &format!(
        "<p>How near the presets are to the front: what of all that was measured, presets or {BASE} with one knob \
         turned, is fastest at no more than a preset's error, and most exact in no more than its time.</p>\n"
    );
    t += &choice(data);
    t += "<p>By the root mean square error in linear light, and by flicker:</p>\n";
    t += &image("front-rmse.svg", "Root mean square error over time");
    t += &image("front-flicker.svg", "Flicker over time");
    t += "<h3>Each part</h3>\n";
    t += &image("parts.svg", "Error over time of all settings, part by part");
    for part in &parts {
        t += &table(part, &averaged(data.of("preset").filter(|r| r.part == *part)), BASE);
    }
    t += "<h2 id=\"knobs\">Knobs</h2>\n<p>Each turned alone, all else as in ";
    t += &format!("<code>{BASE}</code>, whose position is bold. Tables: means over all parts and frames. ");
    t += "Thin bars in the plots: quartiles of the times.</p>\n";
    for knob in data.knobs.iter().filter(|k| k.name != "preset") {
        t += &format!(
            "<h3 id=\"{}\">{}</h3>\n<p>{} {}</p>\n",
            knob.name,
            knob.title,
            knob.words.replace('`', ""),
            knob.on.words()
        );
        let settings = averaged(data.of(knob.name));
        if settings.is_empty() {
            t += "<p>Not measured in this run.</p>\n";
            continue;
        }
        t += &image(&format!("knob-{}.svg", knob.name), &format!("{}: error over time", knob.title));
        t += &table(if knob.on == On::Fireflies { "px" } else { "position" }, &settings, &knob.base);
        if knob.name == "shading" {
            for part in &parts {
                let rung = |s: &super::knob::Setting| figure(part, &s.label, &s.label);
                let rungs: String = knob.settings.iter().map(rung).collect();
                t += &format!("<p>{part}</p><div class=\"row\">{rungs}</div>\n");
            }
        }
    }
    t += "<h2 id=\"size\">Cost over the size of the picture</h2>\n\
          <p>The middle frame of each part. An exponent of 1 would be in step with the number of pixels; the \
          coarsest cell doubles over 720 and over 1440 lines.</p>\n";
    t += &image("resolution.svg", "Time and rays over the number of pixels");
    if !data.numbers.is_empty() {
        t += "<h2 id=\"numbers\">f32 against f64</h2>\n\
              <p>Each formula on hard cases: the worst error of the textbook's form in f32, of the engine's, and of the \
              textbook's in f64, and nanoseconds per ray or number in packets. Units are those of \
              <code>cargo lab numbers</code>: about 1 is what f32 can't but lose. Where the engine's time is under \
              that of f64, f64 everywhere would cost more and hold less than a form that doesn't cancel.</p>\n";
        t += &image(crate::numbers::PLOT, "Worst errors of each formula in f32 and f64");
        t += &commas(&data.numbers);
    }
    t += "<h2 id=\"pictures\">Pictures and error maps</h2>\n\
          <p>The middle frame of each part at 320x180 px. Maps show FLIP from black (no visible difference) over \
          purple to light yellow (1).</p>\n";
    for part in &parts {
        t += &format!("<h3>{part}</h3><div class=\"row\">\n");
        t += &SHOWN.map(|preset| figure(part, preset, preset)).concat();
        t += &figure(part, "truth", "truth");
        t += "</div><div class=\"row\">\n";
        t += &mapped()
            .map(|(p, _)| figure(part, &format!("{p}-error"), &format!("{p}: error")))
            .collect::<String>();
        t += "</div>\n";
    }
    t + &how(data) + "</body></html>\n"
}

/// A table of what stands between commas, the first line its heads.
fn commas(text: &str) -> String {
    let row = |(i, line): (usize, &str)| {
        let kind = if i == 0 { "th" } else { "td" };
        let cells: String = line.split(',').map(|cell| format!("<{kind}>{cell}</{kind}>")).collect();
        format!("<tr>{cells}</tr>\n")
    };
    format!("<table>{}</table>\n", text.lines().enumerate().map(row).collect::<String>())
}

/// What nothing beats, beside each preset: how long the front takes to its error, and the error at its time.
fn choice(data: &Data) -> String {
    let all = averaged(data.common_rows());
    let place = |a: &Averaged| (a.mean(Figure::Ms), a.mean(Figure::Flip));
    let mut t = String::from(
        "<table><tr><th>preset</th><th>ms</th><th>FLIP</th><th>least ms at this error</th><th>by</th>\
         <th>least FLIP in this time</th><th>by</th></tr>\n",
    );
    for a in all.iter().filter(|a| a.knob == "preset" && place(a).1.is_finite()) {
        let (ms, flip) = place(a);
        let name = |a: &Averaged| {
            if a.knob == "preset" { a.value.clone() } else { format!("{} {}", a.knob, a.value) }
        };
        let least = |within: &dyn Fn(&Averaged) -> bool, what: fn((f64, f64)) -> f64| {
            all.iter().filter(|a| within(a)).min_by(|a, b| what(place(a)).total_cmp(&what(place(b))))
        };
        let fast = least(&|a| place(a).1 <= flip, |p| p.0).unwrap_or(a);
        let exact = least(&|a| place(a).0 <= ms, |p| p.1).unwrap_or(a);
        t += &format!(
            "<tr><td>{}</td><td>{ms:.1}</td><td>{flip:.4}</td><td>{:.1}</td><td>{}</td><td>{:.4}</td><td>{}</td></tr>\n",
            a.value,
            place(fast).0,
            name(fast),
            place(exact).1,
            name(exact)
        );
    }
    t + "</table>\n"
}

fn how(data: &Data) -> String {
    let [.., (reference, _)] = Quality::PRESETS;
    let frames = |part: &String| {
        let mut frames: Vec<u64> = data.show_rows().filter(|r| r.part == *part).map(|r| r.frame).collect();
        frames.sort_unstable();
        frames.dedup();
        format!("{part} {frames:?}")
    };
    let frames = data.parts().iter().map(frames).collect::<Vec<_>>().join(", ");
    format!(
        "<h2 id=\"how\">How it was measured</h2>\n<p>Conditions: {}. Frames: {frames}.</p>\n\
         <p>A modest size, so that the study takes minutes; the plot over sizes tells how to go on from there. \
         Times are processor time, which the machine's other work disturbs little, as medians of passes in \
         which all settings take turns. Rays and steps are counted and don't depend on the machine.</p>\n\
         <p>The truth is <code>{reference}</code> with more samples of every pixel than its own 16, \
         so that <code>{reference}</code> itself has an error; for flicker and for the reflection models it is \
         <code>{reference}</code>, and for the motion of smoke {BASE} on a grid of twice the resolution. Presets without edge samples differ from it by the stairs at edges more than by \
         anything else: the column <i>sampling dB</i> is the PSNR against the same setting with every pixel \
         traced, in display values. Means over parts are geometric for times, counts and errors, so that \
         no part outweighs the others.</p>\n\
         <p>RMSE and PSNR are those of linear light from 0 to 1, decoded from the finished 8-bit picture. SSIM \
         is of luma, FLIP at 67 pixels per degree, <i>greatest</i> the greatest difference of a channel's \
         display value, <i>flicker</i> the root mean square of the difference between the change from frame to \
         frame and the true change, in display values. Film grain and overlays are switched off.</p>\n",
        data.conditions.trim_start_matches("# ")
    )
}
