//! Images that materials name: `map_Kd`, as files beside the MTL file.

use super::mtl::{Map, Told};
use image::ImageReader;
use luc_core::mesh::Image;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An image and how texture coordinates lie on it: `at * scale + offset`.
#[derive(Clone)]
pub struct Paint {
    /// The image.
    pub image: Arc<Image>,
    /// Factors on both coordinates.
    pub scale: [f32; 2],
    /// What is added then.
    pub offset: [f32; 2],
}

/// The file that a name in an MTL file stands for: its path from there, with either kind of slash; or, as
/// paths of another machine lead nowhere, a file of its last name beside the MTL file.
fn place(library: &Path, name: &str) -> PathBuf {
    let name = name.replace('\\', "/");
    let path = library.with_file_name(&name);
    let beside = library.with_file_name(name.rsplit('/').next().unwrap_or_default());
    if !path.is_file() && beside.is_file() { beside } else { path }
}

fn load(path: &Path) -> Result<Image, String> {
    let fault =
        |e: &dyn std::fmt::Display| format!("{}: {}", path.display(), e.to_string().replace('\n', " "));
    let reader = ImageReader::open(path).and_then(ImageReader::with_guessed_format).map_err(|e| fault(&e))?;
    let picture = reader.decode().map_err(|e| fault(&e))?.into_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    let texels = picture.pixels().map(|p| p.0).collect();
    Image::new(size, texels).ok_or_else(|| fault(&"there are no pixels in it"))
}

/// Images by their files; each file is read once.
#[derive(Default)]
pub struct Images(HashMap<PathBuf, Result<Arc<Image>, String>>);

impl Images {
    /// The image of a material, if it names one that can be read. What can't is told with its line.
    pub fn of(&mut self, told: &Told) -> Option<Paint> {
        let Map { name, line, scale, offset } = told.image.as_ref()?;
        let path = place(&told.library, name);
        let image = self.0.entry(path.clone()).or_insert_with(|| load(&path).map(Arc::new));
        match image {
            Ok(image) => Some(Paint { image: image.clone(), scale: *scale, offset: *offset }),
            Err(e) => {
                eprintln!("lab: {}: line {line}: without its image ({e})", told.library.display());
                None
            }
        }
    }
}
