//! What a bench found: as JSON, as tables in Markdown, as a plot, and against an older one.

use super::phases::Phases;
use crate::figures::{deviation, mean, quantile};
use crate::plot::{Axis, COLOURS, Chart, Look, Point, Series, page};
use luc_core::study::Phase;
use serde_json::{Value, json};
use std::fs::{create_dir_all, read_to_string, write};
use std::path::Path;

/// Times of one preset along one part.
pub struct Run {
    /// Name of the part.
    pub part: String,
    /// Name of the preset.
    pub preset: String,
    /// Frames of the part.
    pub frames: Vec<u64>,
    /// Wall clock time of each, ms.
    pub wall: Vec<f64>,
    /// Processor time of each, all threads together, ms.
    pub processor: Vec<f64>,
}

/// All that was measured.
pub struct Report {
    /// Size of the pictures.
    pub size: (u32, u32),
    /// Threads at work.
    pub threads: usize,
    /// Times along the parts.
    pub runs: Vec<Run>,
    /// Times by phase.
    pub phases: Vec<Phases>,
}

/// Figures of a list of times, by name.
fn figures(times: &[f64]) -> [(&'static str, f64); 8] {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    let tenth = sorted.len().div_ceil(10);
    [
        ("mean", mean(times)),
        ("median", quantile(times, 0.5)),
        ("deviation", deviation(times)),
        ("least", quantile(times, 0.0)),
        ("most", quantile(times, 1.0)),
        ("best_tenth", mean(&sorted[..tenth])),
        ("worst_tenth", mean(&sorted[sorted.len() - tenth..])),
        ("percentile_95", quantile(times, 0.95)),
    ]
}

fn object(figures: [(&'static str, f64); 8]) -> Value {
    Value::Object(figures.into_iter().map(|(name, v)| (name.to_string(), json!(v))).collect())
}

/// Reads an older report.
pub fn read(path: &Path) -> Result<Value, String> {
    let text = read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
}

impl Report {
    fn json(&self) -> Value {
        let run = |r: &Run| {
            json!({
                "part": r.part, "preset": r.preset, "frames": r.frames, "wall_ms": r.wall,
                "wall": object(figures(&r.wall)), "processor": object(figures(&r.processor)),
            })
        };
        let phases = |p: &Phases| {
            let spent: serde_json::Map<String, Value> = Phase::ALL
                .iter()
                .zip(&p.spent)
                .map(|((_, name), ms)| (name.to_string(), json!(ms)))
                .collect();
            json!({ "part": p.part, "processor_ms": p.processor, "one_thread_ms": p.one, "all_threads_ms": p.all, "phases_ms": spent })
        };
        json!({
            "width": self.size.0, "height": self.size.1, "threads": self.threads,
            "runs": self.runs.iter().map(run).collect::<Vec<_>>(),
            "phases": self.phases.iter().map(phases).collect::<Vec<_>>(),
        })
    }

    /// Writes the report, and tables and a plot beside it.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let fault = |e: std::io::Error| format!("{}: {e}", path.display());
        if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
            create_dir_all(folder).map_err(fault)?;
        }
        write(path, format!("{:#}\n", self.json())).map_err(fault)?;
        write(path.with_extension("md"), self.text().trim_start()).map_err(fault)?;
        write(path.with_extension("svg"), page(&self.charts(), 2, (560.0, 340.0))).map_err(fault)
    }

    /// Names of the parts.
    fn parts(&self) -> Vec<&str> {
        let mut parts: Vec<&str> = Vec::new();
        for run in &self.runs {
            if !parts.contains(&run.part.as_str()) {
                parts.push(&run.part);
            }
        }
        parts
    }

    fn charts(&self) -> Vec<Chart> {
        let chart = |part: &&str| {
            let mut series = vec![Series {
                name: "60 frames a second".into(),
                colour: "#bbbbbb",
                look: Look::Dashes,
                points: Vec::new(),
            }];
            for (run, colour) in self.runs.iter().filter(|r| r.part == **part).zip(COLOURS) {
                let points = run.frames.iter().zip(&run.wall).map(|(&n, &ms)| Point::at(n as f64 / 60.0, ms));
                series.push(Series {
                    name: run.preset.clone(),
                    colour,
                    look: Look::Line,
                    points: points.collect(),
                });
                if let (Some(&first), Some(&last)) = (run.frames.first(), run.frames.last()) {
                    series[0].points =
                        [first, last].map(|n| Point::at(n as f64 / 60.0, 1000.0 / 60.0)).into();
                }
            }
            let (w, h) = self.size;
            Chart {
                title: format!("{part}, {w}x{h}, {} threads", self.threads),
                x: Axis::linear("second of the part"),
                y: Axis::log("milliseconds a frame"),
                series,
            }
        };
        self.parts().iter().map(chart).collect()
    }

    /// Tables in Markdown.
    pub fn text(&self) -> String {
        let (w, h) = self.size;
        let mut t = format!("\nFrame times at {w}x{h} on {} threads, ms\n\n", self.threads);
        t += "| part | preset | mean | median | deviation | least | most | best 10 % | worst 10 % | 95 % | processor |\n";
        t += "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
        for run in &self.runs {
            let cells: Vec<String> = figures(&run.wall).iter().map(|(_, v)| format!("{v:.1}")).collect();
            t += &format!(
                "| {} | {} | {} | {:.1} |\n",
                run.part,
                run.preset,
                cells.join(" | "),
                quantile(&run.processor, 0.5)
            );
        }
        let names: Vec<&str> = Phase::ALL.iter().map(|p| p.1).collect();
        t += &format!(
            "\nWhere the time goes at the default preset, ms of processor time on one thread, in frames in which smoke takes a step, every other one; idle is of {} threads\n\n",
            self.threads
        );
        t += &format!(
            "| part | {} | rest | processor | one thread | all threads | ratio | idle % |\n",
            names.join(" | ")
        );
        t += &format!("|---|{}---:|---:|---:|---:|---:|---:|\n", "---:|".repeat(names.len()));
        for p in &self.phases {
            let cells: Vec<String> = p.spent.iter().map(|v| format!("{v:.1}")).collect();
            let rest = (p.processor - p.spent.iter().sum::<f64>()).max(0.0);
            let idle = (100.0 * (1.0 - p.one / (p.all * self.threads as f64))).max(0.0);
            t += &format!(
                "| {} | {} | {rest:.1} | {:.1} | {:.1} | {:.1} | {:.2} | {idle:.0} |\n",
                p.part,
                cells.join(" | "),
                p.processor,
                p.one,
                p.all,
                p.one / p.all
            );
        }
        t
    }

    /// Ratios of new to old times, for what both reports hold.
    pub fn compared(&self, old: &Value) -> String {
        let mut t = String::from("\nNew over old: under 1 is faster\n\n");
        if old["width"] != json!(self.size.0)
            || old["height"] != json!(self.size.1)
            || old["threads"] != json!(self.threads)
        {
            t += &format!(
                "The old run was made at {}x{} on {} threads, so the ratios mean little.\n\n",
                old["width"], old["height"], old["threads"]
            );
        }
        t += "| part | preset | mean | median | 95 % | processor, median |\n|---|---|---:|---:|---:|---:|\n";
        let runs = old["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
        for run in &self.runs {
            let Some(old) =
                runs.iter().find(|o| o["part"] == run.part.as_str() && o["preset"] == run.preset.as_str())
            else {
                continue;
            };
            let ratio = |times: &[f64], kind: &str, name: &str| {
                let new = figures(times).into_iter().find(|f| f.0 == name).map_or(f64::NAN, |f| f.1);
                format!("{:.3}", new / old[kind][name].as_f64().unwrap_or(f64::NAN))
            };
            let wall = ["mean", "median", "percentile_95"].map(|name| ratio(&run.wall, "wall", name));
            let processor = ratio(&run.processor, "processor", "median");
            t += &format!("| {} | {} | {} | {processor} |\n", run.part, run.preset, wall.join(" | "));
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(factor: f64) -> Report {
        let wall: Vec<f64> = (1..=20).map(|i| f64::from(i) * factor).collect();
        Report {
            size: (64, 36),
            threads: 2,
            runs: vec![Run {
                part: "mirror".into(),
                preset: "high".into(),
                frames: (0..20).collect(),
                processor: wall.clone(),
                wall,
            }],
            phases: vec![Phases {
                part: "mirror".into(),
                spent: vec![0.75; Phase::ALL.len()],
                processor: 6.5,
                one: 7.0,
                all: 4.0,
            }],
        }
    }

    #[test]
    fn tenths_are_means_of_the_two_best_and_worst_of_twenty() {
        let found = figures(&report(1.0).runs[0].wall);
        let of = |name| found.iter().find(|f| f.0 == name).unwrap().1;
        assert_eq!((of("best_tenth"), of("worst_tenth"), of("median"), of("most")), (1.5, 19.5, 10.5, 20.0));
    }

    #[test]
    fn a_report_is_read_again_and_compared() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/bench.json");
        report(2.0).write(&path).unwrap();
        let old = read(&path).unwrap();
        let text = report(1.0).compared(&old);
        assert!(text.contains("| mirror | high | 0.500 | 0.500 | 0.500 | 0.500 |"), "{text}");
        assert!(path.with_extension("svg").is_file());
        let other = Report { threads: 1, ..report(1.0) };
        assert!(other.compared(&old).contains("mean little"));
        write(&path, "{").unwrap();
        assert!(read(&path).is_err());
    }

    #[test]
    fn idle_is_what_threads_lose() {
        // Two threads for 4 ms do 7 ms of work: an eighth is lost.
        let text = report(1.0).text();
        assert!(text.contains("| 0.5 | 6.5 | 7.0 | 4.0 | 1.75 | 12 |"), "{text}");
    }
}
