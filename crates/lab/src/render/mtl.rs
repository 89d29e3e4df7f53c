//! MTL: the materials that an OBJ file names, as surfaces of microfacets.
//!
//! Colours are taken as linear. Phong's exponent n becomes the roughness of about the same highlight,
//! α² = 2 / (n + 2) (Walter et al. 2007); `Pr` and `Pm`, roughness and metallic part, say it directly.
//! Images are not drawn.

use super::obj::{number, numbers};
use luc_core::math::Vec3;
use luc_core::scene::Material;

/// A material as the file tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// Its name.
    pub name: String,
    /// Albedo, `Kd`.
    pub diffuse: Vec3,
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
    /// Whether an image was to be laid over it.
    pub image: bool,
}

impl Told {
    /// What a material without a word about it is: light grey, half shining.
    pub fn new(name: &str) -> Told {
        Told {
            name: name.into(),
            diffuse: Vec3::splat(0.55),
            specular: Vec3::splat(0.5),
            emission: Vec3::ZERO,
            exponent: 40.0,
            opacity: 1.0,
            ior: 1.5,
            roughness: None,
            metallic: 0.0,
            image: false,
        }
    }

    /// Reads the text of a file. An error begins with the line.
    pub fn read(text: &str) -> Result<Vec<Told>, String> {
        let mut all: Vec<Told> = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let words: Vec<&str> = line.split('#').next().unwrap_or_default().split_whitespace().collect();
            let Some((&first, words)) = words.split_first() else { continue };
            let read = match (first, all.last_mut()) {
                ("newmtl", _) => {
                    all.push(Told::new(&words.join(" ")));
                    Ok(())
                }
                (_, Some(material)) => material.line(first, words),
                _ => Ok(()),
            };
            read.map_err(|fault| format!("line {}: {fault}", i + 1))?;
        }
        Ok(all)
    }

    fn line(&mut self, first: &str, words: &[&str]) -> Result<(), String> {
        // One number stands for three.
        let colour = || match words {
            ["spectral" | "xyz", ..] => Err(String::from("colours are known as red, green and blue only")),
            [one] => number(one).map(Vec3::splat),
            _ => numbers(words).map(Vec3::from_array),
        };
        // The last word: options such as -halo stand before the number.
        let value = || words.last().map_or(Err(String::from("a number is missing")), |word| number(word));
        match first {
            "Kd" => self.diffuse = colour()?.clamp(Vec3::ZERO, Vec3::ONE),
            "Ks" => self.specular = colour()?.clamp(Vec3::ZERO, Vec3::ONE),
            "Ke" => self.emission = colour()?.max(Vec3::ZERO),
            "Ns" => self.exponent = value()?.clamp(0.0, 1e5),
            "d" => self.opacity = value()?.clamp(0.0, 1.0),
            "Tr" => self.opacity = 1.0 - value()?.clamp(0.0, 1.0),
            "Ni" => self.ior = value()?.clamp(1.0, 4.0),
            "Pr" => self.roughness = Some(value()?.clamp(0.0, 1.0)),
            "Pm" => self.metallic = value()?.clamp(0.0, 1.0),
            _ => self.image |= first.starts_with("map_"),
        }
        Ok(())
    }

    /// As the engine has it.
    pub fn material(&self) -> Material {
        let m = self.roughness.unwrap_or_else(|| (2.0 / (self.exponent + 2.0)).powf(0.25)).clamp(0.02, 1.0);
        let r = (self.ior - 1.0) / (self.ior + 1.0);
        // How much of the highlight there is, as a share of that of a body of index 1.5.
        let gloss = Vec3::splat(r * r) * (2.0 * self.specular).min(Vec3::ONE);
        let f0 = gloss * (1.0 - self.metallic) + self.diffuse * self.metallic;
        let opaque = self.opacity * (1.0 - self.metallic);
        Material {
            colour: self.diffuse,
            diffuse: opaque,
            specular: Vec3::ONE,
            exponent: self.exponent.max(1.0),
            f0,
            roughness: m,
            // The mirrors of rough bodies are next to nothing, and dear.
            reflection: if m < 0.45 || self.metallic > 0.5 { 1.0 } else { 0.0 },
            transparency: 1.0 - self.opacity,
            ior: self.ior,
            tint: Vec3::ONE * (1.0 - self.opacity) + self.diffuse * self.opacity,
            emission: self.emission,
            shadow: self.diffuse * (1.0 - self.opacity),
            ..Material::DEFAULT
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_are_read_and_their_faults_told_with_the_line() {
        let text = "# two\nKa 1 1 1\nnewmtl red brick\nKd 0.8 0.2 0.1\nNs 98 # soft\nKs 0\nmap_Kd a.png\n\nnewmtl gold\nPm 1\nPr 0.2\nTr 0\n";
        let all = Told::read(text).unwrap();
        assert_eq!(all.iter().map(|m| m.name.as_str()).collect::<Vec<_>>(), ["red brick", "gold"]);
        let brick = all[0].material();
        assert_eq!((brick.colour, brick.f0), (Vec3::new(0.8, 0.2, 0.1), Vec3::ZERO));
        assert!((brick.roughness - 0.3761).abs() < 1e-3 && all[0].image);
        let gold = all[1].material();
        assert_eq!((gold.diffuse, gold.f0, gold.roughness), (0.0, Vec3::splat(0.55), 0.2));
        for (line, words) in [
            ("Kd 1 0", "2 numbers where 3 are needed"),
            ("Ns", "a number is missing"),
            ("d inf", "'inf' is no number"),
            ("Kd spectral a.rfl", "red, green and blue"),
        ] {
            let said = Told::read(&format!("newmtl a\n{line}\n")).unwrap_err();
            assert!(said.starts_with("line 2: ") && said.contains(words), "{line}: {said}");
        }
    }
}
