//! `lab accuracy`: what accuracy costs in time.
//!
//! Every part of the show, several frames each, is drawn under every position of every knob of
//! [`Quality`] alone and under the six presets. Times are the median of interleaved passes in
//! processor time, errors are against `reference` with 64 samples of every pixel. Rows go to a CSV
//! file as they are found, so that an interruption keeps them and the next run goes on; plots,
//! pictures and a page are made from it.

mod front;
mod growth;
mod knob;
mod knobs;
mod measure;
mod page;
mod pictures;
mod plots;
mod table;

use crate::metric::Picture;
use crate::numbers;
use crate::progress::Progress;
use crate::subject::Subject;
use knob::{Change, Knob, On, Truth};
use knobs::knobs;
use lexopt::prelude::*;
use luc_core::math::fingerprint::Fingerprint;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use measure::{Effort, Task};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::{Path, PathBuf};
use table::{Figure, Row, Table};

/// What the command was asked for.
struct Options {
    quick: bool,
    fresh: bool,
    /// Draw plots and page from what was measured before.
    pages_only: bool,
    /// Keep times and counts and tell errors again.
    errors_only: bool,
    /// Measure flicker.
    flicker: bool,
    /// Frames of each part.
    frames: Option<u64>,
    out: Option<PathBuf>,
    part: Option<String>,
    threads: usize,
    size: Option<(u32, u32)>,
}

/// Frames of each part that are measured.
const FRAMES: u64 = 2;

/// Where the committed study lies, and where that of `--quick`.
const OUT: &str = "docs/accuracy";
const QUICK_OUT: &str = "target/accuracy";

fn options(args: &[String]) -> Result<Options, lexopt::Error> {
    let mut parser = lexopt::Parser::from_args(args);
    let mut options = Options {
        quick: false,
        fresh: false,
        pages_only: false,
        errors_only: false,
        flicker: true,
        frames: None,
        out: None,
        part: None,
        threads: 1,
        size: None,
    };
    while let Some(arg) = parser.next()? {
        match arg {
            Long("quick") => options.quick = true,
            Long("fresh") => options.fresh = true,
            Long("pages") => options.pages_only = true,
            Long("errors") => options.errors_only = true,
            Long("no-flicker") => options.flicker = false,
            Long("frames") => options.frames = Some(parser.value()?.parse_with(crate::args::count)?.into()),
            Long("out") => options.out = Some(parser.value()?.into()),
            Long("part") => options.part = Some(parser.value()?.parse()?),
            Long("threads") => options.threads = parser.value()?.parse()?,
            Long("size") => options.size = Some(parser.value()?.parse_with(crate::args::size)?),
            _ => return Err(arg.unexpected()),
        }
    }
    Ok(options)
}

/// The study: its subjects, knobs and effort.
struct Study {
    subjects: Vec<Subject>,
    knobs: Vec<Knob>,
    effort: Effort,
    frames: u64,
    quick: bool,
    flicker: bool,
    pool: ThreadPool,
}

/// Runs the command with the arguments after `accuracy`.
pub fn run(args: &[String]) -> Result<(), String> {
    let options = options(args).map_err(|e| e.to_string())?;
    let mut parts = Subject::show();
    if let Some(name) = &options.part {
        parts.retain(|s| s.name == name);
        if parts.is_empty() {
            return Err(format!("no part is called {name}"));
        }
    }
    let mut subjects = parts.clone();
    subjects.push(Subject::fireflies());
    let effort = if options.quick {
        Effort { size: (96, 54), passes: 1, enough: 0.0, samples: 31, light_samples: 3, flicker: 3 }
    } else {
        Effort { size: (240, 135), passes: 5, enough: 200.0, samples: 63, light_samples: 15, flicker: 30 }
    };
    let effort = Effort { size: options.size.unwrap_or(effort.size), ..effort };
    let out = options.out.clone().unwrap_or_else(|| if options.quick { QUICK_OUT } else { OUT }.into());
    let threads = options.threads;
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let study = Study {
        subjects,
        knobs: knobs(),
        effort,
        frames: options.frames.unwrap_or(if options.quick { 1 } else { FRAMES }),
        quick: options.quick,
        flicker: options.flicker,
        pool: pool.map_err(|_| format!("{threads} threads can't be started"))?,
    };
    let conditions = format!(
        "# {}x{}; {threads} thread(s); at most {} passes; truth of {} samples; flicker over {} frames; engine {:016x}",
        effort.size.0,
        effort.size.1,
        effort.passes,
        effort.samples + 1,
        effort.flicker,
        fingerprint()
    );
    let file = out.join("study.csv");
    if !options.pages_only {
        if options.errors_only {
            return study.again(&file, &conditions);
        }
        let mut table = Table::open(&file, &conditions, options.fresh)?;
        study.measure(&mut table)?;
        growth::measure(&study.pool, &parts, &out, &conditions, options.quick, options.fresh)?;
        if options.fresh || !out.join(numbers::TABLE).exists() {
            numbers::write_study(if options.quick { 5_000 } else { 200_000 }, &out)?;
        }
    }
    let (conditions, rows) = table::read(&file)?;
    let numbers = std::fs::read_to_string(out.join(numbers::TABLE)).unwrap_or_default();
    let data = page::Data { rows, conditions, knobs: knobs(), growth: growth::read(&out)?, numbers };
    plots::write(&data, &out)?;
    if !options.pages_only || !out.join(pictures::FOLDER).exists() {
        pictures::write(&parts, &out, options.quick)?;
    }
    page::write(&data, &out)?;
    eprintln!("see {}", out.join("index.html").display());
    Ok(())
}

/// A number that changes with what the engine draws: small drafts of all parts, and the presets.
fn fingerprint() -> u64 {
    let mut all = Fingerprint::default();
    let mut renderer = Renderer::default();
    let mut pixels = vec![0; 64 * 36];
    for subject in Subject::show() {
        all.add(subject.name.bytes());
        for n in subject.spread(4).take(2) {
            renderer.frame(&subject.bare(n), n, (64, 36), &knob::base(), &mut pixels);
            pixels.iter().for_each(|p| all.add(p.to_be_bytes()));
        }
    }
    all.add(format!("{:?}", Quality::PRESETS).bytes());
    all.value()
}

impl Study {
    /// The settings that are still to be measured on a frame. Knobs of light, whose truth is dear,
    /// are measured on the middle frame only.
    fn tasks(&self, subject: &Subject, n: u64, middle: bool, rows: &[Row]) -> Vec<Task<'_>> {
        let fireflies = subject.name == Subject::fireflies().name;
        let scene = subject.bare(n);
        let on = |on: On| if fireflies { on == On::Fireflies } else { on.means(&scene) };
        let mut tasks = Vec::new();
        for knob in self.knobs.iter().filter(|k| on(k.on) && (middle || k.truth == Truth::Show)) {
            for setting in &knob.settings {
                if !rows.iter().any(|r| r.is(subject.name, n, knob.name, &setting.label)) {
                    tasks.push((knob, setting));
                }
            }
        }
        tasks
    }

    /// Frames of a subject, the middle one first, with whether it is that.
    fn frames(&self, subject: &Subject) -> Vec<(u64, bool)> {
        // Smoke has come a long way to its middle; the quick study has no time for that.
        let from = if self.quick && subject.bare(0).smoke.is_some() { 6 } else { 1 };
        let frames: Vec<u64> = subject.spread(self.frames * from).take(self.frames as usize).collect();
        let middle = frames.len() / 2;
        let rest = frames.iter().enumerate().filter(|(i, _)| *i != middle).map(|(_, &n)| (n, false));
        std::iter::once((frames[middle], true)).chain(rest).collect()
    }

    /// Measures what the table lacks.
    fn measure(&self, table: &mut Table) -> Result<(), String> {
        let mut total = 0.0;
        for subject in &self.subjects {
            for (n, middle) in self.frames(subject) {
                total += work(&self.tasks(subject, n, middle, &table.rows), middle);
            }
        }
        if total == 0.0 {
            return Ok(());
        }
        let mut progress = Progress::new(total);
        for subject in &self.subjects {
            for (n, middle) in self.frames(subject) {
                let tasks = self.tasks(subject, n, middle, &table.rows);
                if !tasks.is_empty() {
                    self.measure_frame(subject, n, middle, &tasks, table, &mut progress)?;
                }
            }
        }
        progress.end("measured");
        Ok(())
    }

    /// Tells the errors of all rows of a table again, as after a change of the truth.
    fn again(&self, file: &Path, conditions: &str) -> Result<(), String> {
        let (_, rows) = table::read(file)?;
        let mut progress = Progress::new(rows.len() as f64);
        let mut table = Table::open(file, conditions, true)?;
        let mut known: Option<(String, u64, Truth, Picture)> = None;
        let truth_of = |row: &Row| self.knobs.iter().find(|k| k.name == row.knob).map(|k| k.truth);
        let mut order: Vec<&Row> = rows.iter().collect();
        order.sort_by_key(|row| truth_of(row).map(|truth| truth as u32));
        for row in order {
            progress.step(1.0, &format!("{} {}: {} {}", row.part, row.frame, row.knob, row.value));
            let mut row = row.clone();
            let subject = self.subjects.iter().find(|s| s.name == row.part);
            let knob = self.knobs.iter().find(|k| k.name == row.knob && k.on != On::Fireflies);
            let setting = knob.and_then(|k| k.settings.iter().find(|s| s.label == row.value));
            if let (Some(subject), Some(knob), Some(setting)) = (subject, knob, setting) {
                let kept = known
                    .take()
                    .filter(|k| (k.0.as_str(), k.1, k.2) == (subject.name, row.frame, knob.truth));
                let truth = match kept {
                    Some((.., truth)) => truth,
                    None => measure::truth(subject, row.frame, &self.effort, knob.truth),
                };
                let mut picture = Picture::new(self.effort.size);
                measure::draw(&mut Renderer::default(), subject, row.frame, setting, &mut picture);
                measure::fill_errors(&mut row, &truth, &picture);
                known = Some((row.part.clone(), row.frame, knob.truth, truth));
            }
            table.add(row)?;
        }
        progress.end("errors told again");
        Ok(())
    }

    fn measure_frame(
        &self,
        subject: &Subject,
        n: u64,
        middle: bool,
        tasks: &[Task],
        table: &mut Table,
        progress: &mut Progress,
    ) -> Result<(), String> {
        let effort = &self.effort;
        let needs = |truth| tasks.iter().any(|(knob, _)| knob.truth == truth);
        let truths = Truth::ALL.map(|truth| {
            progress.step(0.0, &format!("{} {n}: truth", subject.name));
            needs(truth).then(|| measure::truth(subject, n, effort, truth))
        });
        let (moving, still): (Vec<Task>, Vec<Task>) =
            tasks.iter().partition(|(_, setting)| matches!(setting.change, Change::Smoke(..)));
        let mut timings =
            measure::time(&self.pool, subject, n, &still, effort, |what| progress.step(0.0, what));
        let mut pictures: Vec<Option<Picture>> = still.iter().map(|_| None).collect();
        for (knob, setting) in &moving {
            progress.step(0.0, &format!("{} {n}: {} {}", subject.name, knob.name, setting.label));
            let (timing, picture) = measure::time_moving(&self.pool, subject, n, setting, effort);
            timings.push(timing);
            pictures.push(Some(picture));
        }
        let tasks: Vec<Task> = still.into_iter().chain(moving).collect();
        // One renderer, so that smoke is found again where it was.
        let mut renderer = Renderer::default();
        let flickers = self.flicker && middle && tasks.iter().any(|(knob, _)| knob.samples);
        let frames = match flickers {
            true => measure::flicker_truths(subject, n, effort, |what| progress.step(0.0, what)),
            false => Vec::new(),
        };
        for ((task, timing), picture) in tasks.iter().zip(&timings).zip(pictures) {
            let (knob, setting) = *task;
            let picture = picture.unwrap_or_else(|| {
                let mut picture = Picture::new(effort.size);
                measure::draw(&mut renderer, subject, n, setting, &mut picture);
                picture
            });
            let mut row = Row {
                part: subject.name.into(),
                frame: n,
                knob: knob.name.into(),
                value: setting.label.clone(),
                figures: [f64::NAN; Figure::ALL.len()],
            };
            measure::fill_counts(&mut row, timing, picture.pixels.len() as f64);
            if let (Some(truth), true) = (&truths[knob.truth as usize], knob.on != On::Fireflies) {
                measure::fill_errors(&mut row, truth, &picture);
            }
            if knob.samples {
                let error = measure::error_of_sampling(&mut renderer, subject, n, setting, &picture);
                row.set(Figure::PsnrOfSampling, error);
            }
            // The truth has no flicker, and the mean of many patterns takes as long to tell as all the rest.
            let worth = setting.quality.samples < 15 && setting.quality.average <= 4;
            if middle && knob.samples && worth && frames.len() > 1 {
                row.set(
                    Figure::Flicker,
                    measure::measure_flicker(&mut renderer, subject, n, setting, &frames),
                );
            }
            table.add(row)?;
            progress.step(
                work(std::slice::from_ref(task), middle),
                &format!("{} {n}: errors, {}", subject.name, knob.name),
            );
        }
        Ok(())
    }
}

/// About how much work settings are, in times, errors and flicker.
fn work(tasks: &[Task], middle: bool) -> f64 {
    tasks.iter().map(|(knob, _)| if middle && knob.samples { 3.0 } else { 1.0 }).sum()
}
