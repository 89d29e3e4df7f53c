//! `lab view` on a real display: keys do what the help says.
#![cfg(target_os = "linux")]

#[path = "../../../tests/support/x11.rs"]
#[allow(dead_code, reason = "the player's own tests use the rest")]
mod x11;

use std::path::PathBuf;
use std::time::{Duration, Instant};
use x11::{Player, Screen};

/// The program under test, as the display's support asks for it.
fn luc() -> PathBuf {
    env!("CARGO_BIN_EXE_luc-lab").into()
}

/// Fails with what to install unless all of `tools` are found.
fn require(tools: &[&str]) {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = |tool: &&&str| std::env::split_paths(&path).any(|dir| dir.join(tool).is_file());
    assert!(tools.iter().all(|tool| found(&tool)), "install xvfb xdotool x11-apps");
}

/// Presses a key.
fn press(screen: &Screen, key: &str) {
    // Without a window manager the keyboard belongs to the window under the pointer.
    let window = ["search", "--onlyvisible", "--name", "^L", "mousemove", "--window", "%1", "5", "5"];
    screen.xdotool(&[&window[..], &["key", key]].concat());
}

/// Looks until the window shows something else than `before`.
fn changed(player: &Player, before: &[u32], what: &str) -> Vec<u32> {
    let start = Instant::now();
    loop {
        let (_, pixels) = player.look();
        if pixels != before {
            // Figures follow with the next picture.
            std::thread::sleep(Duration::from_millis(150));
            return player.look().1;
        }
        assert!(start.elapsed() < Duration::from_secs(20), "{what} changes nothing");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn keys_change_the_picture_and_escape_ends_it() {
    let screen = Screen::new(640, 480);
    let args =
        ["view", "--part", "mirror", "--from", "600", "--size", "320x180", "--quality", "draft", "--paused"];
    let mut player = screen.play(&args);
    assert_eq!(player.size(), (320, 180));
    player.look_at_show();
    std::thread::sleep(Duration::from_millis(300));
    let (_, mut seen) = player.look();
    let still = player.look().1;
    assert!(still == seen, "a paused picture stands still");
    for (key, what) in [
        ("o", "hiding the figures"),
        ("period", "a step"),
        ("Right", "a second on"),
        ("v", "the next view"),
        ("Prior", "the part's beginning"),
        ("h", "help"),
        ("f", "nothing"),
        ("w", "the free camera"),
    ] {
        press(&screen, key);
        if what != "nothing" {
            seen = changed(&player, &seen, what);
        }
    }
    press(&screen, "Escape");
    player.ends("Esc");
}
