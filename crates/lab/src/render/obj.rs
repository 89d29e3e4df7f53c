//! Wavefront OBJ: vertices, normals, texture coordinates, polygons, materials by name.
//!
//! The format is that of Wavefront's Advanced Visualizer, appendix B1. What is about curves, points and
//! groups is passed over. Everything else that can't be read is an error that names its line.

use super::polygon::triangles;
use luc_core::math::Vec3;
use std::collections::HashMap;

/// A triangle with the places of its corners in the lists of its model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corners {
    /// Positions.
    pub at: [usize; 3],
    /// Texture coordinates, if the face has any.
    pub uv: Option<[usize; 3]>,
    /// Normals, if the face has any.
    pub normal: Option<[usize; 3]>,
    /// Index into the names of the materials.
    pub material: usize,
}

/// What a file holds.
#[derive(Debug, Default)]
pub struct Model {
    /// Positions, in the file's units.
    pub positions: Vec<Vec3>,
    /// Texture coordinates.
    pub uvs: Vec<[f32; 2]>,
    /// Normals, as they stand in the file.
    pub normals: Vec<Vec3>,
    /// All polygons, cut into triangles.
    pub triangles: Vec<Corners>,
    /// Names of the materials; the first, without a name, is that of faces before any.
    pub materials: Vec<String>,
    /// Files of materials that it names, with their lines.
    pub libraries: Vec<(usize, String)>,
}

/// Corners of a face before its indices are checked.
type Face = Vec<[Option<i64>; 3]>;

/// A number that is finite.
pub fn number(word: &str) -> Result<f32, String> {
    let value = word.parse::<f32>().ok().filter(|x| x.is_finite());
    value.ok_or_else(|| format!("'{word}' is no number"))
}

/// The first `N` of some words as numbers.
pub fn numbers<const N: usize>(words: &[&str]) -> Result<[f32; N], String> {
    let mut out = [0.0; N];
    for (i, out) in out.iter_mut().enumerate() {
        let word = words.get(i).ok_or_else(|| format!("{} numbers where {N} are needed", words.len()))?;
        *out = number(word)?;
    }
    Ok(out)
}

/// A corner: position, texture coordinates and normal as `v`, `v/vt`, `v//vn` or `v/vt/vn`.
fn corner(word: &str) -> Result<[Option<i64>; 3], String> {
    let mut out = [None; 3];
    for (i, part) in word.split('/').enumerate() {
        let place = out.get_mut(i).ok_or_else(|| format!("'{word}' has more than three parts"))?;
        if !part.is_empty() {
            let index = part.parse().ok().filter(|&i| i != 0);
            *place = Some(index.ok_or_else(|| format!("'{part}' is no index"))?);
        }
    }
    if out[0].is_none() { Err(format!("'{word}' has no position")) } else { Ok(out) }
}

/// An index from 1 on, or from the end on if it is negative, as one from 0 on.
fn index(i: i64, count: usize, what: &str) -> Result<usize, String> {
    let place = if i > 0 { i - 1 } else { count as i64 + i };
    let place = usize::try_from(place).ok().filter(|&place| place < count);
    place.ok_or_else(|| format!("there is no {what} {i}; {count} stand before it"))
}

impl Model {
    /// Reads the text of a file. An error begins with the line.
    pub fn read(text: &str) -> Result<Model, String> {
        let mut model = Model { materials: vec![String::new()], ..Model::default() };
        let mut names = HashMap::from([(String::new(), 0)]);
        let mut material = 0;
        // A line that ends with a backslash goes on in the next.
        let mut whole = String::new();
        for (i, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default().trim_end();
            if let Some(begun) = line.strip_suffix('\\') {
                whole += begun;
                whole.push(' ');
                continue;
            }
            whole += line;
            let words: Vec<&str> = whole.split_whitespace().collect();
            model
                .line(&words, i + 1, &mut names, &mut material)
                .map_err(|fault| format!("line {}: {fault}", i + 1))?;
            whole.clear();
        }
        Ok(model)
    }

    fn line(
        &mut self,
        words: &[&str],
        line: usize,
        names: &mut HashMap<String, usize>,
        material: &mut usize,
    ) -> Result<(), String> {
        let Some((&first, words)) = words.split_first() else { return Ok(()) };
        match first {
            "v" => self.positions.push(numbers(words).map(Vec3::from_array)?),
            "vn" => self.normals.push(numbers(words).map(Vec3::from_array)?),
            "vt" => {
                // The second coordinate may be left out.
                let [u] = numbers(words)?;
                self.uvs.push([u, words.get(1).map_or(Ok(0.0), |v| number(v))?]);
            }
            "f" | "fo" => {
                let corners = words.iter().map(|word| corner(word)).collect::<Result<Face, _>>()?;
                self.face(&corners, *material)?;
            }
            "usemtl" => {
                let count = names.len();
                *material = *names.entry(words.join(" ")).or_insert(count);
                if *material == self.materials.len() {
                    self.materials.push(words.join(" "));
                }
            }
            "mtllib" => self.libraries.push((line, words.join(" "))),
            _ => {}
        }
        Ok(())
    }

    fn face(&mut self, corners: &Face, material: usize) -> Result<(), String> {
        if corners.len() < 3 {
            return Err(format!("a face of {} corners", corners.len()));
        }
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let all = |part: usize, what: &str| -> Result<Option<Vec<usize>>, String> {
            let given = corners.iter().filter(|corner| corner[part].is_some()).count();
            if given == 0 {
                return Ok(None);
            }
            if given < corners.len() {
                return Err(format!("{given} of {} corners have a {what}", corners.len()));
            }
            corners
                .iter()
                .filter_map(|c| c[part])
                .map(|i| index(i, counts[part], what))
                .collect::<Result<_, _>>()
                .map(Some)
        };
        let at = all(0, "position")?.unwrap_or_default();
        let [uv, normal] = [all(1, "texture coordinate")?, all(2, "normal")?];
        let points: Vec<Vec3> = at.iter().map(|&i| self.positions[i]).collect();
        for three in triangles(&points) {
            let of = |list: &Vec<usize>| three.map(|k| list[k]);
            self.triangles.push(Corners {
                at: of(&at),
                uv: uv.as_ref().map(of),
                normal: normal.as_ref().map(of),
                material,
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luc_core::math::hash::hash2;

    const HOUSE: &str = "# a gable\nmtllib a b.mtl\nv 0 0 0\nv 2 0 0\nv 2 1 0 1.0\nv 1 2 \\\n0\nv 0 1 0 1 0 0\n\
        vt 0\nvt 1 0\nvt 1 1\nvn 0 0 1\no wall\ns off\nusemtl red brick\nf 1//1 2//1 3//1 4//1 5//1\n\
        usemtl slate\nf -5/1/-1 -4/2/-1 -3/3/-1\nl 1 2\nf 1 2 3\n";

    #[test]
    fn polygons_names_and_negative_indices_are_read() {
        let model = Model::read(HOUSE).unwrap();
        assert_eq!(model.positions.len(), 5);
        assert_eq!(model.positions[3], Vec3::new(1.0, 2.0, 0.0));
        assert_eq!(model.uvs, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
        assert_eq!(model.materials, ["", "red brick", "slate"]);
        assert_eq!(model.libraries, [(2, "a b.mtl".into())]);
        assert_eq!(model.triangles.len(), 5);
        let last = model.triangles[3];
        assert_eq!((last.at, last.uv, last.normal), ([0, 1, 2], Some([0, 1, 2]), Some([0; 3])));
        assert_eq!((last.material, model.triangles[4].normal), (2, None));
    }

    #[test]
    fn what_is_broken_is_told_with_its_line() {
        for (line, words) in [
            ("v 1 2", "2 numbers where 3 are needed"),
            ("v 1 x 2", "'x' is no number"),
            ("v 1 nan 2", "'nan' is no number"),
            ("v 1 1e60 2", "'1e60' is no number"),
            ("vt", "0 numbers where 1 are needed"),
            ("f 1 2", "a face of 2 corners"),
            ("f 1 2 0", "'0' is no index"),
            ("f 1 2 4", "there is no position 4; 3 stand before it"),
            ("f 1 2 -4", "there is no position -4"),
            ("f 1/1 2/1 3/1", "there is no texture coordinate 1; 0 stand"),
            ("f 1//1 2 3", "1 of 3 corners have a normal"),
            ("f 1/2/3/4 2 3", "more than three parts"),
            ("f /1 2 3", "has no position"),
            ("f 1 2 99999999999999999999", "is no index"),
        ] {
            let said = Model::read(&format!("v 0 0 0\nv 1 0 0\n\nv 0 1 0\n{line}\n")).unwrap_err();
            assert!(said.starts_with("line 5: ") && said.contains(words), "{line}: {said}");
        }
    }

    #[test]
    fn no_text_makes_the_reader_panic() {
        for seed in 0..4000 {
            let mut bytes = HOUSE.as_bytes().to_vec();
            for k in 0..1 + hash2(seed, 0) % 4 {
                let at = hash2(seed, 2 * k + 1) as usize % bytes.len();
                bytes[at] = b" 0123456789-/.\nvtnfe\\#"[hash2(seed, 2 * k + 2) as usize % 22];
            }
            let text = String::from_utf8(bytes).unwrap();
            if let Ok(model) = Model::read(&text) {
                let most = model.triangles.iter().flat_map(|t| t.at).max();
                assert!(most.is_none_or(|i| i < model.positions.len()), "seed {seed}");
            }
        }
    }
}
