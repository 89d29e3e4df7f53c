//! The picture of the development player: the frame as it is looked at, split, with figures and help.

use super::state::{HELP, Look, SWITCHES, State, looks};
use crate::font;
use crate::metric::Picture;
use luc::show;
use luc_core::counters::{Counter, Counters};
use luc_core::plan;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;
use std::time::Instant;

const INK: u32 = 0xff_e8b0;
/// Counters in the figures, with short names.
const SHOWN: [(Counter, &str); 8] = [
    (Counter::PrimaryRays, "primary"),
    (Counter::ReflectedRays, "reflected"),
    (Counter::RefractedRays, "refracted"),
    (Counter::ShadowRays, "shadow"),
    (Counter::FieldSteps, "field steps"),
    (Counter::NodeVisits, "tree nodes"),
    (Counter::EdgeSamples, "edge samples"),
    (Counter::PointLights, "small lights"),
];

/// What lives from frame to frame.
#[derive(Default)]
pub struct Drawer {
    renderer: Renderer,
    reference: Renderer,
    /// What the reference was drawn for, and its picture.
    known: Option<(u64, State, Picture)>,
    /// Time of the last frame, and of handing it to the window, ms.
    pub frame_ms: f64,
    /// See above.
    pub present_ms: f64,
    counters: Counters,
}

impl Drawer {
    /// Draws the frame alone.
    pub fn frame(&mut self, state: &State, size: (u32, u32)) -> Picture {
        let mut picture = Picture::new(size);
        let begin = Instant::now();
        let scene = state.scene();
        let (_, quality) = Quality::PRESETS[state.quality];
        self.counters = look(&mut self.renderer, state, &scene, &quality, &mut picture);
        self.frame_ms = begin.elapsed().as_secs_f64() * 1e3;
        if state.split {
            self.split(state, &scene, &mut picture);
        }
        picture
    }

    /// Puts the reference into the right half. It is drawn again only if something has changed.
    fn split(&mut self, state: &State, scene: &Scene, picture: &mut Picture) {
        // These make no difference to it.
        let asked = State {
            quality: 0,
            figures: false,
            help: false,
            playing: false,
            reverse: false,
            place: 0.0,
            ..state.clone()
        };
        let n = state.frame();
        let known = self.known.take().filter(|k| k.0 == n && k.1 == asked && k.2.size == picture.size);
        let (_, reference) = Quality::PRESETS[Quality::PRESETS.len() - 1];
        let (.., truth) = known.unwrap_or_else(|| {
            let mut truth = Picture::new(picture.size);
            look(&mut self.reference, state, scene, &reference, &mut truth);
            (n, asked.clone(), truth)
        });
        let width = picture.size.0 as usize;
        for (row, truth) in picture.pixels.chunks_mut(width).zip(truth.pixels.chunks(width)) {
            row[width / 2..].copy_from_slice(&truth[width / 2..]);
            row[width / 2] = 0xff_ffff;
        }
        self.known = Some((n, asked, truth));
    }

    /// Adds figures and help.
    pub fn label(&self, state: &State, picture: &mut Picture) {
        let scale = (picture.size.1 as usize / 270).max(1);
        if state.figures {
            font::write(picture, (0, 0), &self.figures(state, picture), scale, INK);
        }
        if state.help {
            let (w, h) = font::size(HELP, scale);
            let middle = |room: u32, need: usize| (room as usize).saturating_sub(need) / 2;
            let at = (middle(picture.size.0, w), middle(picture.size.1, h));
            font::write(picture, at, HELP, scale, INK);
        }
    }

    fn figures(&self, state: &State, picture: &Picture) -> String {
        let (part, local) = show::at(state.frame());
        let seconds = local as f64 / show::FPS as f64;
        let mut text = format!("{} {local}  {seconds:.2} s", show::PARTS[part].name);
        text += match (state.playing, state.reverse) {
            (false, _) => "  paused",
            (true, true) => "  reverse",
            (true, false) => "",
        };
        let split = if state.split { " | reference" } else { "" };
        text += &format!("\n{}{split}  view {}", Quality::PRESETS[state.quality].0, looks()[state.look].0);
        if state.free.is_some() {
            text += "  free camera";
        }
        for ((_, name, _), _) in SWITCHES.iter().zip(state.off).filter(|(_, off)| *off) {
            text += &format!("  no {name}");
        }
        text += &format!("\n{:.1} ms  present {:.1} ms", self.frame_ms, self.present_ms);
        let share = |counter| 100.0 * self.counters.get(counter) as f64 / picture.pixels.len() as f64;
        let [traced, between, filled] = [Counter::Traced, Counter::Interpolated, Counter::Filled].map(share);
        if traced + between + filled > 0.0 {
            text += &format!("\ntraced {traced:.1} %  between {between:.1} %  filled {filled:.1} %");
        }
        for (counter, name) in SHOWN {
            let count = self.counters.get(counter);
            if count > 0 {
                text += &format!("\n{count:>9} {name}");
            }
        }
        for warning in plan::warnings(&state.scene(), &Quality::PRESETS[state.quality].1) {
            text += &format!("\nwarning: {warning}");
        }
        text + "\nh  help"
    }
}

/// Draws a scene as it is looked at; returns what was counted.
fn look(
    renderer: &mut Renderer,
    state: &State,
    scene: &Scene,
    quality: &Quality,
    out: &mut Picture,
) -> Counters {
    let (_, n) = show::at(state.frame());
    match looks()[state.look].1 {
        Look::Light => renderer.frame(scene, n, out.size, quality, &mut out.pixels),
        Look::LightCount => {
            let scene = Scene { light_count: 1.0, ..scene.clone() };
            renderer.frame(&scene, n, out.size, quality, &mut out.pixels);
        }
        Look::View(view) => {
            view.draw(scene, n, out.size, quality, &mut out.pixels);
            return Counters::default();
        }
    }
    renderer.counters
}

#[cfg(test)]
mod tests {
    use super::*;
    use minifb::Key;

    #[test]
    fn the_right_half_is_the_reference_and_the_left_is_not() {
        let mut state = State::new(1500, 0);
        let mut drawer = Drawer::default();
        let size = (48, 26);
        let draft = drawer.frame(&state, size);
        state.key(Key::C);
        let split = drawer.frame(&state, size);
        assert!(split.pixels == drawer.frame(&state, size).pixels, "the kept reference is the same");
        state.quality = Quality::PRESETS.len() - 1;
        state.split = false;
        let reference = drawer.frame(&state, size);
        for y in 0..26 {
            let row = 48 * y..48 * (y + 1);
            let [draft, split, reference] = [&draft, &split, &reference].map(|p| &p.pixels[row.clone()]);
            assert!(split[..24] == draft[..24] && split[25..] == reference[25..], "row {y}");
        }
        assert!(draft.pixels != reference.pixels);
    }

    #[test]
    fn every_look_draws_and_labels_lie_on_top() {
        let mut state = State::new(1500, 1);
        state.help = true;
        let mut drawer = Drawer::default();
        let mut seen: Vec<Vec<u32>> = Vec::new();
        for (i, (name, _)) in looks().into_iter().enumerate() {
            state.look = i;
            let mut picture = drawer.frame(&state, (64, 36));
            let plain = picture.pixels.clone();
            // Mirror has no small lights to count.
            assert!(name == "lights" || !seen.contains(&plain), "{name} shows nothing new");
            drawer.label(&state, &mut picture);
            assert!(picture.pixels != plain, "{name}");
            seen.push(plain);
        }
    }
}
