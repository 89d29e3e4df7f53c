//! A display of one's own and what a user does there: look, press keys, close windows.
//!
//! xdotool presses real keys (XTEST) and xwd looks. The message by which a window manager closes a
//! window is sent over a connection of our own, because no tool sends it.

use super::{luc, require};
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use x11rb::protocol::xproto::{ClientMessageEvent, ConnectionExt, EventMask};

/// A virtual screen; gone with this value.
pub struct Screen {
    xvfb: Child,
    number: u32,
}

impl Screen {
    /// Starts Xvfb on a display of its own and waits until it answers.
    ///
    /// `-noreset`: a server that starts anew when its last client leaves refuses the next one meanwhile.
    /// Numbers follow from the process, and a server that finds its number locked gives up. Left to choose
    /// one, servers that start and end at the same time take each other's sockets away.
    pub fn new(width: u32, height: u32) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        require(&["Xvfb", "xdotool", "xwd"]);
        let size = format!("{width}x{height}x24");
        for _ in 0..20 {
            let number = 1000 + (std::process::id() * 37 + NEXT.fetch_add(1, Ordering::Relaxed)) % 50_000;
            let mut xvfb = Command::new("Xvfb")
                .args([&format!(":{number}"), "-screen", "0", &size, "-nolisten", "tcp", "-noreset"])
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .expect("Xvfb starts");
            let start = Instant::now();
            while xvfb.try_wait().unwrap().is_none() && start.elapsed() < Duration::from_secs(20) {
                let answer = Command::new("xdotool")
                    .arg("getdisplaygeometry")
                    .env("DISPLAY", format!(":{number}"))
                    .output()
                    .expect("xdotool starts");
                if answer.status.success() {
                    return Screen { xvfb, number };
                }
                std::thread::sleep(Duration::from_millis(20));
            }
            let _ = xvfb.kill();
            let _ = xvfb.wait();
        }
        panic!("no display of 20 came up");
    }

    /// Starts the player and waits for its window.
    pub fn play(&self, args: &[&str]) -> Player<'_> {
        self.play_on(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/support/silent.conf")), args)
    }

    /// Starts the player, with its sound card as the ALSA configuration `card` says, and waits for its window.
    pub fn play_on(&self, card: &Path, args: &[&str]) -> Player<'_> {
        let mut child = Command::new(luc())
            .args(args)
            .env("ALSA_CONFIG_PATH", card)
            .env("DISPLAY", self.name())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the player starts");
        let start = Instant::now();
        loop {
            if let Some(window) = self.xdotool(&["search", "--onlyvisible", "--name", "^L"]).lines().next() {
                return Player { screen: self, window: window.to_owned(), child };
            }
            if let Some(status) = child.try_wait().unwrap() {
                let mut said = String::new();
                child.stderr.unwrap().read_to_string(&mut said).unwrap();
                panic!("the player ended without a window: {status} {said}");
            }
            assert!(start.elapsed() < Duration::from_secs(20), "no window");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn name(&self) -> String {
        format!(":{}", self.number)
    }

    fn tool(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        command.env("DISPLAY", self.name()).env("LC_ALL", "C.UTF-8");
        command
    }

    /// What xdotool answers.
    pub fn xdotool(&self, args: &[&str]) -> String {
        String::from_utf8(self.tool("xdotool").args(args).output().unwrap().stdout).unwrap()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.xvfb.kill();
        let _ = self.xvfb.wait();
    }
}

/// A running player; killed with this value if it has not ended.
pub struct Player<'a> {
    screen: &'a Screen,
    window: String,
    child: Child,
}

impl Player<'_> {
    /// xdotool's `command` for the window.
    pub fn window(&self, command: &str, rest: &[&str]) -> String {
        self.screen.xdotool(&[&[command, &self.window], rest].concat())
    }

    /// The window's width and height.
    pub fn size(&self) -> (usize, usize) {
        let text = self.screen.xdotool(&["getwindowgeometry", "--shell", &self.window]);
        let field = |name: &str| {
            let line = text.lines().find_map(|line| line.strip_prefix(name)).expect("a geometry");
            line.parse().unwrap()
        };
        (field("WIDTH="), field("HEIGHT="))
    }

    /// What the window shows: width and 0RGB pixels.
    pub fn look(&self) -> (usize, Vec<u32>) {
        let file = self.screen.tool("xwd").args(["-silent", "-id", &self.window]).output().unwrap().stdout;
        let field = |i: usize| u32::from_be_bytes(file[4 * i..4 * i + 4].try_into().unwrap()) as usize;
        let (header, width, height, lsb_first, bits, stride, colours) =
            (field(0), field(4), field(5), field(7) == 0, field(11), field(12), field(19));
        assert!(lsb_first && bits == 32, "a picture of a 24 bit screen");
        let rows = file[header + 12 * colours..].chunks(stride).take(height);
        let pixels = rows.flat_map(|row| {
            row[..4 * width].chunks(4).map(|p| u32::from_le_bytes([p[0], p[1], p[2], 0])).collect::<Vec<_>>()
        });
        (width, pixels.collect())
    }

    /// Looks until the window shows something of the show.
    pub fn look_at_show(&self) -> (usize, Vec<u32>) {
        // The loader's bar has two colours and black.
        self.look_for(4)
    }

    /// Looks until the window shows at least so many colours.
    pub fn look_for(&self, colours: usize) -> (usize, Vec<u32>) {
        let start = Instant::now();
        loop {
            let (width, pixels) = self.look();
            let mut found = pixels.clone();
            found.sort_unstable();
            found.dedup();
            if found.len() >= colours {
                return (width, pixels);
            }
            assert!(start.elapsed() < Duration::from_secs(20), "the window stays blank");
        }
    }

    /// Presses and releases Esc, faster than a frame.
    pub fn tap_escape(&self) {
        // Without a window manager the keyboard belongs to the window under the pointer.
        self.screen.xdotool(&[
            "mousemove",
            "--window",
            &self.window,
            "1",
            "1",
            "key",
            "--delay",
            "0",
            "Escape",
        ]);
    }

    /// Closes the window as a window manager does.
    pub fn close(&self) {
        let (x, _) = x11rb::connect(Some(&self.screen.name())).unwrap();
        let atom = |name: &[u8]| x.intern_atom(false, name).unwrap().reply().unwrap().atom;
        let data = [atom(b"WM_DELETE_WINDOW"), 0, 0, 0, 0];
        let window = self.window.parse().unwrap();
        let message = ClientMessageEvent::new(32, window, atom(b"WM_PROTOCOLS"), data);
        x.send_event(false, window, EventMask::NO_EVENT, message).unwrap().check().unwrap();
    }

    /// Checks that the end comes within two seconds and is a quiet one.
    pub fn ends(&mut self, how: &str) {
        self.ends_within(how, Duration::from_secs(2));
    }

    /// Waits for the end and checks that it is a quiet one: code 0 and not a word.
    pub fn ends_within(&mut self, how: &str, limit: Duration) {
        assert_eq!(self.last_words(how, limit), "", "{how}");
    }

    /// Waits for the end, checks that its code is 0, and returns what the player has said.
    pub fn last_words(&mut self, how: &str, limit: Duration) -> String {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < limit, "{how}: still running after {limit:?}");
            std::thread::sleep(Duration::from_millis(5));
        };
        let mut said = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        self.child.stdout.take().unwrap().read_to_string(&mut said).unwrap();
        assert_eq!(status.code(), Some(0), "{how}: {said}");
        said
    }
}

impl Drop for Player<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
