//! The window: shows the newest finished frame and listens to the keyboard, whatever rendering does.
//!
//! This thread only presents and pumps, 250 times a second by minifb's own limit, so that Esc ends the
//! program at once even while a frame takes seconds: `play` returns and the process ends under the
//! rendering job's feet, which holds nothing that must be put in order. Keys come through a callback,
//! because a key pressed and released between two updates is never seen by asking for its state.

use super::args::Options;
#[cfg(all(feature = "sound", target_os = "linux"))]
use super::sound;
use super::stage::{Picture, Stage};
use super::text::{Text, join};
use super::time::{MILLISECOND, now};
use super::x11::{Screen, no_display};
use super::{fit, loader};
use minifb::{InputCallback, Key, Scale, Window, WindowOptions};
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Preparations shorter than this show no bar.
const UNNOTICED: u64 = 50 * MILLISECOND;
/// The picture is presented again after this time, because X11 forgets what was covered.
const STALE: u64 = 100 * MILLISECOND;

struct Keys(&'static AtomicBool);

impl InputCallback for Keys {
    fn add_char(&mut self, _: u32) {}

    fn set_key_state(&mut self, key: Key, down: bool) {
        if key == Key::Escape && down {
            self.0.store(true, Relaxed);
        }
    }
}

/// Plays the show until it ends or the user ends it.
pub fn play(options: &Options) -> Result<(), Text> {
    let screen = Screen::find()?;
    // The program ends with it: neither it nor what the rendering job holds is given back.
    let mut window = ManuallyDrop::new(open(options, &screen)?);
    let escape: &AtomicBool = Box::leak(Box::default());
    window.set_input_callback(Box::new(Keys(escape)));
    window.set_cursor_visibility(false);

    let start = now();
    let stage: &'static Stage = Box::leak(Box::new(Stage::new(options, window.get_size())));
    #[cfg(all(feature = "sound", target_os = "linux"))]
    if !options.mute {
        sound::start(stage);
    }
    rayon::spawn(|| stage.perform());

    let mut picture = Picture::default();
    let mut canvas = Vec::new();
    let mut shown = ((0, 0), start);
    while window.is_open() && !escape.load(Relaxed) && !stage.is_over() {
        let size = window.get_size();
        let fresh = stage.take(&mut picture);
        let waiting = picture.pixels.is_empty();
        let due = fresh || shown.0 != size || now() - shown.1 > STALE;
        if !due || waiting && now() - start < UNNOTICED {
            window.update();
            continue;
        }
        shown = (size, now());
        stage.set_room(size);
        let pixels = if picture.size == size {
            &picture.pixels
        } else if waiting {
            let (done, total) = stage.progress();
            loader::draw(&mut canvas, size, done, total);
            &canvas
        } else {
            fit::fit(&picture.pixels, picture.size, &stage.place(size), &mut canvas, size);
            &canvas
        };
        if window.update_with_buffer(pixels, size.0, size.1).is_err() {
            return Err(join(&[b"the window cannot be drawn to; write a frame with --frame N"]));
        }
    }
    Ok(())
}

/// Opens the window: as large as the picture where the screen has room for it, or over the whole screen.
fn open(options: &Options, screen: &Screen) -> Result<Window, Text> {
    let size = (options.size.0 as usize, options.size.1 as usize);
    let mut how = WindowOptions { resize: true, borderless: options.fullscreen, ..Default::default() };
    let (width, height) = match screen.size {
        Some(whole) if options.fullscreen => whole,
        Some(whole) if size.0 > whole.0 || size.1 > whole.1 => {
            let fitted = fit::rect(size, whole);
            (fitted.width, fitted.height)
        }
        None if options.fullscreen => {
            // minifb knows the screen's size but only tells how often a window fits in it.
            how.scale = Scale::FitScreen;
            (16, 9)
        }
        _ => size,
    };
    let window = Window::new("Lúč", width, height, how).map_err(|_| no_display())?;
    if options.fullscreen {
        screen.cover(window.get_window_handle());
    }
    Ok(window)
}
