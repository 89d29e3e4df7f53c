//! The window as a user meets it, on a real display: it shows the show's frames in time, and every way
//! of ending it ends it at once, with code 0.
#![cfg(target_os = "linux")]
mod support;

use std::ops::Range;
use std::time::{Duration, Instant};
use support::x11::{Player, Screen};
use support::{frame, golden};

/// Mean difference of two pictures' channels, of 255.
fn difference(a: &[u32], b: &[u32]) -> f64 {
    assert_eq!(a.len(), b.len());
    let channels = |p: &u32| p.to_be_bytes();
    let sum: u64 = a
        .iter()
        .flat_map(channels)
        .zip(b.iter().flat_map(channels))
        .map(|(a, b)| u64::from(a.abs_diff(b)))
        .sum();
    sum as f64 / (3 * a.len()) as f64
}

/// Which of the draft frames in `range` of the part mirror a window of 320x180 shows.
fn recognise(pixels: &[u32], range: Range<u64>) -> u64 {
    let rated = range
        .clone()
        .map(|n| (difference(pixels, &frame(golden::global("mirror", n), (320, 180), "draft")), n));
    let (error, n) = rated.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    assert!(error < 0.5, "nothing like the frames {range:?}: the nearest, {n}, is {error} levels off");
    n
}

#[test]
fn the_window_shows_the_frames_of_the_show_at_sixty_a_second() {
    const FROM: u64 = 600;
    let screen = Screen::new(800, 600);
    let begun = Instant::now();
    let args = ["--scene", "mirror", "--quality", "draft", "--size", "320x180", "--from", "600"];
    let mut player = screen.play(&args);
    assert_eq!(player.window("getwindowname", &[]).trim(), "Lúč");
    assert_eq!(player.size(), (320, 180));
    let mut seen = Vec::new();
    for _ in 0..2 {
        let before = begun.elapsed();
        let (_, pixels) = player.look_at_show();
        seen.push((before, begun.elapsed(), pixels));
        std::thread::sleep(Duration::from_millis(700));
    }
    player.tap_escape();
    player.ends("Esc while playing");

    let frames = |time: Duration| (time.as_secs_f64() * 60.0) as u64;
    let latest = FROM + frames(seen[1].1) + 2;
    let first = recognise(&seen[0].2, FROM..latest);
    let second = recognise(&seen[1].2, first..latest);
    // Looking takes time, and a busy machine shows a frame late, but never too early.
    let most = frames(seen[1].1 - seen[0].0) + 2;
    let least = frames(seen[1].0 - seen[0].1).saturating_sub(20);
    let passed = second - first;
    assert!((least..=most).contains(&passed), "{passed} frames passed, expected {least} to {most}");
}

/// Starts the player with `args` on a small screen and ends it by `end` as soon as its window is there,
/// once while it loads and once while it plays.
fn ended_by(how: &str, end: impl Fn(&Player)) {
    let screen = Screen::new(640, 480);
    let mut player = screen.play(&[]);
    end(&player);
    player.ends(&format!("{how} while loading"));
    let mut player = screen.play(&["--quality", "draft"]);
    player.look_at_show();
    end(&player);
    player.ends(&format!("{how} while playing"));
}

#[test]
fn escape_ends_it() {
    ended_by("Esc", |player| player.tap_escape());
}

#[test]
fn closing_the_window_ends_it() {
    ended_by("the window manager's close", |player| player.close());
}

#[test]
fn taking_the_window_away_ends_it() {
    ended_by("windowkill", |player| drop(player.window("windowkill", &[])));
    ended_by("windowclose", |player| drop(player.window("windowclose", &[])));
}

#[test]
fn escape_does_not_wait_for_a_frame_that_takes_long() {
    let screen = Screen::new(2560, 1440);
    let mut player = screen.play(&["--size", "2560x1440", "--quality", "reference", "--threads", "1"]);
    std::thread::sleep(Duration::from_millis(500));
    player.tap_escape();
    player.ends("Esc during a long frame");
}

/// A first frame of several seconds, so that however fast the machine is there is something to wait for.
#[test]
fn a_bar_is_seen_until_the_first_frame_is_there() {
    const SIZE: (usize, usize) = (1280, 720);
    const LIT: u32 = 0xe8_b0_60;
    const DIM: u32 = 0x38_2b_1a;
    let screen = Screen::new(SIZE.0 as u32, SIZE.1 as u32);
    let mut player = screen.play(&["--scene", "facets", "--quality", "reference", "--threads", "1"]);
    let (width, pixels) = player.look_for(2);
    assert_eq!((width, pixels.len()), (SIZE.0, SIZE.0 * SIZE.1));
    // Half as wide as the window, and three rows thick.
    let (left, right, rows) = (320, 960, 358..361);
    let done = pixels.iter().filter(|&&p| p == LIT).count() / rows.len();
    assert!(done == 0 || done == 320, "none or one of two steps, not {done} px");
    for (i, &pixel) in pixels.iter().enumerate() {
        let (x, y) = (i % SIZE.0, i / SIZE.0);
        let on_bar = rows.contains(&y) && (left..right).contains(&x);
        let expected = if !on_bar { 0 } else { [DIM, LIT][usize::from(x < left + done)] };
        assert_eq!(pixel, expected, "at ({x}, {y}) with {done} px done");
    }
    player.tap_escape();
    player.ends("Esc before the first frame");
}

#[test]
fn playing_once_ends_by_itself_after_the_last_frame() {
    let screen = Screen::new(640, 480);
    let args = ["--once", "--scene", "mirror", "--from", "1740", "--quality", "draft", "--size", "160x90"];
    let begun = Instant::now();
    let mut player = screen.play(&args);
    player.ends_within("--once three seconds before the end", Duration::from_secs(10));
    assert!(
        begun.elapsed() > Duration::from_secs(3),
        "it ended before its time, after {:?}",
        begun.elapsed()
    );
}

/// Rows at the top that are black from end to end.
fn black_rows((width, pixels): &(usize, Vec<u32>)) -> usize {
    pixels.chunks(*width).take_while(|row| row.iter().all(|&p| p == 0)).count()
}

/// Looks until the picture has `bar` black rows above and below it; the picture itself may begin dark.
fn letterboxed(player: &Player, bar: usize) {
    let start = Instant::now();
    loop {
        let (width, mut pixels) = player.look_at_show();
        let above = black_rows(&(width, pixels.clone()));
        pixels.reverse();
        let below = black_rows(&(width, pixels.clone()));
        if (bar..bar + 3).contains(&above) && (bar..bar + 3).contains(&below) {
            return;
        }
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "expected {bar} black rows above and below, saw {above} and {below}"
        );
    }
}

#[test]
fn a_window_of_another_shape_keeps_the_pictures_shape() {
    let screen = Screen::new(1280, 1024);
    let args = ["--scene", "gold", "--quality", "draft", "--size", "320x180", "--from", "900"];
    let mut player = screen.play(&args);
    player.look_at_show();
    player.window("windowsize", &["640", "600"]);
    letterboxed(&player, 120);
    assert_eq!(player.size(), (640, 600));
    player.tap_escape();
    player.ends("Esc after resizing");
}

#[test]
fn fullscreen_covers_the_screen() {
    let screen = Screen::new(640, 480);
    let mut player = screen.play(&["--fullscreen", "--quality", "draft", "--scene", "gold", "--from", "900"]);
    assert_eq!(player.size(), (640, 480));
    letterboxed(&player, 60);
    player.tap_escape();
    player.ends("Esc in full screen");
}

#[test]
fn a_picture_larger_than_the_screen_gets_a_window_that_fits() {
    let screen = Screen::new(640, 480);
    let mut player = screen.play(&["--size", "7680x4320", "--quality", "draft"]);
    assert_eq!(player.size(), (640, 360));
    player.look_at_show();
    player.tap_escape();
    player.ends("Esc");
}
