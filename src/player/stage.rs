//! Rendering while the window lives: one job on the pool draws frame after frame, and leaves the newest
//! where the window's thread finds it.
//!
//! The job first draws the beginning of each part once at the lowest quality, so that whatever a part
//! has to build is built before the clock starts. Three pictures change places (being drawn, newest,
//! on the screen), so that neither side ever waits for the other.

use super::args::Options;
use super::clock::{Clock, until_next};
use super::fit;
use super::live::Live;
use super::pace::Pace;
use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::mem::{ManuallyDrop, swap};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Levels of live quality below the first preset: that preset on this many twelfths of the picture's sides.
/// Sharpness is missed less than motion.
const SMALLER: [usize; 3] = [4, 6, 8];
/// The levels of three presets. Playing starts at the middle one; the one above the last is for measuring.
const DRAFT: usize = SMALLER.len();
const MEDIUM: usize = DRAFT + 2;
const ULTRA: usize = DRAFT + Quality::PRESETS.len() - 2;

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
            self.draw(&mut renderer, show::start(part), DRAFT, &mut picture);
            self.prepared.fetch_add(1, Relaxed);
        }
        let mut live = Live::new(MEDIUM, ULTRA);
        let mut last = None;
        loop {
            let Some(elapsed) = self.pace.elapsed() else {
                std::thread::sleep(Duration::from_millis(1));
                continue;
            };
            let Some(n) = self.clock.frame(elapsed) else { break };
            if last == Some(n) {
                std::thread::sleep(until_next(elapsed));
                continue;
            }
            last = Some(n);
            let began = Instant::now();
            let level = self.quality.map_or(live.level(), |preset| DRAFT + preset);
            self.draw(&mut renderer, n, level, &mut picture);
            live.measured(began.elapsed());
            let mut newest = self.newest();
            newest.0 = true;
            swap(&mut newest.1, &mut picture);
        }
        self.over.store(true, Relaxed);
    }

    /// Draws frame `n` no larger than the window: what would be scaled down need not be drawn.
    fn draw(&self, renderer: &mut Renderer, n: u64, level: usize, picture: &mut Picture) {
        let room = self.room.load(Relaxed);
        let fitted = fit::rect(self.size, ((room >> 16) as usize, (room & 0xffff) as usize));
        let (width, height) = self.size;
        let share = SMALLER.get(level).unwrap_or(&12);
        let side = |full: usize| (full * share / 12).max(1);
        picture.size = (side(width.min(fitted.width)), side(height.min(fitted.height)));
        let (width, height) = picture.size;
        picture.pixels.resize(width * height, 0);
        let quality = &Quality::PRESETS[level.saturating_sub(DRAFT)].1;
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
        let name = |level: usize| Quality::PRESETS[level - DRAFT].0;
        assert_eq!([DRAFT, MEDIUM, ULTRA].map(name), ["draft", "medium", "ultra"]);
    }

    #[test]
    fn below_draft_the_picture_shrinks_in_its_shape() {
        let stage = Stage::new(&Options { size: (240, 120), ..options() }, (240, 120));
        let mut picture = Picture::default();
        let mut sizes = Vec::new();
        for level in 0..=DRAFT + 1 {
            stage.draw(&mut Renderer::default(), 0, level, &mut picture);
            assert_eq!(picture.pixels.len(), picture.size.0 * picture.size.1);
            sizes.push(picture.size);
        }
        assert_eq!(sizes, [(80, 40), (120, 60), (160, 80), (240, 120), (240, 120)]);
        let tiny = Stage::new(&Options { size: (1, 2), ..options() }, (240, 120));
        tiny.draw(&mut Renderer::default(), 0, 0, &mut picture);
        assert_eq!(picture.size, (1, 1));
    }

    #[test]
    fn playing_once_from_near_the_end_leaves_the_last_frame_and_is_over_when_it_is_taken() {
        let o = Options {
            once: true,
            from: show::PARTS[0].frames - 3,
            scene: Some(0),
            size: (32, 18),
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
        stage.draw(&mut Renderer::default(), 0, DRAFT, &mut picture);
        assert_eq!(picture.size, (160, 90));
        stage.set_room((4000, 3000));
        stage.draw(&mut Renderer::default(), 0, DRAFT, &mut picture);
        assert_eq!(picture.size, (320, 180));
    }
}
