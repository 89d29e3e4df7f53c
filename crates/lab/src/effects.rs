//! `lab effects`: each effect of the chain on a frame of the show, at half its amount, at all of it, and twice
//! in a row, on one labelled page.

use crate::font;
use crate::metric::Picture;
use crate::png_file;
use crate::sheet;
use lexopt::prelude::*;
use luc::show;
use luc_core::math::Vec3;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Effect, Kind, Scene};
use std::path::PathBuf;

/// Effects with their names, strong enough to be told apart in a small picture.
const KINDS: [(&str, Kind); 11] = [
    ("contrast", Kind::Contrast(1.8)),
    ("tint", Kind::Tint { colour: Vec3::new(1.0, 0.45, 0.3), strength: 1.0 }),
    ("bloom", Kind::Bloom { threshold: 0.7, intensity: 1.0 }),
    ("wide bloom", Kind::WideBloom { threshold: 0.7, intensity: 1.5, octaves: 4 }),
    ("sharpness", Kind::Sharpness(2.0)),
    ("levels", Kind::Levels(Vec3::new(4.0, 4.0, 4.0))),
    ("fringes", Kind::Fringes(0.02)),
    ("edges", Kind::Edges { strength: 4.0, colour: Vec3::new(1.0, 0.7, 0.3) }),
    ("lighten", Kind::Lighten(0.3)),
    ("tube", Kind::Tube { base: 0.15, glow: 0.9, radius: 0.9 }),
    ("grain", Kind::Grain(0.12)),
];

/// Amounts and passes that are shown.
const SHOWN: [(f32, u32); 3] = [(0.5, 1), (1.0, 1), (1.0, 2)];

const INK: u32 = 0xff_e8b0;

/// Runs the command with the arguments after `effects`.
pub fn run(args: &[String]) -> Result<(), String> {
    let mut parser = lexopt::Parser::from_args(args);
    let (mut part, mut frame, mut size) = (3, 640, (240, 135));
    let mut out = PathBuf::from("target/sheets/effects.png");
    let mut read = || -> Result<(), lexopt::Error> {
        while let Some(arg) = parser.next()? {
            match arg {
                Long("part") => part = parser.value()?.parse_with(crate::args::part)?,
                Long("frame") => frame = parser.value()?.parse()?,
                Long("size") => size = parser.value()?.parse_with(crate::args::size)?,
                Short('o') => out = parser.value()?.into(),
                _ => return Err(arg.unexpected()),
            }
        }
        Ok(())
    };
    read().map_err(|e| e.to_string())?;
    let part = &show::PARTS[part];
    let scene = (part.scene)(frame % part.frames);
    let quality = Quality::PRESETS[Quality::DEFAULT].1;
    let mut renderer = Renderer::default();
    let mut draw = |label: &str, effects: Vec<Effect>| {
        let mut picture = Picture::new(size);
        let scene = Scene { effects, ..scene.clone() };
        renderer.frame(&scene, frame, size, &quality, &mut picture.pixels);
        font::write(&mut picture, (0, 0), label, (size.1 as usize / 135).max(1), INK);
        picture
    };
    let mut pictures = Vec::new();
    for (name, kind) in KINDS {
        for (amount, multipass) in SHOWN {
            let label = format!("{name} {amount} x {multipass}");
            pictures.push(draw(&label, vec![Effect { amount, multipass, ..Effect::new(kind) }]));
        }
    }
    // What all of them were applied to fills up the last row.
    pictures.push(draw(&format!("{} {frame} without", part.name), Vec::new()));
    let several = vec![Effect::new(KINDS[1].1), Effect::new(KINDS[5].1), Effect::new(KINDS[7].1)];
    pictures.push(draw("tint levels edges", several.clone()));
    pictures.push(draw("edges levels tint", several.into_iter().rev().collect()));
    if let Some(folder) = out.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    png_file::picture(&out, &sheet::sheet(&pictures, 2 * SHOWN.len(), size))?;
    eprintln!("{}", out.display());
    Ok(())
}
