//! The empty window: what a program with a window and a pool of threads costs before it shows anything.
//!
//! A gradient, drawn by minifb and rayon as the player does, until Esc or the window is closed; nothing of the
//! engine. `cargo pack --floor` packs it, and tells where an intro of this kind begins.
#![cfg_attr(luc_size, no_main)]

#[path = "../src/entry.rs"]
mod entry;

#[cfg(not(luc_size))]
fn main() {
    std::process::exit(player::run(&[]))
}

/// What the entry calls, as in the player.
mod player {
    use minifb::{InputCallback, Key, Window, WindowOptions};
    use rayon::prelude::*;
    use std::ffi::OsStr;
    use std::io::Write;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

    /// Exit code of everything that could not be done as asked.
    const REFUSED: i32 = 2;
    const THREADS: usize = 2;
    const WIDTH: usize = 640;
    const HEIGHT: usize = 360;

    struct Keys(Arc<AtomicBool>);

    impl InputCallback for Keys {
        fn add_char(&mut self, _: u32) {}

        fn set_key_state(&mut self, key: Key, down: bool) {
            if key == Key::Escape && down {
                self.0.store(true, Relaxed);
            }
        }
    }

    /// Shows the window, whatever the arguments; the exit code.
    pub fn run(_: &[&OsStr]) -> i32 {
        if rayon::ThreadPoolBuilder::new().num_threads(THREADS).build_global().is_err() {
            return refused(b"floor: the system refused to start threads\n");
        }
        let how = WindowOptions { resize: true, ..Default::default() };
        let Ok(mut window) = Window::new("floor", WIDTH, HEIGHT, how) else {
            return refused(b"floor: no display: set DISPLAY\n");
        };
        let escape = Arc::new(AtomicBool::new(false));
        window.set_input_callback(Box::new(Keys(escape.clone())));
        let mut pixels = vec![0_u32; WIDTH * HEIGHT];
        let mut frame = 0;
        while window.is_open() && !escape.load(Relaxed) {
            frame += 1;
            pixels.par_chunks_mut(WIDTH).enumerate().for_each(|(y, row)| {
                for (x, pixel) in row.iter_mut().enumerate() {
                    *pixel = ((x + frame) as u32 & 255) << 16 | (y as u32 & 255) << 8;
                }
            });
            if window.update_with_buffer(&pixels, WIDTH, HEIGHT).is_err() {
                return refused(b"floor: the window cannot be drawn to\n");
            }
        }
        0
    }

    /// One line on standard error; the exit code.
    fn refused(line: &[u8]) -> i32 {
        // There is nobody left to tell when standard error is closed.
        let _ = std::io::stderr().write_all(line);
        REFUSED
    }
}
