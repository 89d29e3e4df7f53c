//! `lab render`: a model from outside, drawn by the engine.
//!
//! The OBJ reader is our own: every fault has its line, and no file makes it panic.

mod body;
mod image;
mod mtl;
mod obj;
mod polygon;
mod studio;

use crate::metric::Picture;
use crate::png_file;
use body::{Body, Normals};
use image::{Images, Paint};
use lexopt::prelude::*;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Material, Pattern, Texture};
use mtl::Told;
use obj::{Corners, Model};
use std::fs::{create_dir_all, read};
use std::path::{Path, PathBuf};
use std::time::Instant;
use studio::Pose;

/// Frames of a turntable, and the turn of its first, degrees.
const ROUND: u64 = 240;
const TURN: f32 = 30.0;

/// What the command was asked for.
struct Options {
    file: PathBuf,
    out: Option<PathBuf>,
    size: (u32, u32),
    quality: Quality,
    normals: Normals,
    frame: Option<u64>,
    turn: f32,
    height: f32,
    z_up: bool,
    floor: bool,
    texture: Option<Texture>,
}

/// What bodies wear of which no file tells what they are made of: fine grain.
const GRAIN: Texture = Texture { pattern: Pattern::Noise, scale: 24.0, grain: 0.15, bump: 0.0 };

/// A pattern by its name, cells and relief in proportion to a model of unit size.
fn texture(name: &str) -> Result<Texture, String> {
    let (pattern, scale, grain, bump) = match name {
        "none" => (Pattern::Noise, 1.0, 0.0, 0.0),
        "noise" => (Pattern::Noise, 12.0, 0.5, 0.01),
        "cells" => (Pattern::Cells, 7.0, 0.5, 0.03),
        "stripes" => (Pattern::Stripes, 8.0, 0.5, 0.0),
        "brick" => (Pattern::Brick, 4.0, 0.5, 0.02),
        "scratches" => (Pattern::Scratches, 5.0, 0.4, 0.01),
        _ => {
            return Err(format!(
                "a texture is none, noise, cells, stripes, brick or scratches, not '{name}'"
            ));
        }
    };
    Ok(Texture { pattern, scale, grain, bump })
}

fn options(args: &[String]) -> Result<Options, lexopt::Error> {
    let mut parser = lexopt::Parser::from_args(args);
    let mut options = Options {
        file: PathBuf::new(),
        out: None,
        size: (1280, 720),
        quality: Quality::PRESETS[Quality::DEFAULT].1,
        normals: Normals::File,
        frame: None,
        turn: TURN,
        height: 18.0,
        z_up: false,
        floor: true,
        texture: None,
    };
    while let Some(arg) = parser.next()? {
        match arg {
            Long("size") => options.size = parser.value()?.parse_with(crate::args::size)?,
            Long("quality") => options.quality = parser.value()?.parse_with(crate::args::preset)?,
            Long("average") => {
                let average = parser.value()?.parse_with(crate::args::count)?.min(1024);
                options.quality = Quality { average, ..options.quality };
            }
            Long("normals") => {
                options.normals = parser.value()?.parse_with(|text| match text {
                    "file" => Ok(Normals::File),
                    "flat" => Ok(Normals::Flat),
                    "smooth" => Ok(Normals::Smooth),
                    _ => Err(format!("normals are file, flat or smooth, not '{text}'")),
                })?;
            }
            Long("frame") => options.frame = Some(parser.value()?.parse()?),
            Long("turn") => options.turn = parser.value()?.parse_with(angle)?,
            Long("height") => options.height = parser.value()?.parse_with(angle)?.clamp(-89.0, 89.0),
            Long("up") => {
                options.z_up = parser.value()?.parse_with(|text| match text {
                    "y" | "z" => Ok(text == "z"),
                    _ => Err(format!("up is y or z, not '{text}'")),
                })?;
            }
            Long("texture") => options.texture = Some(parser.value()?.parse_with(texture)?),
            Long("no-floor") => options.floor = false,
            Short('o') => options.out = Some(parser.value()?.into()),
            Value(file) if options.file.as_os_str().is_empty() => options.file = file.into(),
            _ => return Err(arg.unexpected()),
        }
    }
    Ok(options)
}

/// An angle in degrees.
fn angle(text: &str) -> Result<f32, String> {
    obj::number(text).map_err(|_| format!("an angle in degrees, not '{text}'"))
}

/// The text of a file; what is no text in it is replaced.
fn text(path: &Path) -> Result<String, String> {
    let bytes = read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A model, with what it is made of.
struct Loaded {
    model: Model,
    materials: Vec<Material>,
    /// The images of the materials.
    paints: Vec<Option<Paint>>,
}

/// Reads a model and the materials that it names, and says what of it can't be drawn.
fn load(path: &Path, texture: Option<Texture>) -> Result<Loaded, String> {
    let fault = |path: &Path| {
        let name = path.display().to_string();
        move |e: String| format!("{name}: {e}")
    };
    let model = Model::read(&text(path)?).map_err(fault(path))?;
    let mut libraries = Vec::new();
    for (line, name) in &model.libraries {
        let file = path.with_file_name(name);
        match text(&file) {
            Ok(text) => libraries.extend(Told::read(&file, &text).map_err(fault(&file))?),
            Err(e) => eprintln!("lab: {}: line {line}: without materials ({e})", path.display()),
        }
    }
    let mut told = body::told(&model, &libraries, GRAIN);
    if let Some((told, (line, name))) = told.iter().find_map(|told| Some((told, told.other.as_ref()?))) {
        eprintln!("lab: {}: line {line}: of images only map_Kd is drawn, no {name}", told.library.display());
    }
    if let Some(texture) = texture {
        told.iter_mut().for_each(|told| told.texture = texture);
    }
    let mut images = Images::default();
    let paints: Vec<Option<Paint>> = told.iter().map(|told| images.of(told)).collect();
    let bare = |told: &Corners| told.uv.is_none() && paints[told.material].is_some();
    let bare = model.triangles.iter().filter(|told| bare(told)).count();
    if bare > 0 {
        eprintln!(
            "lab: {}: {bare} triangles without texture coordinates go without their images",
            path.display()
        );
    }
    let materials = told.iter().zip(&paints).map(|(told, paint)| told.material(paint.is_some())).collect();
    Ok(Loaded { model, materials, paints })
}

/// Runs the command with the arguments after `render`.
pub fn run(args: &[String]) -> Result<(), String> {
    let options = options(args).map_err(|e| e.to_string())?;
    if options.file.as_os_str().is_empty() {
        return Err("which file? cargo lab render FILE.obj".into());
    }
    let name = options.file.display();
    let Loaded { model, materials, paints } = load(&options.file, options.texture)?;
    let begin = Instant::now();
    let body =
        Body::new(&model, &paints, options.normals, options.z_up).map_err(|e| format!("{name}: {e}"))?;
    let built = begin.elapsed();
    let turn = options.turn + options.frame.map_or(0.0, |n| studio::turned(n, ROUND));
    let pose = Pose { turn, height: options.height, steady: options.frame.is_some() };
    let scene = studio::scene(&body, &materials, &pose, options.size, options.floor);
    let mut picture = Picture::new(options.size);
    let begin = Instant::now();
    let n = options.frame.unwrap_or(0) % ROUND;
    Renderer::default().frame(&scene, n, options.size, &options.quality, &mut picture.pixels);
    let drawn = begin.elapsed();
    let out = options.out.unwrap_or_else(|| options.file.with_extension("png"));
    if let Some(folder) = out.parent().filter(|f| !f.as_os_str().is_empty()) {
        create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    png_file::picture(&out, &picture)?;
    eprintln!(
        "{} triangles of {} materials; tree in {:.1} ms, frame in {:.1} ms; see {}",
        model.triangles.len(),
        body.meshes.len(),
        built.as_secs_f64() * 1e3,
        drawn.as_secs_f64() * 1e3,
        out.display()
    );
    Ok(())
}
