//! MTL: the materials that an OBJ file names, as surfaces of microfacets.
//!
//! Colours are taken as linear. Phong's exponent n becomes the roughness of about the same highlight,
//! α² = 2 / (n + 2) (Walter et al. 2007); `Pr` and `Pm`, roughness and metallic part, say it directly.
//! Of images `map_Kd` is drawn, which is multiplied with `Kd`; black or no `Kd` stands for white then.

use super::obj::{number, numbers};
use luc_core::math::Vec3;
use luc_core::scene::{Material, Texture};
use std::path::{Path, PathBuf};

/// An image that is laid over surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Its file, as the MTL file names it.
    pub name: String,
    /// The line that does so.
    pub line: usize,
    /// Factors on both texture coordinates, `-s`.
    pub scale: [f32; 2],
    /// What is added to them then, `-o`.
    pub offset: [f32; 2],
}

/// A material as the file tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// Its name.
    pub name: String,
    /// File that it stands in.
    pub library: PathBuf,
    /// Albedo, `Kd`, if the file tells it.
    pub diffuse: Option<Vec3>,
    /// Colour of the highlight, `Ks`.
    pub specular: Vec3,
    /// Light given off, `Ke`.
    pub emission: Vec3,
    /// Exponent of the highlight, `Ns`.
    pub exponent: f32,
    /// Share of light that doesn't pass through, `d`, or 1 - `Tr`.
    pub opacity: f32,
    /// Index of refraction, `Ni`.
    pub ior: f32,
    /// Roughness, `Pr`.
    pub roughness: Option<f32>,
    /// Metallic part, `Pm`.
    pub metallic: f32,
    /// The image that gives it its colours, `map_Kd`.
    pub image: Option<Map>,
    /// Another image that it names, which isn't drawn, with its line.
    pub other: Option<(usize, String)>,
    /// The pattern of what has no image.
    pub texture: Texture,
}

/// The words of a map's line: options and their numbers, then the file's name, which may have blanks.
fn map(line: usize, mut words: &[&str]) -> Result<Map, String> {
    let mut map = Map { name: String::new(), line, scale: [1.0; 2], offset: [0.0; 2] };
    while let Some((option, rest)) = words.split_first().filter(|(word, _)| word.starts_with('-')) {
        // One to three numbers; a name may begin with a number, but not be one.
        let numeric = rest.iter().take(3).take_while(|word| number(word).is_ok()).count();
        let count = match *option {
            "-s" | "-o" | "-t" => numeric,
            "-mm" => 2,
            _ => 1,
        };
        if rest.len() < count || count == 0 {
            return Err(format!("'{option}' lacks its value"));
        }
        let pair = |default: f32| -> Result<[f32; 2], String> {
            Ok([number(rest[0])?, if count > 1 { number(rest[1])? } else { default }])
        };
        match *option {
            "-s" => map.scale = pair(1.0)?,
            "-o" => map.offset = pair(0.0)?,
            _ => {}
        }
        words = &rest[count..];
    }
    map.name = words.join(" ");
    if map.name.is_empty() { Err("an image without a name".into()) } else { Ok(map) }
}

impl Told {
    /// What a material without a word about it is: light grey, half shining.
    pub fn new(name: &str) -> Told {
        Told {
            name: name.into(),
            library: PathBuf::new(),
            diffuse: None,
            specular: Vec3::splat(0.5),
            emission: Vec3::ZERO,
            exponent: 40.0,
            opacity: 1.0,
            ior: 1.5,
            roughness: None,
            metallic: 0.0,
            image: None,
            other: None,
            texture: Texture::NONE,
        }
    }

    /// Reads the text of a file. An error begins with the line.
    pub fn read(path: &Path, text: &str) -> Result<Vec<Told>, String> {
        let mut all: Vec<Told> = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let words: Vec<&str> = line.split('#').next().unwrap_or_default().split_whitespace().collect();
            let Some((&first, words)) = words.split_first() else { continue };
            let read = match (first, all.last_mut()) {
                ("newmtl", _) => {
                    all.push(Told { library: path.into(), ..Told::new(&words.join(" ")) });
                    Ok(())
                }
                (_, Some(material)) => material.line(i + 1, first, words),
                _ => Ok(()),
            };
            read.map_err(|fault| format!("line {}: {fault}", i + 1))?;
        }
        Ok(all)
    }

    fn line(&mut self, line: usize, first: &str, words: &[&str]) -> Result<(), String> {
        // One number stands for three.
        let colour = || match words {
            ["spectral" | "xyz", ..] => Err(String::from("colours are known as red, green and blue only")),
            [one] => number(one).map(Vec3::splat),
            _ => numbers(words).map(Vec3::from_array),
        };
        // The last word: options such as -halo stand before the number.
        let value = || words.last().map_or(Err(String::from("a number is missing")), |word| number(word));
        match first {
            "Kd" => self.diffuse = Some(colour()?.clamp(Vec3::ZERO, Vec3::ONE)),
            "Ks" => self.specular = colour()?.clamp(Vec3::ZERO, Vec3::ONE),
            "Ke" => self.emission = colour()?.max(Vec3::ZERO),
            "Ns" => self.exponent = value()?.clamp(0.0, 1e5),
            "d" => self.opacity = value()?.clamp(0.0, 1.0),
            "Tr" => self.opacity = 1.0 - value()?.clamp(0.0, 1.0),
            "Ni" => self.ior = value()?.clamp(1.0, 4.0),
            "Pr" => self.roughness = Some(value()?.clamp(0.0, 1.0)),
            "Pm" => self.metallic = value()?.clamp(0.0, 1.0),
            "map_Kd" => self.image = Some(map(line, words)?),
            _ if first.starts_with("map_") || ["bump", "disp", "decal", "norm", "refl"].contains(&first) => {
                self.other = Some((line, first.into()));
            }
            _ => {}
        }
        Ok(())
    }

    /// As the engine has it; `painted` if its image is there.
    pub fn material(&self, painted: bool) -> Material {
        let diffuse = match self.diffuse {
            Some(told) if !painted || told != Vec3::ZERO => told,
            _ => Vec3::splat(if painted { 1.0 } else { 0.55 }),
        };
        let m = self.roughness.unwrap_or_else(|| (2.0 / (self.exponent + 2.0)).powf(0.25)).clamp(0.02, 1.0);
        let r = (self.ior - 1.0) / (self.ior + 1.0);
        // How much of the highlight there is, as a share of that of a body of index 1.5.
        let gloss = Vec3::splat(r * r) * (2.0 * self.specular).min(Vec3::ONE);
        let f0 = gloss * (1.0 - self.metallic) + diffuse * self.metallic;
        let opaque = self.opacity * (1.0 - self.metallic);
        Material {
            colour: diffuse,
            diffuse: opaque,
            specular: Vec3::ONE,
            exponent: self.exponent.max(1.0),
            f0,
            roughness: m,
            // The mirrors of rough bodies are next to nothing, and dear.
            reflection: if m < 0.45 || self.metallic > 0.5 { 1.0 } else { 0.0 },
            transparency: 1.0 - self.opacity,
            ior: self.ior,
            tint: Vec3::ONE * (1.0 - self.opacity) + diffuse * self.opacity,
            emission: self.emission,
            shadow: diffuse * (1.0 - self.opacity),
            texture: if painted { Texture::NONE } else { self.texture },
            ..Material::DEFAULT
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_are_read_and_their_faults_told_with_the_line() {
        let text = "# two\nKa 1 1 1\nnewmtl red brick\nKd 0.8 0.2 0.1\nNs 98 # soft\nKs 0\nmap_Kd -s 2 3 1 -blendu on -o .5 old bricks.png\n\nnewmtl gold\nPm 1\nPr 0.2\nTr 0\n";
        let all = Told::read(Path::new("a.mtl"), text).unwrap();
        assert_eq!(all.iter().map(|m| m.name.as_str()).collect::<Vec<_>>(), ["red brick", "gold"]);
        let brick = all[0].material(true);
        assert_eq!((brick.colour, brick.f0), (Vec3::new(0.8, 0.2, 0.1), Vec3::ZERO));
        assert!((brick.roughness - 0.3761).abs() < 1e-3);
        let map = Map { name: "old bricks.png".into(), line: 7, scale: [2.0, 3.0], offset: [0.5, 0.0] };
        assert_eq!((&all[0].image, &all[1].image), (&Some(map), &None));
        let gold = all[1].material(false);
        assert_eq!((gold.diffuse, gold.f0, gold.roughness), (0.0, Vec3::splat(0.55), 0.2));
        for (line, words) in [
            ("Kd 1 0", "2 numbers where 3 are needed"),
            ("Ns", "a number is missing"),
            ("d inf", "'inf' is no number"),
            ("Kd spectral a.rfl", "red, green and blue"),
            ("map_Kd", "an image without a name"),
            ("map_Kd -s a.png", "'-s' lacks its value"),
            ("map_Kd -clamp", "'-clamp' lacks its value"),
        ] {
            let said = Told::read(Path::new("a"), &format!("newmtl a\n{line}\n")).unwrap_err();
            assert!(said.starts_with("line 2: ") && said.contains(words), "{line}: {said}");
        }
    }
}
