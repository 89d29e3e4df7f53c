//! A display of one's own and what a user does there: look, press keys, close windows.
//!
//! xdotool presses real keys (XTEST) and xwd looks. The message by which a window manager closes a
//! window is sent by hand, over the display's socket, because no tool sends it.

use super::{luc, require};
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

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
        let mut child = Command::new(luc())
            .args(args)
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

    /// Looks until the window shows something.
    pub fn look_at_show(&self) -> (usize, Vec<u32>) {
        let start = Instant::now();
        loop {
            let (width, pixels) = self.look();
            // The loader's bar has two colours and black.
            let mut colours = pixels.clone();
            colours.sort_unstable();
            colours.dedup();
            if colours.len() > 3 {
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
        let mut x = X11::connect(self.screen.number);
        let protocols = x.atom("WM_PROTOCOLS");
        let delete = x.atom("WM_DELETE_WINDOW");
        x.message(self.window.parse().unwrap(), protocols, delete);
    }

    /// Checks that the end comes within two seconds and is a quiet one.
    pub fn ends(&mut self, how: &str) {
        self.ends_within(how, Duration::from_secs(2));
    }

    /// Waits for the end and checks that it is a quiet one: code 0 and not a word.
    pub fn ends_within(&mut self, how: &str, limit: Duration) {
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
        assert_eq!((status.code(), &*said), (Some(0), ""), "{how}");
    }
}

impl Drop for Player<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// As much of the X11 protocol as a message to a window takes.
struct X11(UnixStream);

impl X11 {
    fn connect(number: u32) -> Self {
        // Where X11 puts the sockets of all local displays.
        let mut stream = UnixStream::connect(format!("/tmp/.X11-unix/X{number}")).unwrap();
        stream.write_all(&[b'l', 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0]).unwrap(); // little endian, 11.0
        let mut head = [0; 8];
        stream.read_exact(&mut head).unwrap();
        assert_eq!(head[0], 1, "the display lets us in");
        let mut rest = vec![0; 4 * usize::from(u16::from_le_bytes([head[6], head[7]]))];
        stream.read_exact(&mut rest).unwrap();
        X11(stream)
    }

    fn reply(&mut self) -> [u8; 32] {
        let mut reply = [0; 32];
        self.0.read_exact(&mut reply).unwrap();
        assert_eq!(reply[0], 1, "a reply, not an error");
        reply
    }

    fn atom(&mut self, name: &str) -> u32 {
        let words = name.len().div_ceil(4);
        let mut request = vec![16, 0, (2 + words) as u8, 0, name.len() as u8, 0, 0, 0]; // InternAtom
        request.extend_from_slice(name.as_bytes());
        request.resize(8 + 4 * words, 0);
        self.0.write_all(&request).unwrap();
        let reply = self.reply();
        u32::from_le_bytes(reply[8..12].try_into().unwrap())
    }

    fn message(&mut self, window: u32, kind: u32, value: u32) {
        let mut request = vec![25, 0, 11, 0]; // SendEvent
        request.extend_from_slice(&window.to_le_bytes());
        request.extend_from_slice(&[0, 0, 0, 0, 33, 32, 0, 0]); // to its owner; ClientMessage, 32 bit values
        for word in [window, kind, value, 0, 0, 0, 0] {
            request.extend_from_slice(&word.to_le_bytes());
        }
        request.extend_from_slice(&[43, 0, 1, 0]); // GetInputFocus, whose reply says that all is done
        self.0.write_all(&request).unwrap();
        self.reply();
    }
}
