//! What the development player shows, and what its keys do: everything but window and clock.

use super::pose;
use luc::show;
use luc_core::quality::Quality;
use luc_core::render::View;
use luc_core::scene::{Camera, Scene};
use minifb::Key;

/// Frames that the keys of time jump.
const SECOND: f64 = show::FPS as f64;

/// What a key asks for besides a change of state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Nothing more.
    Nothing,
    /// Write the frame to a file.
    Save,
    /// Print the camera's pose.
    Pose,
    /// End.
    End,
}

/// How a frame is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// By its light.
    Light,
    /// One of the views.
    View(View),
    /// How many small lights reach each tile.
    LightCount,
}

/// All looks with their names, in the order of the key.
pub fn looks() -> Vec<(&'static str, Look)> {
    let views = View::ALL.map(|(name, view)| (name, Look::View(view)));
    [("light", Look::Light)].into_iter().chain(views).chain([("lights", Look::LightCount)]).collect()
}

/// Takes something out of a scene.
type Removal = fn(&mut Scene);

/// What can be switched off: the key, its name, and what it takes away.
pub const SWITCHES: [(Key, &str, Removal); 7] = [
    (Key::Key1, "bloom", |s| s.grade.bloom = 0.0),
    (Key::Key2, "vignette", |s| s.grade.vignette = 0.0),
    (Key::Key3, "grain", |s| s.grade.grain = 0.0),
    (Key::Key4, "fog", |s| s.fog = None),
    (Key::Key5, "beams", |s| s.beams.clear()),
    (Key::Key6, "occlusion", |s| s.occlusion = 0.0),
    (Key::Key7, "overlay", |s| s.overlay = 0.0),
];

/// Help on the screen.
pub const HELP: &str = "\
space       pause           r     reverse
, .         step a frame    v     next view
left right  1 second        - +   quality
up down     10 seconds      c     split
pageup dn   part            o h   figures, help
f           free camera: w a s d q e, arrows
p           print the pose  x     save the frame
esc         end
1 bloom  2 vignette  3 grain  4 fog  5 beams
6 occlusion  7 overlay";

/// The state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Place in the show, frames.
    pub place: f64,
    /// Whether time passes.
    pub playing: bool,
    /// Whether it passes backwards.
    pub reverse: bool,
    /// Index of the preset.
    pub quality: usize,
    /// Index of the look.
    pub look: usize,
    /// Whether the right half shows the reference.
    pub split: bool,
    /// Whether figures are shown.
    pub figures: bool,
    /// Whether help is shown.
    pub help: bool,
    /// The free camera.
    pub free: Option<Camera>,
    /// Which of [`SWITCHES`] are off.
    pub off: [bool; SWITCHES.len()],
}

impl State {
    /// Playing from a frame of the show.
    pub fn new(from: u64, quality: usize) -> Self {
        Self {
            place: from as f64,
            playing: true,
            reverse: false,
            quality,
            look: 0,
            split: false,
            figures: true,
            help: false,
            free: None,
            off: [false; SWITCHES.len()],
        }
    }

    /// The frame of the show.
    pub fn frame(&self) -> u64 {
        self.place as u64 % show::FRAMES
    }

    fn jump(&mut self, frames: f64) {
        self.place = (self.place + frames).rem_euclid(show::FRAMES as f64);
    }

    /// Lets time pass.
    pub fn pass(&mut self, seconds: f64) {
        if self.playing {
            self.jump(seconds * SECOND * if self.reverse { -1.0 } else { 1.0 });
        }
    }

    /// Steps to the next frame, or the one before, and stays there.
    fn step(&mut self, frames: f64) {
        self.playing = false;
        self.place = self.place.floor();
        self.jump(frames);
    }

    /// Goes to the beginning of the next part, of this one, or of the one before if this has just begun.
    fn part(&mut self, next: bool) {
        let (part, local) = show::at(self.frame());
        let count = show::PARTS.len();
        let to = match next {
            true => (part + 1) % count,
            false if local > show::FPS => part,
            false => (part + count - 1) % count,
        };
        self.place = show::start(to) as f64;
    }

    /// The scene, looked at by `Light`.
    pub fn scene(&self) -> Scene {
        let mut scene = show::scene(self.frame());
        for (_, (_, _, take_away)) in self.off.iter().zip(SWITCHES).filter(|(off, _)| **off) {
            take_away(&mut scene);
        }
        if let Some(camera) = self.free {
            scene.camera = camera;
        }
        scene
    }

    /// A key went down.
    pub fn key(&mut self, key: Key) -> Wish {
        if self.free.is_some() && pose::steers(key) {
            return Wish::Nothing;
        }
        if let Some(i) = SWITCHES.iter().position(|s| s.0 == key) {
            self.off[i] = !self.off[i];
        }
        match key {
            Key::Escape => return Wish::End,
            Key::X => return Wish::Save,
            Key::P => return Wish::Pose,
            Key::Space => self.playing = !self.playing,
            Key::Comma => self.step(-1.0),
            Key::Period => self.step(1.0),
            Key::Left => self.jump(-SECOND),
            Key::Right => self.jump(SECOND),
            Key::Down => self.jump(-10.0 * SECOND),
            Key::Up => self.jump(10.0 * SECOND),
            Key::PageDown => self.part(true),
            Key::PageUp => self.part(false),
            Key::R => self.reverse = !self.reverse,
            Key::V => self.look = (self.look + 1) % looks().len(),
            Key::Minus | Key::NumPadMinus => self.quality = self.quality.saturating_sub(1),
            Key::Equal | Key::NumPadPlus => self.quality = (self.quality + 1).min(Quality::PRESETS.len() - 1),
            Key::C => self.split = !self.split,
            Key::O => self.figures = !self.figures,
            Key::H => self.help = !self.help,
            Key::F => {
                self.free = match self.free {
                    None => Some(show::scene(self.frame()).camera),
                    Some(_) => None,
                }
            }
            _ => {}
        }
        Wish::Nothing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(keys: &[Key]) -> State {
        let mut state = State::new(720, 3);
        for &key in keys {
            state.key(key);
        }
        state
    }

    #[test]
    fn time_jumps_steps_and_wraps() {
        assert_eq!(after(&[Key::Right]).frame(), 780);
        assert_eq!(after(&[Key::Left, Key::Down]).frame(), 60);
        assert_eq!(after(&[Key::Down, Key::Down]).frame(), show::FRAMES - 480);
        let state = after(&[Key::Period, Key::Period, Key::Comma]);
        assert_eq!((state.frame(), state.playing), (721, false));
        assert_eq!(after(&[Key::Comma]).frame(), 719);
    }

    #[test]
    fn time_passes_both_ways_unless_paused() {
        let mut state = after(&[]);
        state.pass(0.5);
        assert_eq!(state.frame(), 750);
        state.key(Key::R);
        state.pass(1.0);
        assert_eq!(state.frame(), 690);
        state.key(Key::Space);
        state.pass(7.0);
        assert_eq!(state.frame(), 690);
    }

    #[test]
    fn parts_are_entered_at_their_beginning_round_and_round() {
        let (part, _) = show::at(720);
        let mut state = after(&[Key::Right, Key::Right, Key::PageUp]);
        assert_eq!(state.frame(), show::start(part), "back to the beginning of this one");
        for i in 1..=2 * show::PARTS.len() {
            state.key(Key::PageDown);
            assert_eq!(show::at(state.frame()), ((part + i) % show::PARTS.len(), 0));
        }
        state.key(Key::PageUp);
        assert_eq!(show::at(state.frame()).0, (part + show::PARTS.len() - 1) % show::PARTS.len());
    }

    #[test]
    fn quality_stays_on_the_ladder_and_looks_go_round() {
        assert_eq!(after(&[Key::Minus; 9]).quality, 0);
        assert_eq!(after(&[Key::Equal; 9]).quality, Quality::PRESETS.len() - 1);
        assert_eq!(after(&vec![Key::V; looks().len()]), after(&[]));
    }

    #[test]
    fn the_free_camera_takes_the_arrows_and_leaves_time_alone() {
        let state = after(&[Key::F, Key::Right, Key::Up]);
        assert_eq!(state.frame(), 720);
        assert_eq!(state.scene().camera, show::scene(720).camera);
        assert!(after(&[Key::F, Key::F]).free.is_none());
    }

    #[test]
    fn every_switch_takes_something_away_and_gives_it_back() {
        for (i, (key, name, take_away)) in SWITCHES.iter().enumerate() {
            assert!(after(&[*key]).off[i], "{name}");
            assert_eq!(after(&[*key, *key]), after(&[]), "{name}");
            take_away(&mut show::scene(720));
        }
        assert_eq!(after(&[Key::Key1]).scene().grade.bloom, 0.0);
    }

    #[test]
    fn help_names_every_key_once_and_fits_a_small_window() {
        for part in ["space", "pageup", "esc", "split", "7 overlay"] {
            assert_eq!(HELP.matches(part).count(), 1, "{part}");
        }
        assert!(HELP.lines().all(|line| line.len() <= 52), "{HELP}");
    }
}
