//! The command line as a user meets it: every mistake gets one sentence and code 2 and leaves nothing
//! behind; every frame is the same picture in every format.
mod support;

use luc::show;
use luc_core::quality::Quality;
use luc_core::render::View;
use std::fs::{read, write};
use std::io::Read;
use std::path::Path;
use std::process::{Output, Stdio};
use support::picture::psnr;
use support::{command, frame, frame_of, names, run};
use tempfile::tempdir;

/// One line on standard error that contains `part`, nothing on standard output, code 2.
fn refused(what: &str, output: &Output, part: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{what}: {said}");
    assert!(said.starts_with("luc: ") && said.ends_with('\n'), "{what}: {said:?}");
    assert_eq!(said.lines().count(), 1, "{what}: {said}");
    assert!(said.contains(part), "{what}: {said}");
    assert!(output.stdout.is_empty(), "{what} wrote to standard output");
}

/// Code 0 and not a word.
fn succeeded(what: &str, output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*said), (Some(0), ""), "{what}");
}

/// What a frame is rendered with unless told otherwise.
fn default_quality() -> &'static str {
    Quality::PRESETS[Quality::DEFAULT].0
}

/// The pixels of a PPM.
fn ppm(file: &[u8]) -> (u32, u32, Vec<u32>) {
    let mut parts = file.splitn(4, |&b| b == b'\n');
    assert_eq!(parts.next(), Some(&b"P6"[..]));
    let size = String::from_utf8(parts.next().unwrap().to_vec()).unwrap();
    let (width, height) = size.split_once(' ').unwrap();
    assert_eq!(parts.next(), Some(&b"255"[..]));
    let bytes = parts.next().unwrap().chunks(3);
    let pixels = bytes.map(|c| u32::from_be_bytes([0, c[0], c[1], c[2]])).collect();
    (width.parse().unwrap(), height.parse().unwrap(), pixels)
}

/// The pixels of a PNG, read by an independent decoder.
fn png(path: &Path) -> (u32, u32, Vec<u32>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let pixels = bytes.chunks(3).map(|c| u32::from_be_bytes([0, c[0], c[1], c[2]])).collect();
    (info.width, info.height, pixels)
}

#[test]
fn every_bad_argument_is_answered_with_what_would_be_right() {
    let number = "a whole number from 0 to 18446744073709551615";
    let size = "a width and height from 1x1 to 7680x4320";
    let place = "choose another place";
    for (args, part) in [
        (&["--frame"][..], number),
        (&["--frame", "x"], number),
        (&["--frame", "-1"], number),
        (&["--frame", ""], number),
        (&["--frame", "1.5"], number),
        (&["--frame", "18446744073709551616"], number),
        (&["--from", "x"], number),
        (&["--from"], number),
        (&["--frame", "0", "--size", "0x0"], size),
        (&["--frame", "0", "--size", "0x720"], size),
        (&["--frame", "0", "--size", "99999x99999"], size),
        (&["--frame", "0", "--size", "7681x4320"], size),
        (&["--frame", "0", "--size", "7680x4321"], size),
        (&["--frame", "0", "--size", "12"], size),
        (&["--frame", "0", "--size", "x"], size),
        (&["--frame", "0", "--size", "1X1"], size),
        (&["--frame", "0", "--size"], size),
        (&["--size", "-1x-1"], size),
        (&["12"], "'12' is not an option; --help lists them"),
        (&["--frme", "0"], "'--frme' is not an option; --help lists them"),
        (&["-h\n\x1b[2J"], "'-h??[2J' is not an option"),
        (&[""], "'' is not an option"),
        (&["--quality", "best"], "one of draft low medium high ultra reference, not 'best'"),
        (&["--quality"], "one of draft"),
        (&["--scene", "silver"], "one of luc"),
        (&["--scene"], "one of luc"),
        (&["--threads", "0"], "a whole number from 1 to 256, not '0'"),
        (&["--threads", "257"], "a whole number from 1 to 256"),
        (&["-o", "a.png"], "-o needs --frame N"),
        (&["--frame", "0", "-o"], ".png or .ppm"),
        (&["--frame", "0", "-o", "a.jpg"], ".png or .ppm"),
        (&["--frame", "0", "-o", "a"], ".png or .ppm"),
        (&["--frame", "0", "-o", "/dev/full"], ".png or .ppm"),
        (&["--frame", "0", "--once"], "--once is for playing"),
        (&["--frame", "0", "--from", "1"], "--from is for playing"),
        (&["--frame", "0", "--fullscreen"], "--fullscreen is for playing"),
        (&["--frame", "0", "-o", "none/a.png"], "'none/a.png': no such directory"),
        (&["--frame", "0", "-o", "none/a.png"], place),
        (&["--frame", "0", "-o", "/dev/full/a.ppm"], place),
        (&["--frame", "0", "-o", "/proc/a.ppm"], place),
        (&["--frame", "0", "-o", "/sys/a.ppm"], place),
    ] {
        let dir = tempdir().unwrap();
        refused(&args.join(" "), &run(dir.path(), args), part);
        assert!(names(dir.path()).is_empty(), "{args:?} left {:?}", names(dir.path()));
    }
}

#[cfg(unix)]
#[test]
fn arguments_that_are_not_text_are_refused_or_taken_as_they_are() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let dir = tempdir().unwrap();
    let bad = OsStr::from_bytes(b"\xff\xfe");
    for flag in ["", "--frame", "--size", "--quality", "--scene", "--threads"] {
        let flags = (!flag.is_empty()).then_some(flag);
        let output = command(dir.path()).args(flags).arg(bad).output().unwrap();
        refused(flag, &output, "not");
    }
    let name = OsStr::from_bytes(b"\xff.ppm");
    let args = ["--frame", "0", "--size", "2x2", "-o"];
    succeeded("a file name", &command(dir.path()).args(args).arg(name).output().unwrap());
    assert!(dir.path().join(name).is_file());
}

#[test]
fn a_missing_display_is_a_sentence_with_a_way_out() {
    let dir = tempdir().unwrap();
    let sentence = "no display: set DISPLAY, or write a frame with --frame N";
    refused("DISPLAY=:9999", &run(dir.path(), &[]), sentence);
    refused("--fullscreen", &run(dir.path(), &["--fullscreen", "--once"]), sentence);
    let unset = command(dir.path()).env_remove("DISPLAY").output().unwrap();
    refused("DISPLAY unset", &unset, sentence);
    let empty = command(dir.path()).env("DISPLAY", "").output().unwrap();
    refused("DISPLAY empty", &empty, sentence);
}

/// Whether the small build is tested, which lacks some options.
fn is_packed() -> bool {
    std::env::var_os("LUC_BIN").is_some()
}

#[test]
fn help_and_version_are_told_on_standard_output() {
    let dir = tempdir().unwrap();
    let help = run(dir.path(), &["--frame", "3", "--help"]);
    succeeded("--help", &help);
    let text = String::from_utf8(help.stdout).unwrap();
    let flags = "--frame -o --size --quality --scene --from --once --fullscreen --threads --help --version";
    let of_sound = if support::sound::has_sound() { " --mute --wav" } else { "" };
    let ordinary = if is_packed() { "" } else { " --average --view" };
    for flag in [flags, of_sound, ordinary].concat().split(' ') {
        assert!(text.contains(flag), "--help does not name {flag}:\n{text}");
    }
    let version = run(dir.path(), &["--version"]);
    succeeded("--version", &version);
    assert_eq!(version.stdout, concat!("luc ", env!("CARGO_PKG_VERSION"), "\n").as_bytes());
    assert!(names(dir.path()).is_empty());
}

#[test]
fn png_ppm_and_pipe_hold_the_same_picture_as_the_library() {
    let dir = tempdir().unwrap();
    for (width, height) in [(1, 1), (7, 5), (1919, 1079)] {
        let size = format!("{width}x{height}");
        let args = |output| ["--frame", "1234", "--quality", "draft", "--size", &size, "-o", output];
        let pipe = run(dir.path(), &args("-"));
        succeeded(&size, &pipe);
        for name in ["a.png", "a.ppm"] {
            let output = run(dir.path(), &args(name));
            succeeded(&size, &output);
            assert!(output.stdout.is_empty());
        }
        let piped = ppm(&pipe.stdout);
        assert!(piped == (width, height, frame(1234, (width, height), "draft")), "{size}: library and pipe");
        assert!(piped == png(&dir.path().join("a.png")), "{size}: PNG and pipe");
        assert!(pipe.stdout == read(dir.path().join("a.ppm")).unwrap(), "{size}: PPM file and pipe");
    }
    assert_eq!(names(dir.path()), ["a.png", "a.ppm"]);
}

#[test]
fn without_a_name_the_file_is_named_after_the_frame() {
    let dir = tempdir().unwrap();
    for frame in ["7", "18446744073709551615"] {
        succeeded(frame, &run(dir.path(), &["--frame", frame, "--size", "16x9"]));
    }
    assert_eq!(names(dir.path()), ["frame-000007.png", "frame-18446744073709551615.png"]);
    let last = png(&dir.path().join("frame-18446744073709551615.png"));
    let default = default_quality();
    assert!(last.2 == frame(u64::MAX, (16, 9), default), "frame n is frame n mod the length");
}

#[test]
fn a_scene_counts_its_own_frames_and_starts_over() {
    let dir = tempdir().unwrap();
    for (index, part) in show::PARTS.iter().enumerate() {
        for n in [0, 100, part.frames - 1, part.frames, u64::MAX] {
            // Smoke takes all its steps up to a late frame; such are among the fingerprints.
            let late = n % part.frames > 100;
            if late && (part.scene)(n % part.frames).smoke.is_some() {
                continue;
            }
            let number = n.to_string();
            let output =
                run(dir.path(), &["--scene", part.name, "--frame", &number, "--size", "32x18", "-o", "-"]);
            let default = default_quality();
            let expected = frame_of(index, n % part.frames, (32, 18), default);
            assert!(ppm(&output.stdout).2 == expected, "{} {n}", part.name);
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let dir = tempdir().unwrap();
    let with = |threads| {
        let args = ["--frame", "2500", "--size", "320x180", "-o", "-", "--threads", threads];
        let output = run(dir.path(), &args);
        succeeded(threads, &output);
        output.stdout
    };
    let one = with("1");
    for threads in ["2", "3", "8", "256"] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_still_averages_sample_patterns_on_any_number_of_threads() {
    let dir = tempdir().unwrap();
    // The packed file has none, and says so.
    if is_packed() {
        let output = run(dir.path(), &["--average", "4", "--frame", "60", "-o", "-"]);
        return refused("--average", &output, "--average is left out of this small build");
    }
    let with = |patterns, threads| {
        let args =
            ["--frame", "60", "--size", "96x54", "-o", "-", "--average", patterns, "--threads", threads];
        let output = run(dir.path(), &args);
        succeeded(patterns, &output);
        ppm(&output.stdout).2
    };
    assert!(with("1", "1") == frame(60, (96, 54), default_quality()), "one pattern is the frame itself");
    let five = with("5", "1");
    assert!(five == with("5", "3"), "the same on three threads");
    let fine = with("64", "2");
    let distance = |picture: &[u32]| psnr(&fine, picture);
    assert!(distance(&five) > distance(&with("1", "2")), "more patterns come closer to very many");
}

#[test]
fn every_view_writes_a_picture_of_its_own() {
    let dir = tempdir().unwrap();
    // The packed file has none, and says so.
    if is_packed() {
        let output = run(dir.path(), &["--view", "normal", "--frame", "60", "-o", "-"]);
        return refused("--view", &output, "--view is left out of this small build");
    }
    let mut pictures = vec![frame(60, (64, 36), default_quality())];
    for (name, _) in View::ALL {
        let output = run(dir.path(), &["--view", name, "--frame", "60", "--size", "64x36", "-o", "-"]);
        succeeded(name, &output);
        let picture = ppm(&output.stdout).2;
        assert!(!pictures.contains(&picture), "{name} is like another picture");
        pictures.push(picture);
    }
}

#[test]
fn every_quality_writes_a_frame() {
    let dir = tempdir().unwrap();
    for (name, _) in Quality::PRESETS {
        let output = run(dir.path(), &["--quality", name, "--frame", "60", "--size", "64x36", "-o", "-"]);
        succeeded(name, &output);
        assert!(ppm(&output.stdout).2 == frame(60, (64, 36), name), "{name}");
    }
}

#[test]
fn an_existing_file_is_replaced_and_a_directory_is_not() {
    let dir = tempdir().unwrap();
    let path = dir.path().join("a.ppm");
    write(&path, "old").unwrap();
    std::fs::create_dir(dir.path().join("d.png")).unwrap();
    succeeded("replace", &run(dir.path(), &["--frame", "0", "--size", "2x2", "-o", "a.ppm"]));
    assert_eq!(ppm(&read(&path).unwrap()).2, frame(0, (2, 2), default_quality()));
    refused("a directory", &run(dir.path(), &["--frame", "0", "-o", "d.png"]), "it is a directory");
    assert_eq!(names(dir.path()), ["a.ppm", "d.png"]);
}

#[cfg(target_os = "linux")]
mod linux {
    use super::*;
    use std::fs::File;
    use std::os::unix::fs::symlink;

    #[test]
    fn a_full_disk_and_a_closed_pipe_are_told() {
        let dir = tempdir().unwrap();
        let mut args = vec!["--frame", "0", "--size", "640x360", "-o", "-"];
        for option in [&args[..], &["--help"], &["--version"]] {
            let full = File::options().write(true).open("/dev/full").unwrap();
            let output = command(dir.path()).args(option).stdout(full).output().unwrap();
            refused("stdout on /dev/full", &output, "cannot write standard output: no space left");
        }
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = command(dir.path()).args(&args).stdout(writer).output().unwrap();
        refused("a closed pipe", &output, "the reader has closed the pipe");

        symlink("/dev/full", dir.path().join("full.png")).unwrap();
        *args.last_mut().unwrap() = "full.png";
        refused("a device", &run(dir.path(), &args), "cannot write 'full.png': no space left");
        assert_eq!(names(dir.path()), ["full.png"]);
        assert!(dir.path().join("full.png").is_symlink(), "the link stays");
    }

    #[test]
    fn a_write_that_fails_halfway_leaves_the_older_picture_alone() {
        let dir = tempdir().unwrap();
        write(dir.path().join("old.ppm"), "old").unwrap();
        for name in ["new.ppm", "old.ppm"] {
            // The limit on file sizes (256 kB, room for the unpacked program) stands in for a disk that
            // fills up while writing.
            let script = "trap '' XFSZ; ulimit -f 512; exec \"$@\"";
            let output = std::process::Command::new("sh")
                .args(["-c", script, "sh"])
                .arg(support::luc())
                .args(["--frame", "0", "--size", "640x360", "-o", name])
                .current_dir(dir.path())
                .output()
                .unwrap();
            refused(name, &output, "cannot write");
            assert_eq!(names(dir.path()), ["old.ppm"], "after {name}");
            assert_eq!(read(dir.path().join("old.ppm")).unwrap(), b"old");
        }
    }

    #[test]
    fn a_link_stays_a_link_and_a_pipe_is_written_directly() {
        let dir = tempdir().unwrap();
        write(dir.path().join("file.ppm"), "old").unwrap();
        symlink("file.ppm", dir.path().join("link.ppm")).unwrap();
        let args = |name| ["--frame", "0", "--size", "2x2", "-o", name];
        succeeded("link", &run(dir.path(), &args("link.ppm")));
        assert!(dir.path().join("link.ppm").is_symlink());
        assert_eq!(ppm(&read(dir.path().join("file.ppm")).unwrap()).2, frame(0, (2, 2), default_quality()));

        let pipe = dir.path().join("pipe.ppm");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let mut child = command(dir.path()).args(args("pipe.ppm")).stderr(Stdio::piped()).spawn().unwrap();
        let mut bytes = Vec::new();
        File::open(&pipe).unwrap().read_to_end(&mut bytes).unwrap();
        assert!(child.wait().unwrap().success());
        assert_eq!(ppm(&bytes).2, frame(0, (2, 2), default_quality()));
        assert_eq!(names(dir.path()), ["file.ppm", "link.ppm", "pipe.ppm"]);
    }

    /// Damage of the packed file itself; that of its launcher, bit by bit, is tested where it is made.
    #[test]
    fn a_damaged_packed_file_says_so_and_ends() {
        let whole = read(support::luc()).unwrap();
        // Neither an ordinary build nor the unpacked twin looks at itself.
        if !is_packed() || whole.len() > 65_536 {
            return;
        }
        let dir = tempdir().unwrap();
        let damaged = dir.path().join("damaged");
        // The launcher's first part, which nothing guards, is about a kilobyte.
        for k in 1..=8 {
            let at = 2000 + k * (whole.len() - 2000) / 9;
            let mut bytes = whole.clone();
            if k % 2 == 0 {
                bytes.truncate(at);
            } else {
                bytes[at] ^= 1 << (k % 8);
            }
            write(&damaged, bytes).unwrap();
            std::fs::set_permissions(&damaged, std::fs::metadata(support::luc()).unwrap().permissions())
                .unwrap();
            let output =
                std::process::Command::new("timeout").arg("60").arg(&damaged).arg("--version").output();
            let Output { status, stdout, stderr } = output.unwrap();
            let said = String::from_utf8_lossy(&stderr);
            assert_eq!((status.code(), &*said), (Some(3), "luc: damaged file\n"), "byte {at}, damage {k}");
            assert!(stdout.is_empty(), "byte {at}, damage {k}");
        }
    }

    #[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
    #[test]
    fn a_processor_without_avx2_is_told() {
        support::require(&["qemu-x86_64"]);
        let output = std::process::Command::new("qemu-x86_64")
            .args(["-cpu", "Nehalem"])
            .arg(support::luc())
            .arg("--version")
            .output()
            .unwrap();
        refused("Nehalem", &output, "needs a processor with AVX2");
    }
}
