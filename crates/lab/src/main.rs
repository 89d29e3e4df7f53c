//! The lab: what accuracy costs in time, what a frame did, and tools to look at the show.
//!
//! `cargo lab help` lists the commands.

#![allow(clippy::disallowed_methods, reason = "figures to read, never pixels of the show")]

mod accuracy;
mod args;
mod bench;
mod capture;
mod effects;
mod figures;
mod font;
mod lights;
mod machinery;
mod memory;
mod mesh;
mod metric;
mod numbers;
mod peers;
mod plot;
mod png_file;
mod progress;
mod render;
mod scale;
mod sheet;
mod smoke;
mod sound;
mod stats;
mod subject;
mod swarm;
mod values;
mod view;

use std::process::exit;

/// A command: its name, what follows it, what it does, and the function.
type Command = (&'static str, &'static str, &'static str, fn(&[String]) -> Result<(), String>);

const COMMANDS: [Command; 17] = [
    (
        "accuracy",
        "[--quick]",
        "what accuracy costs in time, as CSV, plots and a page in docs/accuracy",
        accuracy::run,
    ),
    (
        "bench",
        "[--compare OLD.json] [--callgrind]",
        "frame times along every part, by preset and by phase",
        bench::run,
    ),
    ("view", "[--part NAME] [--from N]", "the show in a window with the keys of an editor", view::run),
    ("sheet", "[--part NAME]", "contact sheets in target/sheets", sheet::run),
    ("effects", "[-o FILE]", "each effect on a frame of the show, as one page", effects::run),
    ("capture", "[-o FILE] [--shard I/N]", "frames as y4m, to a file or standard output", capture::run),
    ("stats", "[FRAME] [QUALITY] [WxH]", "counters, time and error of one frame", stats::run),
    ("sound", "[FILE.wav]...", "loudness, peaks and spectrum of the tune, beside those of files", sound::run),
    ("peers", "[--quick]", "our tree, fields and blur beside those of others, in one run", peers::run),
    ("memory", "PROGRAM [WxH]", "most memory that a player holds, by part", memory::run),
    ("lights", "", "culled against naive small lights", lights::run),
    (
        "machinery",
        "[--engines] [PART]...",
        "what each machinery costs, and that what isn't called for costs nothing",
        machinery::run,
    ),
    ("smoke", "", "what the motion, the light and the sight of smoke cost", smoke::run),
    ("numbers", "[CASES]", "formulas against the truth, as a page and a plot in docs", numbers::run),
    ("render", "FILE.obj [-o FILE.png] [--turn N]", "a model of triangles, in a studio", render::run),
    ("mesh", "NAME [-o FILE.obj]", "a mesh of the show, or a knot, as a model", mesh::run),
    ("values", "[TABLE]", "frames against the table of their one value", values::run),
];

/// The list of commands.
fn help() -> String {
    let line =
        |&(name, args, words, _): &Command| format!("  cargo lab {:<34} {words}\n", format!("{name} {args}"));
    COMMANDS.iter().map(line).collect()
}

fn main() {
    // A reader that has seen enough, such as `head`, ends this as it ends other tools.
    // SAFETY: no other thread runs yet, and no handler is replaced.
    unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
    let args: Vec<String> = std::env::args().skip(1).collect();
    let name = args.first().map_or("", String::as_str);
    let result = match COMMANDS.iter().find(|command| command.0 == name) {
        Some((.., run)) => run(&args[1..]),
        // What the bench runs under valgrind.
        None if name == "kernel" => bench::kernels::run(&args[1..]),
        None if ["help", "--help", "-h"].contains(&name) => {
            print!("{}", help());
            Ok(())
        }
        None if name.is_empty() => Err(format!("which command?\n{}", help())),
        None => Err(format!("'{name}' is no command; cargo lab help lists them")),
    };
    if let Err(message) = result {
        eprintln!("lab: {}", message.trim_end());
        exit(2);
    }
}
