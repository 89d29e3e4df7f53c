//! Rendering while the window lives: one job on the pool draws frame after frame, and leaves the newest
//! where the window's thread finds it.
//!
//! The job first draws the beginning of each part once at the lowest quality, so that whatever a part
//! has to build is built before the clock starts. Three pictures change places (being drawn, newest,
//! on the screen), so that neither side ever waits for the other.

use super::args::Options;
use super::clock::{Clock, until_next};
use super::fit::{self, Rect};
use super::live::Live;
use super::pace::Pace;
use super::time::{MILLISECOND, now, sleep};
use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::mem::{ManuallyDrop, swap};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Levels of live quality: a preset, and on how many twelfths of the picture's sides it draws. Each costs at
/// most about twice as much as the one before it. A preset on fewer pixels shows more than the one under it on
/// all, for less: see ARCHITECTURE.md.
const LEVELS: [(usize, usize); 8] =
    [(LOW, 3), (LOW, 4), (MEDIUM, 4), (MEDIUM, 6), (MEDIUM, 8), (MEDIUM, 12), (HIGH, 12), (ULTRA, 12)];
/// Where it starts.
const MIDDLE: usize = 4;
/// Presets; the one above the last is for measuring.
const LOW: usize = 1;
const MEDIUM: usize = 2;
const HIGH: usize = 3;
const ULTRA: usize = 4;

/// A finished frame.
#[derive(Default)]
pub struct Picture {
    /// Width and height.
    pub size: (usize, usize),
    /// 0RGB rows from the top.
    pub pixels: Vec<u32>,
}

/// What the rendering job and the window's thread share.
pub struct Stage {
    /// The time that has passed.
    pub pace: Pace,
    clock: Clock,
    size: (usize, usize),
    quality: Option<usize>,
    parts: Range<usize>,
    /// The window's size, two halves of a word.
    room: AtomicU32,
    prepared: AtomicUsize,
    over: AtomicBool,
    newest: Mutex<(bool, Picture)>,
}

impl Stage {
    /// For a window of size `room`.
    pub fn new(options: &Options, room: (usize, usize)) -> Self {
        let parts = options.scene.map_or(0..show::PARTS.len(), |part| part..part + 1);
        let stage = Stage {
            pace: Pace::new(),
            clock: Clock {
                first: show::start(parts.start),
                length: parts.clone().map(|part| show::PARTS[part].frames).sum(),
                from: options.from,
                once: options.once,
            },
            size: (options.size.0 as usize, options.size.1 as usize),
            quality: options.quality,
            parts,
            room: AtomicU32::new(0),
            prepared: AtomicUsize::new(0),
            over: AtomicBool::new(false),
            newest: Mutex::default(),
        };
        stage.set_room(room);
        stage
    }

    /// Where in a window the picture stands: in the shape that was asked for, however few pixels it has.
    pub fn place(&self, window: (usize, usize)) -> Rect {
        fit::rect(self.size, window)
    }

    /// Tells the size of the window from now on.
    pub fn set_room(&self, (width, height): (usize, usize)) {
        self.room.store((width as u32) << 16 | (height as u32 & 0xffff), Relaxed);
    }

    /// Frames drawn before the first can be seen, and how many there are to draw, itself among them.
    pub fn progress(&self) -> (usize, usize) {
        (self.prepared.load(Relaxed), self.parts.len() + 1)
    }

    /// True when all that is drawn before the first frame has been.
    pub fn is_prepared(&self) -> bool {
        self.prepared.load(Relaxed) == self.parts.len()
    }

    /// The parts that play, the first frame among theirs, and how many frames there are, if not without end.
    pub fn stretch(&self) -> (Range<usize>, u64, Option<u64>) {
        let Clock { length, from, once, .. } = self.clock;
        (self.parts.clone(), from % length, once.then_some(length - from % length))
    }

    /// True when the last frame of a show played once has been taken.
    pub fn is_over(&self) -> bool {
        self.over.load(Relaxed) && !self.newest().0
    }

    /// Swaps the newest frame into `picture` and returns true if there is one not taken yet.
    pub fn take(&self, picture: &mut Picture) -> bool {
        let mut newest = self.newest();
        let fresh = newest.0;
        if fresh {
            newest.0 = false;
            swap(&mut newest.1, picture);
        }
        fresh
    }

    fn newest(&self) -> MutexGuard<'_, (bool, Picture)> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Draws until the show is over; the job.
    pub fn perform(&self) {
        // The program ends soon after it: nothing is freed.
        let mut renderer = ManuallyDrop::new(Renderer::default());
        let mut picture = Picture::default();
        for part in self.parts.clone() {
            self.draw(&mut renderer, show::start(part), LEVELS[0], &mut picture);
            self.prepared.fetch_add(1, Relaxed);
        }
        let mut live = Live::new(MIDDLE, LEVELS.len() - 1);
        let mut last = None;
        loop {
            let Some(elapsed) = self.pace.elapsed() else {
                sleep(MILLISECOND);
                continue;
            };
            let Some(n) = self.clock.frame(elapsed) else { break };
            if last == Some(n) {
                sleep(until_next(elapsed));
                continue;
            }
            last = Some(n);
            let began = now();
            let level = self.quality.map_or(LEVELS[live.level()], |preset| (preset, 12));
            self.draw(&mut renderer, n, level, &mut picture);
            live.measured(now() - began);
            let mut newest = self.newest();
            newest.0 = true;
            swap(&mut newest.1, &mut picture);
        }
        self.over.store(true, Relaxed);
    }

    /// Draws frame `n` no larger than the window: what would be scaled down need not be drawn.
    fn draw(
        &self,
        renderer: &mut Renderer,
        n: u64,
        (preset, twelfths): (usize, usize),
        picture: &mut Picture,
    ) {
        let room = self.room.load(Relaxed);
        let fitted = self.place(((room >> 16) as usize, (room & 0xffff) as usize));
        let (width, height) = self.size;
        let side = |full: usize| (full * twelfths / 12).max(1);
        picture.size = (side(width.min(fitted.width)), side(height.min(fitted.height)));
        let (width, height) = picture.size;
        picture.pixels.resize(width * height, 0);
        let quality = &Quality::PRESETS[preset].1;
        show::frame(renderer, n, (width as u32, height as u32), quality, &mut picture.pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options<'a>() -> Options<'a> {
        match super::super::args::parse(&[]) {
            Ok(super::super::args::Request::Run(options)) => options,
            _ => unreachable!(),
        }
    }

    #[test]
    fn live_quality_moves_between_the_presets_meant_for_playing() {
        let name = |preset: usize| Quality::PRESETS[preset].0;
        assert_eq!([LOW, MEDIUM, HIGH, ULTRA].map(name), ["low", "medium", "high", "ultra"]);
        assert!(LEVELS.is_sorted(), "no level is better than the next");
    }

    #[test]
    fn a_picture_on_fewer_pixels_keeps_its_shape() {
        let stage = Stage::new(&Options { size: (240, 120), ..options() }, (240, 120));
        let mut picture = Picture::default();
        for (level, size) in [(0, (60, 30)), (1, (80, 40)), (3, (120, 60)), (4, (160, 80)), (5, (240, 120))] {
            stage.draw(&mut Renderer::default(), 0, LEVELS[level], &mut picture);
            assert_eq!((picture.size, picture.pixels.len()), (size, size.0 * size.1));
        }
        let tiny = Stage::new(&Options { size: (1, 2), ..options() }, (240, 120));
        tiny.draw(&mut Renderer::default(), 0, LEVELS[0], &mut picture);
        assert_eq!(picture.size, (1, 1));
    }

    #[test]
    fn playing_once_from_near_the_end_leaves_the_last_frame_and_is_over_when_it_is_taken() {
        let o = Options {
            once: true,
            from: show::PARTS[0].frames - 3,
            scene: Some(0),
            size: (32, 18),
            quality: Some(LOW),
            ..options()
        };
        let stage = Stage::new(&o, (64, 64));
        stage.perform();
        assert_eq!(stage.progress(), (1, 2));
        assert!(!stage.is_over(), "the last frame has not been seen");
        let mut picture = Picture::default();
        assert!(stage.take(&mut picture));
        assert_eq!((picture.size, picture.pixels.len()), ((32, 18), 32 * 18));
        assert!(!stage.take(&mut picture), "a frame is taken once");
        assert!(stage.is_over());
    }

    #[test]
    fn a_smaller_window_is_drawn_smaller_in_the_same_shape() {
        let stage = Stage::new(&Options { size: (320, 180), ..options() }, (160, 400));
        let mut picture = Picture::default();
        stage.draw(&mut Renderer::default(), 0, (LOW, 12), &mut picture);
        assert_eq!(picture.size, (160, 90));
        stage.set_room((4000, 3000));
        stage.draw(&mut Renderer::default(), 0, (LOW, 12), &mut picture);
        assert_eq!(picture.size, (320, 180));
    }
}
