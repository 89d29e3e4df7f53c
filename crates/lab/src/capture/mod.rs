//! `lab capture`: frames of the show as a video file or stream.
//!
//! Frames are pure functions of their number, so what was written before an interruption is continued,
//! and shards made anywhere are equal to the same frames of the whole: chunk files hold nothing but
//! consecutive bytes of it, and joining them is `cat`.

mod shard;
mod wav;
mod y4m;

use crate::progress::{Progress, duration};
use lexopt::prelude::*;
use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use shard::Shard;
use std::fs::{File, OpenOptions, rename};
use std::io::{Read, Seek, SeekFrom, Write, stdout};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What to capture.
struct Capture {
    frames: Range<u64>,
    size: (u32, u32),
    quality: Quality,
    /// What stands in the file's header, so that only the same capture is continued.
    note: String,
}

/// What the command was asked for.
struct Options {
    capture: Capture,
    out: PathBuf,
    shard: Option<Shard>,
    chunk: u64,
    /// Where the sound goes.
    wav: Option<PathBuf>,
}

fn options(args: &[String]) -> Result<Options, lexopt::Error> {
    let mut parser = lexopt::Parser::from_args(args);
    let (mut from, mut to, mut part) = (None, None, None);
    let (mut size, mut preset, mut average) = ((1280, 720), String::from("high"), 1);
    let (mut out, mut shard, mut chunk, mut sound) = (PathBuf::from("show.y4m"), None, show::FPS, None);
    while let Some(arg) = parser.next()? {
        match arg {
            Long("from") => from = Some(parser.value()?.parse::<u64>()?),
            Long("to") => to = Some(parser.value()?.parse::<u64>()?),
            Long("part") => part = Some(parser.value()?.parse_with(crate::args::part)?),
            Long("size") => size = parser.value()?.parse_with(crate::args::size)?,
            Long("quality") => preset = parser.value()?.parse()?,
            Long("average") => average = parser.value()?.parse_with(crate::args::count)?,
            Long("shard") => shard = Some(parser.value()?.parse_with(Shard::read)?),
            Long("chunk") => chunk = parser.value()?.parse_with(crate::args::count)?.into(),
            Long("wav") => sound = Some(PathBuf::from(parser.value()?)),
            Short('o') => out = parser.value()?.into(),
            _ => return Err(arg.unexpected()),
        }
    }
    let quality = Quality { average, ..crate::args::preset(&preset)? };
    let whole = part.map_or(0..show::FRAMES, |part| show::start(part)..show::start(part + 1));
    let frames = whole.start + from.unwrap_or(0)..whole.start + to.unwrap_or(whole.end - whole.start);
    if frames.is_empty() {
        return Err("--to must be greater than --from".into());
    }
    if shard.is_some() && out == Path::new("-") {
        return Err("--shard writes files; name one with -o".into());
    }
    let note = format!("{preset},{average},{}-{}", frames.start, frames.end);
    Ok(Options { capture: Capture { frames, size, quality, note }, out, shard, chunk, wav: sound })
}

/// Runs the command with the arguments after `capture`.
pub fn run(args: &[String]) -> Result<(), String> {
    let Options { capture, out, shard, chunk, wav } = options(args).map_err(|e| e.to_string())?;
    let start = Instant::now();
    if let Some(path) = &wav {
        wav::save(path, &capture.frames)?;
    }
    match shard {
        Some(shard) => capture.chunks(&out, shard, chunk)?,
        None if out == Path::new("-") => capture.stream()?,
        None => capture.file(&out)?,
    }
    let frames = capture.frames.end - capture.frames.start;
    eprintln!("{frames} frames, {} s of the show, in {}", frames / show::FPS, duration(start.elapsed()));
    let name = out.display();
    match shard {
        Some(Shard { count, .. }) => eprintln!("when all {count} shards are done: cat {name}.* > {name}"),
        None if out == Path::new("-") => {}
        None => eprintln!("{}", ffmpeg(&name.to_string(), wav.as_deref())),
    }
    Ok(())
}

/// The line that makes a film of the file.
fn ffmpeg(name: &str, wav: Option<&Path>) -> String {
    let film = name.strip_suffix(".y4m").unwrap_or(name);
    let sound = wav.map_or(String::new(), |wav| format!("-i {} -c:a aac -b:a 256k ", wav.display()));
    format!(
        "ffmpeg -i {name} {sound}-c:v libx264 -preset slow -crf 16 -pix_fmt yuv420p -color_primaries bt709 \
         -color_trc iec61966-2-1 -colorspace bt709 -color_range tv -movflags +faststart {film}.mp4"
    )
}

impl Capture {
    fn header(&self) -> Vec<u8> {
        y4m::header(self.size, show::FPS, &self.note)
    }

    /// Appends frame `n` to `bytes`.
    fn frame(&self, renderer: &mut Renderer, n: u64, pixels: &mut Vec<u32>, bytes: &mut Vec<u8>) {
        pixels.resize(self.size.0 as usize * self.size.1 as usize, 0);
        show::frame(renderer, n, self.size, &self.quality, pixels);
        y4m::frame(pixels, bytes);
    }

    /// Writes `frames`, telling how far it is.
    fn write(&self, frames: Range<u64>, to: &mut impl Write, progress: &mut Progress) -> std::io::Result<()> {
        let mut renderer = Renderer::default();
        let (mut pixels, mut bytes) = (Vec::new(), Vec::new());
        for n in frames {
            bytes.clear();
            self.frame(&mut renderer, n, &mut pixels, &mut bytes);
            to.write_all(&bytes)?;
            progress.step(1.0, &format!("frame {n} of {} to {}", self.frames.start, self.frames.end - 1));
        }
        to.flush()
    }

    /// All frames to standard output.
    fn stream(&self) -> Result<(), String> {
        let mut out = stdout().lock();
        let mut progress = Progress::new((self.frames.end - self.frames.start) as f64);
        out.write_all(&self.header())
            .and_then(|()| self.write(self.frames.clone(), &mut out, &mut progress))
            .map_err(|e| format!("standard output: {e}"))
    }

    /// All frames to a file, after those that it holds already.
    fn file(&self, path: &Path) -> Result<(), String> {
        let fault = |e: std::io::Error| format!("{}: {e}", path.display());
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(fault)?;
        let done = self.done(&mut file, path)?;
        if done > 0 {
            eprintln!("{} holds {done} frames; going on from there", path.display());
        }
        let frames = self.frames.start + done..self.frames.end;
        let mut progress = Progress::new((frames.end - frames.start).max(1) as f64);
        self.write(frames, &mut file, &mut progress).map_err(fault)
    }

    /// Frames that a file holds; it is cut after the last whole one, and ready to be written on.
    fn done(&self, file: &mut File, path: &Path) -> Result<u64, String> {
        let fault = |e: std::io::Error| format!("{}: {e}", path.display());
        let other = || format!("{} holds something else; remove it or choose another name", path.display());
        let (header, each) = (self.header(), y4m::frame_bytes(self.size));
        let length = file.metadata().map_err(fault)?.len();
        let mut found = Vec::new();
        file.take(header.len() as u64).read_to_end(&mut found).map_err(fault)?;
        if !header.starts_with(&found) {
            return Err(other());
        }
        let done = length.saturating_sub(header.len() as u64) / each;
        if done > self.frames.end - self.frames.start {
            return Err(other());
        }
        let end = header.len() as u64 + done * each;
        if done > 0 && !self.holds(file, end - each, self.frames.start + done - 1).map_err(fault)? {
            return Err(format!(
                "{} was made by another version; remove it or choose another name",
                path.display()
            ));
        }
        file.set_len(if done > 0 { end } else { 0 }).map_err(fault)?;
        file.seek(SeekFrom::End(0)).map_err(fault)?;
        if done == 0 {
            file.write_all(&header).map_err(fault)?;
        }
        Ok(done)
    }

    /// Whether frame `n` stands at a place of a file.
    fn holds(&self, file: &mut File, at: u64, n: u64) -> std::io::Result<bool> {
        let (mut expected, mut found) = (Vec::new(), Vec::new());
        self.frame(&mut Renderer::default(), n, &mut Vec::new(), &mut expected);
        file.seek(SeekFrom::Start(at))?;
        file.take(expected.len() as u64).read_to_end(&mut found)?;
        Ok(found == expected)
    }

    /// The chunks of a shard, each in a file of its own; those that are there already are kept.
    fn chunks(&self, out: &Path, shard: Shard, chunk: u64) -> Result<(), String> {
        let chunks: Vec<(u64, Range<u64>)> = shard.chunks(&self.frames, chunk).collect();
        let total: u64 = chunks.iter().map(|(_, frames)| frames.end - frames.start).sum();
        let mut progress = Progress::new(total.max(1) as f64);
        for (k, frames) in chunks {
            let path = PathBuf::from(format!("{}.{k:06}", out.display()));
            let fault = |e: std::io::Error| format!("{}: {e}", path.display());
            // The first chunk begins with the header of the whole.
            let header = if k == 0 { self.header() } else { Vec::new() };
            let count = frames.end - frames.start;
            let whole = header.len() as u64 + count * y4m::frame_bytes(self.size);
            if let Ok(mut file) = File::open(&path) {
                if file.metadata().map_err(fault)?.len() != whole
                    || !self.holds(&mut file, header.len() as u64, frames.start).map_err(fault)?
                {
                    return Err(format!("{} holds something else; remove it", path.display()));
                }
                progress.step(count as f64, "kept");
                continue;
            }
            let beside = PathBuf::from(format!("{}.{k:06}-unfinished", out.display()));
            let mut file = File::create(&beside).map_err(fault)?;
            file.write_all(&header).map_err(fault)?;
            self.write(frames, &mut file, &mut progress).map_err(fault)?;
            rename(&beside, &path).map_err(fault)?;
        }
        Ok(())
    }
}
