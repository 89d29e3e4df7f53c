//! Side-by-side pictures of every part: presets, the truth, and where they differ.

use super::knob::{Change, Setting, Truth};
use super::knobs::knobs;
use super::measure::{draw, truth_setting};
use crate::metric::{Picture, flip};
use crate::png_file;
use crate::progress::Progress;
use crate::subject::Subject;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::fs::create_dir_all;
use std::path::Path;

/// Folder of the pictures within the study's.
pub const FOLDER: &str = "pictures";
/// Presets that are shown; the error maps are of all but the truth's.
pub const SHOWN: [&str; 3] = ["draft", "medium", "high"];
/// Size of the pictures, and of those of the ladder of reflection models.
const SIZE: (u32, u32) = (320, 180);
const SMALL: (u32, u32) = (240, 135);

/// A label as part of a file's name.
pub fn file_name(label: &str) -> String {
    label.to_lowercase().replace([',', '.'], "").replace(' ', "-")
}

/// Presets of which there is an error map.
pub fn mapped() -> impl Iterator<Item = (&'static str, Quality)> {
    Quality::PRESETS.into_iter().take(Quality::PRESETS.len() - 1)
}

/// Draws all pictures into a study's folder.
pub fn write(subjects: &[Subject], out: &Path, quick: bool) -> Result<(), String> {
    let folder = out.join(FOLDER);
    create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let ladder = knobs().into_iter().find(|k| k.name == "shading").map(|k| k.settings).unwrap_or_default();
    let mut progress = Progress::new(subjects.len() as f64);
    for subject in subjects {
        progress.step(0.0, &format!("pictures of {}", subject.name));
        let n = subject.frames / 2;
        let path = |what: &str| folder.join(format!("{}-{}.png", subject.name, file_name(what)));
        let mut renderer = Renderer::default();
        let mut shot = |size, setting: &Setting| {
            let mut picture = Picture::new(size);
            draw(&mut renderer, subject, n, setting, &mut picture);
            picture
        };
        let truth = shot(SIZE, &truth_setting(Truth::Show, if quick { 15 } else { 63 }));
        png_file::picture(&path("truth"), &truth)?;
        for (name, quality) in mapped() {
            let setting = Setting { label: String::new(), quality, change: Change::None, scale: 1.0 };
            let picture = shot(SIZE, &setting);
            if SHOWN.contains(&name) {
                png_file::picture(&path(name), &picture)?;
            }
            png_file::map(&path(&format!("{name}-error")), SIZE, &flip(&truth, &picture))?;
        }
        for setting in &ladder {
            png_file::picture(&path(&setting.label), &shot(SMALL, setting))?;
        }
        progress.step(1.0, subject.name);
    }
    progress.end("pictures drawn");
    Ok(())
}
