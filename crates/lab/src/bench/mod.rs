//! `lab bench`: frame times along every part's camera path, by preset and by phase of a frame.
//!
//! Times of all presets take turns frame by frame, so that all meet the same other load of the
//! machine. `--compare OLD.json` holds them against an older run, `--callgrind` counts instructions of
//! the hot kernels instead, which no load disturbs.

pub mod kernels;
mod phases;
mod report;

use crate::figures::processor_ms;
use crate::progress::Progress;
use crate::subject::Subject;
use lexopt::prelude::*;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use rayon::ThreadPoolBuilder;
use report::{Report, Run};
use std::path::PathBuf;
use std::time::Instant;

/// Presets that play live.
const PLAYED: usize = Quality::PRESETS.len() - 1;

/// What the command was asked for.
struct Options {
    size: (u32, u32),
    frames: u64,
    threads: usize,
    part: Option<usize>,
    presets: Vec<(String, Quality)>,
    out: PathBuf,
    compare: Option<PathBuf>,
    callgrind: bool,
}

fn options(args: &[String]) -> Result<Options, lexopt::Error> {
    let mut parser = lexopt::Parser::from_args(args);
    let played = Quality::PRESETS.iter().take(PLAYED).map(|(name, q)| (name.to_string(), *q));
    let mut options = Options {
        size: (1280, 720),
        frames: 48,
        threads: 0,
        part: None,
        presets: played.collect(),
        out: "target/bench/bench.json".into(),
        compare: None,
        callgrind: false,
    };
    while let Some(arg) = parser.next()? {
        match arg {
            Long("size") => options.size = parser.value()?.parse_with(crate::args::size)?,
            Long("frames") => options.frames = parser.value()?.parse_with(crate::args::count)?.into(),
            Long("quick") => (options.frames, options.size) = (6, (640, 360)),
            Long("threads") => options.threads = parser.value()?.parse_with(crate::args::count)? as usize,
            Long("part") => options.part = Some(parser.value()?.parse_with(crate::args::part)?),
            Long("presets") => {
                let names: String = parser.value()?.parse()?;
                let preset = |name: &str| Ok((name.to_string(), crate::args::preset(name)?));
                options.presets = names.split(',').map(preset).collect::<Result<_, String>>()?;
            }
            Long("compare") => options.compare = Some(parser.value()?.into()),
            Long("callgrind") => options.callgrind = true,
            Short('o') => options.out = parser.value()?.into(),
            _ => return Err(arg.unexpected()),
        }
    }
    Ok(options)
}

/// Runs the command with the arguments after `bench`.
pub fn run(args: &[String]) -> Result<(), String> {
    let options = options(args).map_err(|e| e.to_string())?;
    // An older run that can't be read is no reason to measure in vain.
    let old = options.compare.as_deref().map(report::read).transpose()?;
    if options.callgrind {
        return kernels::count();
    }
    let mut subjects = Subject::show();
    if let Some(part) = options.part {
        subjects = vec![subjects[part]];
    }
    let pool = ThreadPoolBuilder::new().num_threads(options.threads).build();
    let pool = pool.map_err(|_| format!("{} threads can't be started", options.threads))?;
    let threads = pool.current_num_threads();
    let mut report = Report { size: options.size, threads, runs: Vec::new(), phases: Vec::new() };
    let total = subjects.iter().map(|s| s.frames.min(options.frames)).sum::<u64>() as f64;
    let mut progress = Progress::new(total * 1.6);
    for subject in &subjects {
        report.runs.extend(pool.install(|| path(subject, &options, &mut progress)));
    }
    let size = options.size;
    for subject in &subjects {
        progress.step(0.0, &format!("{}: phases", subject.name));
        report.phases.push(phases::measure(subject, size, options.frames.div_ceil(6), threads)?);
        progress.step(0.6 * subject.frames.min(options.frames) as f64, subject.name);
    }
    progress.end("measured");
    report.write(&options.out)?;
    print!("{}", report.text());
    if let Some(old) = old {
        print!("{}", report.compared(&old));
    }
    eprintln!("see {} and the plot beside it", options.out.display());
    Ok(())
}

/// Times of all presets along a part.
fn path(subject: &Subject, options: &Options, progress: &mut Progress) -> Vec<Run> {
    let run = |(name, _): &(String, Quality)| Run {
        part: subject.name.into(),
        preset: name.clone(),
        frames: Vec::new(),
        wall: Vec::new(),
        processor: Vec::new(),
    };
    let mut runs: Vec<Run> = options.presets.iter().map(run).collect();
    let mut renderer = Renderer::default();
    let mut pixels = vec![0; options.size.0 as usize * options.size.1 as usize];
    for (i, n) in subject.spread(options.frames).enumerate() {
        for ((_, quality), run) in options.presets.iter().zip(&mut runs) {
            // The first time round only warms up.
            for warm in [i == 0, false] {
                subject.lead(&mut renderer, n);
                let (begin, processor) = (Instant::now(), processor_ms());
                renderer.frame(&(subject.scene)(n), n, options.size, quality, &mut pixels);
                if !warm {
                    run.frames.push(n);
                    run.wall.push(begin.elapsed().as_secs_f64() * 1e3);
                    run.processor.push(processor_ms() - processor);
                    break;
                }
            }
        }
        progress.step(1.0, &format!("{} {n}", subject.name));
    }
    runs
}
