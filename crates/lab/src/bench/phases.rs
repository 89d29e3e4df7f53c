//! What a frame's time goes to: sampling, tracing, shading, filling, bloom, output, and the rest; and
//! how much of it threads share.
//!
//! Phases are told on one thread, where all time is somebody's, and scaled from the wall clock's to the
//! processor's time, since what disturbs a frame disturbs all its phases alike. What several threads
//! lose is what they take together beyond that: waiting, waking, and getting in each other's way.

use crate::figures::{mean, processor_ms};
use crate::subject::Subject;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::study::{Clock, Phase, Study};
use rayon::ThreadPoolBuilder;
use std::sync::LazyLock;
use std::time::Instant;

/// Mean times of a part's frames at the default preset, ms.
#[derive(Clone, Debug, PartialEq)]
pub struct Phases {
    /// Name of the part.
    pub part: String,
    /// On one thread, in the order of [`Phase::ALL`].
    pub spent: Vec<f64>,
    /// A whole frame on one thread, processor time; more than the phases by what belongs to none.
    pub processor: f64,
    /// A whole frame on one thread by the wall clock.
    pub one: f64,
    /// A whole frame on all threads by the wall clock.
    pub all: f64,
}

/// Nanoseconds since the program first asked.
fn now() -> u64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_nanos() as u64
}

/// Measures `count` frames of a part.
pub fn measure(subject: &Subject, size: (u32, u32), count: u64, threads: usize) -> Result<Phases, String> {
    let pool = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map_err(|_| format!("{threads} threads can't be started"))
    };
    let (alone, together) = (pool(1)?, pool(threads)?);
    let (_, plain) = Quality::PRESETS[Quality::DEFAULT];
    let timed = Quality { study: Study { clock: Some(Clock(now)), ..Study::NONE }, ..plain };
    let mut pixels = vec![0; size.0 as usize * size.1 as usize];
    let mut renderer = Renderer::default();
    let mut spent = vec![Vec::new(); Phase::ALL.len()];
    let (mut processor, mut one, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for n in subject.spread(count) {
        let scene = (subject.scene)(n);
        let mut time = |pool: &rayon::ThreadPool, quality| {
            subject.lead(&mut renderer, n);
            let (begin, processor) = (Instant::now(), processor_ms());
            pool.install(|| renderer.frame(&scene, n, size, quality, &mut pixels));
            (begin.elapsed().as_secs_f64() * 1e3, processor_ms() - processor)
        };
        time(&alone, &plain);
        let alone_ms = time(&alone, &plain);
        one.push(alone_ms.0);
        processor.push(alone_ms.1);
        all.push(time(&together, &plain).0);
        let (wall, own) = time(&alone, &timed);
        for (list, (phase, _)) in spent.iter_mut().zip(Phase::ALL) {
            list.push(renderer.counters.watch.spent(phase) as f64 / 1e6 * own / wall);
        }
    }
    let spent = spent.iter().map(|list| mean(list)).collect();
    Ok(Phases {
        part: subject.name.into(),
        spent,
        processor: mean(&processor),
        one: mean(&one),
        all: mean(&all),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_told_and_add_up_to_no_more_than_the_frame() {
        let subject = Subject::show()[1];
        let begin = Instant::now();
        let phases = measure(&subject, (160, 90), 1, 1).unwrap();
        let most = begin.elapsed().as_secs_f64() * 1e3;
        let sum: f64 = phases.spent.iter().sum();
        assert!(phases.spent.iter().all(|t| *t >= 0.0) && sum > 0.0 && sum <= most, "{phases:?}");
        for (time, (phase, name)) in phases.spent.iter().zip(Phase::ALL) {
            // The part has no smoke to march through.
            assert!(*time > 0.0 || phase == Phase::SmokeRender, "no time for {name}");
        }
    }

    #[test]
    fn a_clock_changes_no_pixel() {
        let subject = Subject::show()[2];
        let (_, plain) = Quality::PRESETS[Quality::DEFAULT];
        let timed = Quality { study: Study { clock: Some(Clock(now)), ..Study::NONE }, ..plain };
        let [a, b] = [plain, timed].map(|quality| {
            let mut pixels = vec![0; 160 * 90];
            Renderer::default().frame(&(subject.scene)(900), 900, (160, 90), &quality, &mut pixels);
            pixels
        });
        assert!(a == b);
    }
}
