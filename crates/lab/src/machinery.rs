//! `lab machinery`: what machinery costs where a scene calls for it, and where none does.
//!
//! First each machinery is switched off in the scenes that have it: the time that saves stands beside the
//! counts that fall to 0. Frames with and without take turns. Then each part is drawn by an engine built with
//! what the 64 kB file has for it and by the whole one, with all other machinery and its counters: as long as
//! the time of both is equal, machinery that isn't called for costs nothing.

use crate::figures::{processor_ms, quantile};
use crate::subject::Subject;
use luc::show;
use luc_core::counters::Counter;
use luc_core::plan::Plan;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;
use std::path::Path;
use std::process::{Command, Stdio};

const SIZE: (u32, u32) = (640, 360);
/// Rounds whose least times are told: what else runs on the machine only adds.
const ROUNDS: u64 = 9;

/// Takes a machinery out of a scene.
type Switch = (&'static str, fn(&mut Scene));

const SWITCHES: [Switch; 17] = [
    ("smoke", |s| s.smoke = None),
    ("voxels", |s| (s.voxels, s.smoke) = (vec![], None)),
    ("fields", |s| s.fields.clear()),
    ("meshes", |s| s.meshes = Default::default()),
    ("occlusion", |s| s.occlusion = 0.0),
    ("mirrors", |s| s.materials.iter_mut().for_each(|m| m.reflection = 0.0)),
    ("textures", |s| s.materials.iter_mut().for_each(|m| m.texture = luc_core::scene::Texture::NONE)),
    ("lamps", |s| (s.lights, s.emitters) = (vec![], vec![])),
    ("small lights", |s| s.points.clear()),
    ("beams", |s| s.beams.clear()),
    ("fog", |s| s.fog = None),
    ("bloom", |s| s.grade.bloom = 0.0),
    ("glass", |s| s.materials.iter_mut().for_each(|m| m.transparency = 0.0)),
    ("soft shadows", |s| s.soft = false),
    ("sun and glows", |s| (s.background.discs, s.background.glows) = (vec![], vec![])),
    ("effects", |s| s.effects.clear()),
    ("split", |s| s.split = None),
];

/// Those of them that a scene has only as it is shown, see [`Subject::bare`].
const SHOWN: [&str; 2] = ["effects", "split"];

/// Processor time of one thread for a frame with and without a machinery, and the counts that it takes away.
fn switched(subject: &Subject, (name, off): Switch, quality: &Quality) -> Option<([f64; 2], String)> {
    let first = subject.frames / 2 - subject.frames / 2 % 2;
    let scenes = |n: u64| {
        let with = if SHOWN.contains(&name) { (subject.scene)(n) } else { subject.bare(n) };
        let mut without = with.clone();
        off(&mut without);
        [with, without]
    };
    let [with, without] = scenes(first).map(|scene| Plan::of(&scene, quality));
    let gone = |counter: Counter| with.names(counter) && !without.names(counter);
    if !with.calls().iter().any(|&counter| gone(counter)) {
        return None;
    }
    let mut renderers = [Renderer::default(), Renderer::default()];
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    let mut least = [f64::INFINITY; 2];
    for round in 0..=ROUNDS {
        // Two frames on, so that smoke takes a step each time.
        let n = first + 2 * round;
        for (k, scene) in scenes(n).iter().enumerate() {
            let begin = processor_ms();
            renderers[k].frame(scene, n, SIZE, quality, &mut pixels);
            // The first time round only warms up.
            if round > 0 {
                least[k] = least[k].min(processor_ms() - begin);
            }
        }
    }
    let count = |counter: Counter| renderers[0].counters.get(counter);
    let words = Counter::ALL.iter().filter(|(counter, _)| gone(*counter) && count(*counter) > 0);
    let words: Vec<_> = words.map(|(counter, words)| format!("{} {words}", count(*counter))).collect();
    for (counter, words) in Counter::ALL {
        let left = renderers[1].counters.get(counter);
        assert!(!gone(counter) || left == 0, "{}: {left} {words} though switched off", subject.name);
    }
    Some((least, words.join(", ")))
}

/// Builds the player with these features of the package `luc`, or with all for none, and tells where it is.
fn built(features: Option<&str>) -> Result<String, String> {
    let folder = format!("target/machinery/{}", features.unwrap_or("whole"));
    let mut cargo = Command::new("cargo");
    cargo.args([
        "build",
        "--release",
        "--locked",
        "-q",
        "-p",
        "luc",
        "--bin",
        "luc",
        "--target-dir",
        &folder,
    ]);
    if let Some(features) = features {
        cargo.args(["--no-default-features", "--features", features]);
    }
    let done = cargo.status().map_err(|e| format!("cargo can't be started: {e}"))?;
    let file = format!("{folder}/release/luc");
    if done.success() && Path::new(&file).exists() { Ok(file) } else { Err(format!("no {file} was built")) }
}

/// Time that a player takes for one frame of a part on one thread, ms.
fn drawn(player: &str, part: &str, frame: u64) -> Result<f64, String> {
    let begin = children_ms();
    let done = Command::new(player)
        .args(["--scene", part, "--frame", &frame.to_string(), "--threads", "1"])
        .args(["--size", "1920x1080", "-o", "-"])
        .stdout(Stdio::null())
        .status();
    match done {
        Ok(status) if status.success() => Ok(children_ms() - begin),
        _ => Err(format!("{player} drew no frame of {part}")),
    }
}

/// Processor time of the programs that this one has started and waited for, ms.
fn children_ms() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after = text.rsplit_once(')').map_or("", |(_, rest)| rest);
    // User and system time are the 16th and 17th number, in hundredths of a second.
    let ticks: f64 = after.split_whitespace().skip(13).take(2).filter_map(|n| n.parse::<f64>().ok()).sum();
    10.0 * ticks
}

/// Runs the command with the arguments after `machinery`.
pub fn run(args: &[String]) -> Result<(), String> {
    let (engines, names) = match args.split_first() {
        Some((first, rest)) if first == "--engines" => (true, rest),
        _ => (false, args),
    };
    let named = |subject: &Subject| names.is_empty() || names.iter().any(|name| name == subject.name);
    let quality = Quality::named("high").ok_or("no preset high")?;
    let subjects: Vec<Subject> = Subject::show().into_iter().filter(named).collect();
    if subjects.is_empty() {
        return Err("no part of the show has such a name".into());
    }
    if engines {
        let whole = built(None)?;
        println!("| part | own engine, ms | whole engine, ms | ratio |\n|---|---:|---:|---:|");
        for subject in subjects {
            // The sound is no part of the engine, but makes the player whole.
            let part = show::OPTIONAL.contains(&subject.name).then_some(subject.name);
            let own = ["sound"].into_iter().chain(part).collect::<Vec<_>>().join(",");
            let players = [built(Some(&own))?, whole.clone()];
            let mut times = [vec![], vec![]];
            for _ in 0..ROUNDS {
                for (times, player) in times.iter_mut().zip(&players) {
                    times.push(drawn(player, subject.name, subject.frames / 4)?);
                }
            }
            let [own, whole] = times.map(|times| quantile(&times, 0.0));
            println!("| {} | {own:.0} | {whole:.0} | {:.2} |", subject.name, whole / own);
        }
        return Ok(());
    }
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    println!(
        "| part | off | ms | without, ms | saved | what is no longer done |\n|---|---|---:|---:|---:|---|"
    );
    for subject in subjects {
        for switch @ (name, _) in SWITCHES {
            if let Some(([with, without], words)) = alone.install(|| switched(&subject, switch, &quality)) {
                let saved = 100.0 * (1.0 - without / with);
                println!("| {} | {name} | {with:.1} | {without:.1} | {saved:.0} % | {words} |", subject.name);
            }
        }
    }
    Ok(())
}
