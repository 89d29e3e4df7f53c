//! A frame is a pure function: nothing but show, frame, size and quality changes a byte of it.
//!
//! Not the number of threads, not what the renderer drew before, not the lists of what tiles can't
//! meet, not the build: the executable (`LUC_BIN`, or the one cargo built) must write the golden
//! frames too. See golden.rs for how to compare release, SSE2 and packed builds.
mod support;

use luc::show;
use luc_core::math::fingerprint::Fingerprint;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use support::crossing::{self, Backdrop, Thing};
use support::golden::{self, FINGERPRINTS, FRAMES, SIZE, VALUE_SIZE, VALUES};
use support::picture::Picture;
use support::run;

/// Renders frame `n` of the show on `threads` threads.
fn on_threads(renderer: &mut Renderer, threads: usize, n: u64, size: (u32, u32), preset: &str) -> Picture {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let quality = Quality::named(preset).unwrap();
    let mut pixels = vec![0; (size.0 * size.1) as usize];
    pool.install(|| show::frame(renderer, n, size, &quality, &mut pixels));
    Picture { width: size.0, height: size.1, pixels }
}

/// Renders frame `n` of the show with a renderer of its own.
fn alone(n: u64, size: (u32, u32), quality: &Quality) -> Picture {
    let mut pixels = vec![0; (size.0 * size.1) as usize];
    show::frame(&mut Renderer::default(), n, size, quality, &mut pixels);
    Picture { width: size.0, height: size.1, pixels }
}

#[track_caller]
fn same(expected: &Picture, actual: &Picture, what: &str, replay: &str) {
    if let Some(difference) = expected.compare(actual) {
        panic!("{what}: {difference}\n  replay: {replay}");
    }
}

/// [`golden::replay`] for a frame of the whole show.
fn replay(n: u64, preset: &str, size: (u32, u32)) -> String {
    let (part, local) = show::at(n);
    golden::replay(show::PARTS[part].name, local, preset, size)
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    for (part, frame) in FRAMES {
        let n = golden::global(part, frame);
        let one = on_threads(&mut Renderer::default(), 1, n, SIZE, "high");
        for threads in [2, 3, 8] {
            let many = on_threads(&mut Renderer::default(), threads, n, SIZE, "high");
            let command = replay(n, "high", SIZE) + &format!(" --threads {threads}");
            same(&one, &many, &format!("{part} {frame} on {threads} threads"), &command);
        }
    }
}

#[test]
fn what_was_drawn_before_changes_no_byte() {
    let mut used = Renderer::default();
    let [mirror, gold] = ["mirror", "gold"].map(|part| golden::global(part, 0));
    // From part to part and back, larger and smaller, better and worse.
    let visits = [
        (mirror, "high", (320, 180)),
        (gold + 1800, "high", (320, 180)),
        (mirror + 20, "draft", (97, 201)),
        (gold + 20, "ultra", (320, 180)),
        (mirror + 20, "high", (640, 360)),
        (gold, "low", (1, 1)),
        (mirror + 495, "reference", (65, 63)),
        (gold + 1800, "medium", (320, 180)),
        (mirror, "high", (320, 180)),
    ];
    for (i, (n, preset, size)) in visits.into_iter().enumerate() {
        let quality = Quality::named(preset).unwrap();
        let mut pixels = vec![!0; (size.0 * size.1) as usize];
        show::frame(&mut used, n, size, &quality, &mut pixels);
        let again = Picture { width: size.0, height: size.1, pixels };
        same(&alone(n, size, &quality), &again, &format!("visit {i}: frame {n}"), &replay(n, preset, size));
    }
}

#[test]
fn leaving_out_what_a_tile_cannot_meet_changes_no_byte() {
    for (preset, quality) in Quality::PRESETS {
        // Sixteen samples a pixel take their time.
        let size = if quality.block == 1 { (96, 54) } else { SIZE };
        for (part, frame) in
            [("mirror", 0), ("mirror", 495), ("mirror", 1275), ("gold", 0), ("gold", 855), ("gold", 1500)]
        {
            let n = golden::global(part, frame);
            let all = alone(n, size, &Quality { cull: false, ..quality });
            let some = alone(n, size, &Quality { cull: true, ..quality });
            same(&all, &some, &format!("{part} {frame} {preset}, culled"), &replay(n, preset, size));
            if quality.block > 1 {
                let all = alone(n, size, &Quality { cull: false, ..quality.every_pixel() });
                let some = alone(n, size, &Quality { cull: true, ..quality.every_pixel() });
                let what = format!("{part} {frame} {preset}, every pixel, culled");
                same(&all, &some, &what, &replay(n, preset, size));
            }
        }
    }
}

#[test]
fn leaving_out_changes_no_byte_of_small_things_either() {
    let quality = Quality::named("high").unwrap();
    let mut renderer = Renderer::default();
    for thing in [Thing::Bar, Thing::EndlessBar, Thing::Ball, Thing::Triangle, Thing::Shadow] {
        for backdrop in [Backdrop::Dark, Backdrop::Floor, Backdrop::Wall, Backdrop::Globe] {
            for frame in [0, 23, 31, 59] {
                let scene = crossing::scene(thing, backdrop, frame, true);
                let mut picture = |cull| {
                    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
                    renderer.frame(&scene, 0, SIZE, &Quality { cull, ..quality.every_pixel() }, &mut pixels);
                    Picture { width: SIZE.0, height: SIZE.1, pixels }
                };
                let what = format!("{thing:?} over {backdrop:?}, frame {frame}, culled");
                let call =
                    format!("crossing::scene(Thing::{thing:?}, Backdrop::{backdrop:?}, {frame}, true)");
                same(&picture(false), &picture(true), &what, &call);
            }
        }
    }
}

#[test]
fn the_show_is_an_endless_loop() {
    let quality = Quality::named("high").unwrap();
    for n in [0, 1, show::start(1) - 1, show::start(1), show::FRAMES - 1] {
        let once = alone(n, SIZE, &quality);
        for round in [1, 2, 1_000_003] {
            let later = n + round * show::FRAMES;
            let what = format!("frame {n} and {later}");
            same(&once, &alone(later, SIZE, &quality), &what, &replay(n, "high", SIZE));
        }
    }
    // 1 hour, 30 days and 100 years on, at the same place of the loop.
    for hours in [1, 30 * 24, 100 * 8766] {
        let frames = hours * 3600 * 60;
        for n in [0, show::start(1) + 77, show::start(show::PARTS.len() - 1) + 300] {
            let later = n + frames - frames % show::FRAMES;
            let what = format!("frame {n} and {later}, {hours} hours on");
            same(&alone(n, SIZE, &quality), &alone(later, SIZE, &quality), &what, &replay(n, "high", SIZE));
        }
    }
    let last = alone(u64::MAX, SIZE, &quality);
    let same_frame = alone(u64::MAX % show::FRAMES, SIZE, &quality);
    same(&same_frame, &last, "frame u64::MAX", &replay(u64::MAX, "high", SIZE));
}

#[test]
fn odd_sizes_are_whole_pictures_on_any_number_of_threads() {
    for size in [(1, 1), (7, 5), (1919, 1079), (1, 300), (300, 1), (65, 64)] {
        for (part, frame) in [("mirror", 495), ("gold", 1695)] {
            if size.0 > 1000 && part == "gold" {
                continue;
            }
            let n = golden::global(part, frame);
            let one = on_threads(&mut Renderer::default(), 1, n, size, "high");
            let many = on_threads(&mut Renderer::default(), 3, n, size, "high");
            same(&one, &many, &format!("{part} {frame} at {size:?}"), &replay(n, "high", size));
            // No pixel is left as it was: a value that a frame can't hold.
            let mut pixels = vec![!0; (size.0 * size.1) as usize];
            let quality = Quality::named("high").unwrap();
            show::frame(&mut Renderer::default(), n, size, &quality, &mut pixels);
            let missed = pixels.iter().position(|&p| p > 0x00ff_ffff);
            assert_eq!(missed, None, "{part} {frame} at {size:?}: a pixel was not written");
        }
    }
}

/// What the executable writes for a frame.
fn executable(part: &str, frame: u64, preset: &str, (width, height): (u32, u32)) -> Picture {
    let dir = tempfile::tempdir().unwrap();
    let (frame, size) = (frame.to_string(), format!("{width}x{height}"));
    let args = [
        "--scene",
        part,
        "--frame",
        &frame,
        "--size",
        &size,
        "--quality",
        preset,
        "--threads",
        "2",
        "-o",
        "-",
    ];
    let output = run(dir.path(), &args);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(
        (output.status.code(), &*said),
        (Some(0), ""),
        "{} {}",
        support::luc().display(),
        args.join(" ")
    );
    Picture::read_ppm(&output.stdout).unwrap_or_else(|e| panic!("{}: {e}", args.join(" ")))
}

#[test]
fn the_executable_writes_the_golden_frames() {
    for (part, frame) in FRAMES {
        let kept = Picture::read_png(&golden::path(part, frame)).unwrap();
        let written = executable(part, frame, "high", SIZE);
        let command = golden::replay(part, frame, "high", SIZE);
        same(&kept, &written, &format!("{part} {frame} by {}", support::luc().display()), &command);
    }
}

#[test]
fn frames_of_all_parts_have_one_value_on_any_number_of_threads() {
    let kept = std::fs::read_to_string(golden::directory().join("values.txt")).unwrap();
    for (part, frame) in VALUES {
        for threads in [1, 2, 3, 8] {
            let n = golden::global(part, frame);
            let picture = on_threads(&mut Renderer::default(), threads, n, VALUE_SIZE, "high");
            let line =
                golden::line((part, frame, "high", VALUE_SIZE), Fingerprint::of_pixels(&picture.pixels));
            let command = golden::replay(part, frame, "high", VALUE_SIZE);
            assert!(
                kept.contains(&line),
                "values.txt has not, on {threads} threads: {line}  replay: {command}"
            );
        }
    }
}

#[test]
fn the_executable_writes_frames_with_the_kept_fingerprints() {
    let read = |file| std::fs::read_to_string(golden::directory().join(file)).unwrap();
    let kept = read("fingerprints.txt") + &read("values.txt");
    let values = VALUES.map(|(part, n)| (part, n, "high", VALUE_SIZE));
    for frame in FINGERPRINTS.into_iter().chain(values) {
        let (part, n, preset, size) = frame;
        let line = golden::line(frame, Fingerprint::of_pixels(&executable(part, n, preset, size).pixels));
        let command = golden::replay(part, n, preset, size);
        assert!(kept.contains(&line), "no table holds {line}  replay: {command}");
    }
}
