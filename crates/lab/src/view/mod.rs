//! `lab view`: the development player, with the keys that the show itself must not have.
//!
//! One loop: keys, time, a frame, the window. A slow frame makes it jump in time, never slow down.

mod draw;
mod pose;
mod state;

use crate::png_file;
use draw::Drawer;
use lexopt::prelude::*;
use luc::show;
use luc_core::quality::Quality;
use minifb::{InputCallback, Key, Window, WindowOptions};
use state::{State, Wish};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

/// Hands keys on as they go down: one pressed and released during a frame is not lost.
struct Keys(Sender<Key>);

impl InputCallback for Keys {
    fn add_char(&mut self, _: u32) {}

    fn set_key_state(&mut self, key: Key, down: bool) {
        if down {
            // Only fails when the player has ended.
            let _ = self.0.send(key);
        }
    }
}

/// Runs the command with the arguments after `view`.
pub fn run(args: &[String]) -> Result<(), String> {
    let mut parser = lexopt::Parser::from_args(args);
    let (mut from, mut part, mut size, mut quality) = (0, 0, (960, 540), Quality::DEFAULT);
    let mut paused = false;
    let mut read = || -> Result<(), lexopt::Error> {
        while let Some(arg) = parser.next()? {
            match arg {
                Long("from") => from = parser.value()?.parse()?,
                Long("part") => part = parser.value()?.parse_with(crate::args::part)?,
                Long("size") => size = parser.value()?.parse_with(crate::args::size)?,
                Long("paused") => paused = true,
                Long("quality") => {
                    let wanted = parser.value()?.parse_with(crate::args::preset)?;
                    quality = Quality::PRESETS.iter().position(|p| p.1 == wanted).unwrap_or(quality);
                }
                _ => return Err(arg.unexpected()),
            }
        }
        Ok(())
    };
    read().map_err(|e| e.to_string())?;
    let mut state = State::new((show::start(part) + from) % show::FRAMES, quality);
    state.playing = !paused;
    let options = WindowOptions { resize: true, ..WindowOptions::default() };
    let mut window = Window::new("Lúč, development", size.0 as usize, size.1 as usize, options)
        .map_err(|_| String::from("no display: set DISPLAY"))?;
    window.set_target_fps(show::FPS as usize);
    let (sender, keys) = channel();
    window.set_input_callback(Box::new(Keys(sender)));
    play(&mut window, &keys, state)
}

fn play(window: &mut Window, keys: &Receiver<Key>, mut state: State) -> Result<(), String> {
    let mut drawer = Drawer::default();
    let mut last = Instant::now();
    // What is on the screen: nothing is drawn again that would be the same.
    let mut shown: Option<(State, u64, (usize, usize))> = None;
    while window.is_open() {
        let mut tapped = Vec::new();
        while let Ok(key) = keys.try_recv() {
            tapped.push(key);
            match state.key(key) {
                Wish::Nothing => {}
                Wish::Save => save(&mut drawer, &state, window)?,
                Wish::Pose => print_pose(&state),
                Wish::End => return Ok(()),
            }
        }
        let seconds = last.elapsed().as_secs_f64();
        last = Instant::now();
        state.pass(seconds);
        if let Some(camera) = &mut state.free {
            // A tap counts as a fifteenth of a second, a long frame as no more than a fifth.
            let held = window.get_keys();
            tapped.retain(|key| pose::steers(*key) && !held.contains(key));
            pose::steer(camera, &held, seconds.min(0.2) as f32);
            pose::steer(camera, &tapped, 1.0 / 15.0);
        }
        let size = window.get_size();
        let now = (State { place: 0.0, ..state.clone() }, state.frame(), size);
        if size.0 == 0 || size.1 == 0 || shown.as_ref() == Some(&now) {
            window.update();
            continue;
        }
        let mut picture = drawer.frame(&state, (size.0 as u32, size.1 as u32));
        drawer.label(&state, &mut picture);
        let begin = Instant::now();
        window.update_with_buffer(&picture.pixels, size.0, size.1).map_err(|e| e.to_string())?;
        drawer.present_ms = begin.elapsed().as_secs_f64() * 1e3;
        shown = Some(now);
    }
    Ok(())
}

/// Writes the frame, without figures, beside where the player was started.
fn save(drawer: &mut Drawer, state: &State, window: &Window) -> Result<(), String> {
    let (part, local) = show::at(state.frame());
    let path = PathBuf::from(format!("{}-{local:04}.png", show::PARTS[part].name));
    let (width, height) = window.get_size();
    png_file::picture(&path, &drawer.frame(state, (width as u32, height as u32)))?;
    println!("{}", path.display());
    Ok(())
}

fn print_pose(state: &State) {
    let (part, local) = show::at(state.frame());
    let seconds = local as f64 / show::FPS as f64;
    print!("{}", pose::keys(&state.scene().camera, show::PARTS[part].name, seconds));
}
