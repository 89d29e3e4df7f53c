//! `lab mesh`: meshes made by rule, as Wavefront OBJ: those of the show's parts, and a knot of any size.

pub mod knot;

use lexopt::prelude::*;
use luc::show;
use luc_core::math::Vec3;
use luc_core::scene::{Material, Scene};
use std::fmt::Write as _;
use std::fs::{create_dir_all, write};
use std::path::{Path, PathBuf};

/// Name of the mesh that is of no part.
const KNOT: &str = "knot";

/// Parts that have meshes, with a frame that shows much of them.
fn parts() -> Vec<(&'static str, u64)> {
    let middle = |part: &show::Part| (part.name, part.frames / 2);
    let meshes = |(name, n): &(&str, u64)| !scene(name, *n).meshes.is_empty();
    show::PARTS.iter().map(middle).filter(meshes).collect()
}

/// The scene of a part at a frame.
fn scene(part: &str, n: u64) -> Scene {
    let found = show::PARTS.iter().find(|p| p.name == part);
    found.map_or_else(Scene::default, |p| (p.scene)(n % p.frames))
}

/// Vertices, normals and faces, and the names of materials.
#[derive(Default)]
struct Text {
    body: String,
    vertices: usize,
    normals: usize,
}

impl Text {
    fn points(&mut self, kind: &str, points: &[Vec3]) {
        for p in points {
            let _ = writeln!(self.body, "{kind} {} {} {}", p.x, p.y, p.z);
        }
    }

    /// A triangle of corners of its own.
    fn triangle(&mut self, corners: [Vec3; 3], normals: Option<[Vec3; 3]>) {
        self.points("v", &corners);
        self.vertices += 3;
        if let Some(normals) = normals {
            self.points("vn", &normals);
            self.normals += 3;
        }
        let face = |k: usize| match normals {
            Some(_) => format!(" {}//{}", self.vertices - k, self.normals - k),
            None => format!(" {}", self.vertices - k),
        };
        let face: String = [2, 1, 0].map(face).concat();
        let _ = writeln!(self.body, "f{face}");
    }
}

/// A material as MTL tells it.
fn told(i: usize, m: &Material) -> String {
    let metallic = 1.0 - m.diffuse;
    let colour = if metallic > 0.5 { m.f0 } else { m.colour };
    let [r, g, b] = colour.to_array();
    let [x, y, z] = m.emission.to_array();
    format!("newmtl m{i}\nKd {r} {g} {b}\nKe {x} {y} {z}\nPr {}\nPm {metallic}\n\n", m.roughness)
}

/// Runs the command with the arguments after `mesh`.
pub fn run(args: &[String]) -> Result<(), String> {
    let mut parser = lexopt::Parser::from_args(args);
    let (mut name, mut out, mut frame, mut triangles) = (None, None, None, 40_000);
    let mut read = || -> Result<(), lexopt::Error> {
        while let Some(arg) = parser.next()? {
            match arg {
                Long("frame") => frame = Some(parser.value()?.parse()?),
                Long("triangles") => triangles = parser.value()?.parse_with(crate::args::count)?,
                Short('o') => out = Some(PathBuf::from(parser.value()?)),
                Value(text) if name.is_none() => name = Some(text.parse::<String>()?),
                _ => return Err(arg.unexpected()),
            }
        }
        Ok(())
    };
    read().map_err(|e| e.to_string())?;
    let names = || {
        let parts = parts().into_iter().map(|part| part.0);
        std::iter::once(KNOT).chain(parts).collect::<Vec<_>>().join(", ")
    };
    let name = name.ok_or_else(|| format!("which mesh? one of {}", names()))?;
    let out = out.unwrap_or_else(|| PathBuf::from(format!("target/{name}.obj")));
    let mut text = Text::default();
    let mut materials = String::new();
    if name == KNOT {
        let (corners, normals) = knot::knot(triangles.clamp(64, 4_000_000) as usize);
        corners.into_iter().zip(normals).for_each(|(c, n)| text.triangle(c, Some(n)));
    } else {
        let part = parts().into_iter().find(|part| part.0 == name);
        let (part, middle) = part.ok_or_else(|| format!("a mesh is one of {}, not '{name}'", names()))?;
        let scene = scene(part, frame.unwrap_or(middle));
        for instance in scene.meshes.instances() {
            let _ = writeln!(text.body, "usemtl m{}", instance.material);
            for corners in instance.mesh().triangles() {
                text.triangle(corners.map(|p| instance.to_world(p)), None);
            }
        }
        materials = scene.materials.iter().enumerate().map(|(i, m)| told(i, m)).collect();
    }
    save(&out, &text, &materials)?;
    eprintln!("{} triangles in {}", text.vertices / 3, out.display());
    Ok(())
}

/// Writes the file, and that of its materials beside it.
fn save(out: &Path, text: &Text, materials: &str) -> Result<(), String> {
    let fault = |path: &Path, e: std::io::Error| format!("{}: {e}", path.display());
    if let Some(folder) = out.parent().filter(|f| !f.as_os_str().is_empty()) {
        create_dir_all(folder).map_err(|e| fault(folder, e))?;
    }
    let library = out.with_extension("mtl");
    let named = library.file_name().map(|name| name.to_string_lossy().into_owned());
    let head = match (&named, materials.is_empty()) {
        (Some(name), false) => format!("mtllib {name}\n"),
        _ => String::new(),
    };
    write(out, head + &text.body).map_err(|e| fault(out, e))?;
    if !materials.is_empty() {
        write(&library, materials).map_err(|e| fault(&library, e))?;
    }
    Ok(())
}
