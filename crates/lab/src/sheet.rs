//! `lab sheet`: contact sheets. A frame every two seconds of each part on one page, and the frames
//! around every cut, four apart.

use crate::font;
use crate::metric::Picture;
use crate::png_file;
use crate::progress::Progress;
use crate::subject::Subject;
use lexopt::prelude::*;
use luc::show;
use luc_core::render::Renderer;
use luc_core::scene::{Camera, Scene};
use std::fs::create_dir_all;
use std::path::PathBuf;

/// Frames between two pictures of a part, and around a cut.
const EVERY: u64 = 2 * show::FPS;
const NEAR: u64 = 4;
/// Pictures before a cut; after it there is one more.
const BEFORE: u64 = 4;
/// Pictures in a row of a part's page, and px between them.
const ACROSS: usize = 4;
const GAP: usize = 4;
const INK: u32 = 0xff_e8b0;

/// A picture to draw: the part, its frame, and its label.
type Shot = (Subject, u64, String);

/// Runs the command with the arguments after `sheet`.
pub fn run(args: &[String]) -> Result<(), String> {
    let mut parser = lexopt::Parser::from_args(args);
    let (mut part, mut size, mut preset) = (None, (320, 180), String::from("medium"));
    let mut out = PathBuf::from("target/sheets");
    let mut read = || -> Result<(), lexopt::Error> {
        while let Some(arg) = parser.next()? {
            match arg {
                Long("part") => part = Some(parser.value()?.parse_with(crate::args::part)?),
                Long("size") => size = parser.value()?.parse_with(crate::args::size)?,
                Long("quality") => preset = parser.value()?.parse()?,
                Short('o') => out = parser.value()?.into(),
                _ => return Err(arg.unexpected()),
            }
        }
        Ok(())
    };
    read().map_err(|e| e.to_string())?;
    let quality = crate::args::preset(&preset)?;
    create_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;

    let subjects = Subject::show();
    let chosen: Vec<usize> = (0..subjects.len()).filter(|i| part.is_none_or(|part| part == *i)).collect();
    let mut pages: Vec<(String, usize, Vec<Shot>)> = Vec::new();
    for &i in &chosen {
        let s = subjects[i];
        let shots = (0..s.frames).step_by(EVERY as usize).map(|n| {
            let second = n as f64 / show::FPS as f64;
            (s, n, format!("{} {n}  {second:.0} s", s.name))
        });
        pages.push((s.name.into(), ACROSS, shots.collect()));
        let cuts = cuts(&subjects, i);
        if !cuts.is_empty() {
            pages.push((format!("{}-cuts", s.name), 2 * BEFORE as usize + 1, cuts));
        }
    }
    let mut progress = Progress::new(pages.iter().map(|page| page.2.len() as f64).sum());
    let mut renderer = Renderer::default();
    for (name, across, shots) in pages {
        let mut pictures = Vec::new();
        for (subject, n, label) in shots {
            let mut picture = Picture::new(size);
            renderer.frame(&(subject.scene)(n), n, size, &quality, &mut picture.pixels);
            font::write(&mut picture, (0, 0), &label, (size.1 as usize / 180).max(1), INK);
            pictures.push(picture);
            progress.step(1.0, &name);
        }
        let path = out.join(format!("{name}.png"));
        png_file::picture(&path, &sheet(&pictures, across, size))?;
        eprintln!("\r{}", path.display());
    }
    progress.end("drawn");
    Ok(())
}

/// Pictures of one size in rows of `across`.
pub fn sheet(pictures: &[Picture], across: usize, size: (u32, u32)) -> Picture {
    let across = across.min(pictures.len()).max(1);
    let (w, h) = (size.0 as usize + GAP, size.1 as usize + GAP);
    let rows = pictures.len().div_ceil(across);
    let mut page = Picture::new(((across * w + GAP) as u32, (rows * h + GAP) as u32));
    let width = page.size.0 as usize;
    for (i, picture) in pictures.iter().enumerate() {
        let (left, top) = (GAP + i % across * w, GAP + i / across * h);
        for (y, row) in picture.pixels.chunks(size.0 as usize).enumerate() {
            page.pixels[(top + y) * width + left..][..row.len()].copy_from_slice(row);
        }
    }
    page
}

/// The frames around the cuts of part `i`: where it begins, and where its camera jumps.
fn cuts(subjects: &[Subject], i: usize) -> Vec<Shot> {
    let subject = subjects[i];
    let cameras: Vec<Camera> = (0..subject.frames).map(|n| camera(&(subject.scene)(n))).collect();
    let mut shots = Vec::new();
    for cut in std::iter::once(0).chain(jumps(&cameras)) {
        for k in 0..=2 * BEFORE {
            let Some(n) = (cut + NEAR * k).checked_sub(NEAR * BEFORE) else {
                // Before the first frame of a part the one before it plays; the show is a loop.
                let before = subjects[(i + subjects.len() - 1) % subjects.len()];
                let n = before.frames + cut + NEAR * k - NEAR * BEFORE;
                shots.push((before, n, format!("{} {n}", before.name)));
                continue;
            };
            if n < subject.frames {
                shots.push((subject, n, format!("{} {n}", subject.name)));
            }
        }
    }
    shots
}

fn camera(scene: &Scene) -> Camera {
    scene.camera
}

/// Frames to which a camera jumps: it moves more than eight times as far as in the steps before and
/// after, and more than a tenth of a unit.
fn jumps(cameras: &[Camera]) -> impl Iterator<Item = u64> + use<> {
    let steps: Vec<f32> = cameras
        .windows(2)
        .map(|c| (c[1].position - c[0].position).length() + (c[1].target - c[0].target).length())
        .collect();
    let jumps = (1..steps.len().saturating_sub(1)).filter(move |&i| {
        let around = steps[i - 1].max(steps[i + 1]);
        steps[i] > 0.1 && steps[i] > 8.0 * around
    });
    jumps.map(|i| i as u64 + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use luc_core::math::Vec3;

    #[test]
    fn a_jump_is_found_and_a_fast_flight_is_none() {
        let at = |x: f32| Camera { position: Vec3::new(x, 0.0, 5.0), ..Camera::default() };
        let path: Vec<Camera> = [0.0, 0.1, 0.2, 7.0, 7.1, 7.2].map(at).into();
        assert_eq!(jumps(&path).collect::<Vec<_>>(), [3]);
        let flight: Vec<Camera> = (0..20_u8).map(|i| at(f32::from(i) * f32::from(i))).collect();
        assert_eq!(jumps(&flight).count(), 0);
    }

    #[test]
    fn pictures_stand_in_rows() {
        let pictures: Vec<Picture> = (1..=5).map(|v| Picture { size: (3, 2), pixels: vec![v; 6] }).collect();
        let page = sheet(&pictures, 2, (3, 2));
        assert_eq!(page.size, (2 * 7 + 4, 3 * 6 + 4));
        let at = |x: usize, y: usize| page.pixels[y * page.size.0 as usize + x];
        assert_eq!([at(4, 4), at(11, 4), at(4, 10), at(11, 11), at(6, 17), at(11, 16)], [1, 2, 3, 4, 5, 0]);
    }
}
