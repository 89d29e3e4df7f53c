//! The command line, read by hand: each mistake is answered with what was wrong and what would be right.
//!
//! Flags come in any order, a value follows its flag, the last one wins. Flags that cannot have an
//! effect together are a mistake, not silence.

use super::text::{Text, join, number, quoted, whole};
use luc::show;
use luc_core::features::AVERAGE;
use luc_core::quality::Quality;
use luc_core::render::View;
use std::ffi::OsStr;

/// The largest picture, 8K.
pub const LARGEST: (u32, u32) = (7680, 4320);
const MOST_THREADS: u64 = 256;
const MOST_PATTERNS: u64 = 1024;
/// Whether frames can be drawn as something else than light.
const VIEWS: bool = cfg!(not(luc_size));
/// What is said of the options that a build lacks.
const LEFT_OUT: &[u8] = b" is left out of this small build; the ordinary one has it";

/// What the user wants.
#[derive(Debug, PartialEq)]
pub enum Request<'a> {
    /// The text of `--help`.
    Help,
    /// Name and version.
    Version,
    /// A frame, or the show in a window.
    Run(Options<'a>),
}

/// How to play, or which frame to write.
#[derive(Debug, PartialEq)]
pub struct Options<'a> {
    /// Write this frame and open no window.
    pub frame: Option<u64>,
    /// Where to write the frame; `-` is standard output.
    pub output: Option<&'a OsStr>,
    /// Width and height of the picture.
    pub size: (u32, u32),
    /// Index into the presets; without it, the player adapts and a frame takes the default.
    pub quality: Option<usize>,
    /// Index into the views: draw this instead of light.
    pub view: Option<usize>,
    /// Sample patterns that a frame averages.
    pub average: u32,
    /// Index of the only part to show.
    pub scene: Option<usize>,
    /// End instead of looping.
    pub once: bool,
    /// First frame to play.
    pub from: u64,
    /// Rendering threads; 0 is one for each core.
    pub threads: usize,
    /// Cover the screen.
    pub fullscreen: bool,
    /// Play no sound.
    pub mute: bool,
    /// Write the sound here and open no window; `-` is standard output.
    pub wav: Option<&'a OsStr>,
}

/// What a flag asks for.
#[derive(Clone, Copy)]
enum Flag {
    Help,
    Version,
    Frame,
    From,
    Threads,
    Size,
    Quality,
    Scene,
    Average,
    View,
    Output,
    Once,
    Fullscreen,
    #[cfg(feature = "sound")]
    Mute,
    #[cfg(feature = "sound")]
    Wav,
}

/// What follows a flag.
#[derive(Clone, Copy)]
enum Takes {
    Nothing,
    /// A whole number within bounds.
    Number(u64, u64),
    /// Width and height.
    Size,
    /// One of a list of names.
    Name(Names),
    /// The name of a picture file.
    File,
    /// The name of a sound file.
    #[cfg(feature = "sound")]
    Sound,
}

/// What a flag is good for.
#[derive(Clone, Copy, PartialEq)]
enum For {
    Anything,
    Pictures,
    Frames,
    Playing,
}

/// The flags by name.
const FLAGS: &[(&str, Flag, Takes, For)] = &[
    ("--help", Flag::Help, Takes::Nothing, For::Anything),
    ("--version", Flag::Version, Takes::Nothing, For::Anything),
    ("--frame", Flag::Frame, Takes::Number(0, u64::MAX), For::Pictures),
    ("--from", Flag::From, Takes::Number(0, u64::MAX), For::Playing),
    ("--threads", Flag::Threads, Takes::Number(1, MOST_THREADS), For::Pictures),
    ("--size", Flag::Size, Takes::Size, For::Pictures),
    ("--quality", Flag::Quality, Takes::Name(quality), For::Pictures),
    ("--scene", Flag::Scene, Takes::Name(scene), For::Anything),
    (
        "--average",
        Flag::Average,
        if AVERAGE { Takes::Number(1, MOST_PATTERNS) } else { Takes::Nothing },
        For::Frames,
    ),
    ("--view", Flag::View, if VIEWS { Takes::Name(view) } else { Takes::Nothing }, For::Frames),
    ("-o", Flag::Output, Takes::File, For::Frames),
    ("--once", Flag::Once, Takes::Nothing, For::Playing),
    ("--fullscreen", Flag::Fullscreen, Takes::Nothing, For::Playing),
    #[cfg(feature = "sound")]
    ("--mute", Flag::Mute, Takes::Nothing, For::Playing),
    #[cfg(feature = "sound")]
    ("--wav", Flag::Wav, Takes::Sound, For::Anything),
];

/// Reads the arguments that follow the program's name.
pub fn parse<'a>(args: &[&'a OsStr]) -> Result<Request<'a>, Text> {
    let mut options = Options {
        frame: None,
        output: None,
        size: (1280, 720),
        quality: None,
        view: None,
        average: 1,
        scene: None,
        once: false,
        from: 0,
        threads: 0,
        fullscreen: false,
        mute: false,
        wav: None,
    };
    let (mut windowed, mut still, mut seen): (&[u8], &[u8], &[u8]) = (b"", b"", b"");
    let mut args = args.iter();
    while let Some(name) = args.next() {
        let name = name.as_encoded_bytes();
        let Some((_, flag, takes, good_for)) = FLAGS.iter().find(|flag| flag.0.as_bytes() == name) else {
            return Err(join(&[&quoted(name), b" is not an option; --help lists them"]));
        };
        match good_for {
            For::Anything => {}
            For::Pictures => seen = name,
            For::Frames => still = name,
            For::Playing => windowed = name,
        }
        let typed = if let Takes::Nothing = takes { Some(&OsStr::new("")) } else { args.next() };
        let Some((n, height)) = typed.and_then(|typed| takes.read(typed.as_encoded_bytes())) else {
            let found = match typed {
                Some(typed) => join(&[b", not ", &quoted(typed.as_encoded_bytes())]),
                None => join(&[b" after it"]),
            };
            return Err(join(&[name, b" wants ", &takes.words(), &found]));
        };
        match flag {
            Flag::Help => return Ok(Request::Help),
            Flag::Version => return Ok(Request::Version),
            Flag::Frame => options.frame = Some(n),
            Flag::From => options.from = n,
            Flag::Threads => options.threads = n as usize,
            Flag::Size => options.size = (n as u32, height as u32),
            Flag::Quality => options.quality = Some(n as usize),
            Flag::Scene => options.scene = Some(n as usize),
            Flag::Average if !AVERAGE => return Err(join(&[name, LEFT_OUT])),
            Flag::View if !VIEWS => return Err(join(&[name, LEFT_OUT])),
            Flag::Average => options.average = n as u32,
            Flag::View => options.view = Some(n as usize),
            Flag::Output => options.output = typed.copied(),
            Flag::Once => options.once = true,
            Flag::Fullscreen => options.fullscreen = true,
            #[cfg(feature = "sound")]
            Flag::Mute => options.mute = true,
            #[cfg(feature = "sound")]
            Flag::Wav => options.wav = typed.copied(),
        }
    }
    for name in [seen, still, windowed] {
        if options.wav.is_some() && !name.is_empty() {
            return Err(join(&[name, b" does nothing for --wav; leave one of them out"]));
        }
    }
    if options.frame.is_none() && !still.is_empty() {
        return Err(join(&[still, b" needs --frame N, the frame to write"]));
    }
    if VIEWS && options.view.is_some() && options.average > 1 {
        return Err(join(&[b"--average is for light; leave it or --view out"]));
    }
    if options.frame.is_some() && !windowed.is_empty() {
        return Err(join(&[windowed, b" is for playing in a window; leave it or --frame out"]));
    }
    Ok(Request::Run(options))
}

/// A list of names: that with an index, if there are so many.
type Names = fn(usize) -> Option<&'static str>;

fn quality(i: usize) -> Option<&'static str> {
    Quality::PRESETS.get(i).map(|preset| preset.0)
}

fn view(i: usize) -> Option<&'static str> {
    View::ALL.get(i).map(|view| view.0)
}

fn scene(i: usize) -> Option<&'static str> {
    show::PARTS.get(i).map(|part| part.name)
}

fn list(names: Names) -> impl Iterator<Item = &'static str> {
    (0..).map_while(names)
}

impl Takes {
    /// What was typed, as a number, two for a size; none if it is not what is wanted.
    fn read(self, typed: &[u8]) -> Option<(u64, u64)> {
        let n = match self {
            Takes::Nothing => 0,
            Takes::Number(least, most) => whole(typed, least, most)?,
            Takes::Size => {
                let x = typed.iter().position(|&c| c == b'x')?;
                let height = whole(&typed[x + 1..], 1, LARGEST.1.into())?;
                return Some((whole(&typed[..x], 1, LARGEST.0.into())?, height));
            }
            Takes::Name(names) => list(names).position(|name| name.as_bytes() == typed)? as u64,
            Takes::File => {
                (typed == b"-" || typed.ends_with(b".png") || typed.ends_with(b".ppm")).then_some(0)?
            }
            #[cfg(feature = "sound")]
            Takes::Sound => (typed == b"-" || typed.ends_with(b".wav")).then_some(0)?,
        };
        Some((n, 0))
    }

    /// What is wanted, in words.
    fn words(self) -> Text {
        match self {
            Takes::Nothing => Text::new(),
            Takes::Number(least, most) => {
                join(&[b"a whole number from ", &number(least), b" to ", &number(most)])
            }
            Takes::Size => join(&[b"a width and height from 1x1 to 7680x4320, such as 1280x720"]),
            Takes::Name(names) => one_of(names),
            Takes::File => join(&[b"a name ending in .png or .ppm, or - for standard output"]),
            #[cfg(feature = "sound")]
            Takes::Sound => join(&[b"a name ending in .wav, or - for standard output"]),
        }
    }
}

fn one_of(names: Names) -> Text {
    let mut out = join(&[b"one of"]);
    for name in list(names) {
        out.push(b' ');
        out.extend_from_slice(name.as_bytes());
    }
    out
}

/// What `--help` says of averages, where there are any.
const AVERAGE_HELP: &[u8] = if AVERAGE {
    b"
  --average K      a frame as the mean of K sample patterns, 1 to 1024 (1)"
} else {
    b""
};

/// What `--help` says of views, where there are any.
const VIEW_HELP: &[u8] = if VIEWS {
    b"
  --view NAME      draw a frame's normal, distance (white at 50 units), albedo,
                   sampling, lights (blue: one small light, white: 64) or
                   steps (of its rays, white at 128) instead"
} else {
    b""
};

/// What `--help` says of sound, where there is any.
const SOUND_HELP: &[u8] = if cfg!(feature = "sound") {
    b"
  --mute           play without sound
  --wav FILE       write the sound: .wav, or - for standard output"
} else {
    b""
};

/// The text of `--help`.
pub fn help() -> Text {
    join(&[
        "\
Lúč, a ray-traced intro. Esc ends it.

  luc [options]                      play
  luc --frame N [-o FILE] [options]  write one frame

  -o FILE          .png, .ppm, or - for PPM on standard output
  --size WxH       1x1 to 7680x4320 (1280x720)
  --quality NAME   "
            .as_bytes(),
        &one_of(quality),
        b" (a frame: high)
  --scene NAME     only ",
        &one_of(scene),
        AVERAGE_HELP,
        VIEW_HELP,
        b"
  --from N         start at frame N, 60 a second
  --once           end instead of looping
  --fullscreen     cover the screen",
        SOUND_HELP,
        b"
  --threads N      1 to 256 (all cores)
  --help           this text
  --version        name and version
",
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<'a>(args: &[&'a str]) -> Result<Request<'a>, String> {
        let args: Vec<&OsStr> = args.iter().map(|a| OsStr::new(*a)).collect();
        parse(&args).map_err(|e| String::from_utf8(e).unwrap())
    }

    fn options<'a>(args: &[&'a str]) -> Options<'a> {
        match read(args) {
            Ok(Request::Run(options)) => options,
            other => panic!("{args:?} gave {other:?}"),
        }
    }

    #[test]
    fn no_arguments_play_the_show() {
        let o = options(&[]);
        assert_eq!((o.frame, o.size, o.quality, o.scene), (None, (1280, 720), None, None));
        assert_eq!((o.once, o.from, o.threads, o.fullscreen), (false, 0, 0, false));
    }

    #[test]
    fn flags_come_in_any_order_and_the_last_one_wins() {
        let o = options(&["-o", "-", "--size", "7x5", "--frame", "3", "--threads", "256", "--frame", "4"]);
        assert_eq!((o.frame, o.output, o.size, o.threads), (Some(4), Some(OsStr::new("-")), (7, 5), 256));
    }

    #[test]
    fn names_are_looked_up() {
        for (i, (name, _)) in Quality::PRESETS.iter().enumerate() {
            assert_eq!(options(&["--quality", name]).quality, Some(i));
        }
        for (i, part) in show::PARTS.iter().enumerate() {
            assert_eq!(options(&["--scene", part.name]).scene, Some(i));
        }
    }

    #[test]
    fn help_states_the_real_default_quality_and_stays_short() {
        let text = String::from_utf8(help()).unwrap();
        let default = Quality::PRESETS[Quality::DEFAULT].0;
        assert!(text.contains(&["a frame: ", default].concat()), "{text}");
        assert!(text.len() < 1600, "{} bytes", text.len());
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        let flags = text.lines().filter(|line| line.trim_start().starts_with('-'));
        assert!(
            flags.into_iter().all(|line| line.starts_with("  -")),
            "flags stand below each other: {text}"
        );
    }

    #[test]
    fn mistakes_are_answered_with_what_would_be_right() {
        for (args, part) in [
            (&["--frame"][..], "--frame wants a whole number from 0 to 18446744073709551615 after it"),
            (&["--frame", "--once"], "not '--once'"),
            (&["--size", "1280"], "such as 1280x720, not '1280'"),
            (&["--size", "1x2x3"], "not '1x2x3'"),
            (&["--quality", ""], "one of draft low medium high ultra reference, not ''"),
            (&["--scene", "Mirror"], ", not 'Mirror'"),
            (&["--frame=3"], "'--frame=3' is not an option"),
            (&["-o", "a.png"], "-o needs --frame"),
            (&["--view", "normal"], "--view needs --frame"),
            (
                &["--frame", "1", "--view", "x"],
                "one of normal distance albedo sampling lights steps, not 'x'",
            ),
            (&["--frame", "1", "--view", "normal", "--average", "4"], "--average is for light"),
            (&["--average", "4"], "--average needs --frame"),
            (&["--frame", "1", "--average", "0"], "--average wants a whole number from 1 to 1024, not '0'"),
            (&["--frame", "1", "--fullscreen"], "--fullscreen is for playing"),
        ] {
            let sentence = read(args).unwrap_err();
            // Builds without averages say so, whatever follows.
            let missing = !AVERAGE && args.contains(&"--average");
            let part = if missing { "--average is left out of this small build" } else { part };
            assert!(sentence.contains(part), "{args:?}: {sentence}");
        }
    }

    #[test]
    fn what_a_build_lacks_is_refused_and_not_offered() {
        let help = String::from_utf8(help()).unwrap();
        for (name, value, is_there) in [("--average", "4", AVERAGE), ("--view", "normal", VIEWS)] {
            let found = read(&["--frame", "1", name, value]);
            assert_eq!(help.contains(name), is_there, "{help}");
            if is_there {
                assert!(found.is_ok(), "{found:?}");
            } else {
                let sentence = format!("{name} is left out of this small build; the ordinary one has it");
                assert_eq!(found, Err(sentence));
            }
        }
    }
}
