//! Text as light: letters of straight strokes, each a short beam.
//!
//! A letter is drawn on a grid three or four steps wide and five high, corners cut, in one or more
//! lines of a pen. A beam looks the brighter the more one looks along it; its colour makes up for that,
//! so that words that lie on a floor are as even as words that stand.

use luc_core::math::{Vec3, cross, normalize};
use luc_core::scene::Beam;

/// After each space a letter's name, and the points of its lines, x and y; a comma lifts the pen, but as a name
/// it is the decimal point.
macro_rules! font {
    ($($more:literal)?) => {
        concat!(
            "  10 A000415253430,0232 B000525342303,2332312000 C3425150401102031 E30000535,0323 \
             F000535,0323 G34251504011020313222 H0005,3035,0333 I0005 K0005,3502,1330 L050030 N00053035 \
             O102031342515040110 P00052534332202 R00052534332202,1230 S3425150413233231201001 T0545,2520 \
             U050110203135 V052045 W0510243045 Y052245,2220 63425150401102031322303 432022520 .2222",
            $($more)?
        )
    };
}

/// The letters of the words that the program has.
#[cfg(not(feature = "cost"))]
const FONT: &[u8] = font!().as_bytes();
#[cfg(feature = "cost")]
const FONT: &[u8] = font!(
    " D000525343120,0020 d3530,331302011030 M0005234540 ,0000 0102031342515040110 1042520,1030 204152534330030 \
     304152534332313,233231201001 5350503233231201001 7053510 81304152534231302011020313223 \
     90110203134251504031232"
)
.as_bytes();

/// Grid steps between two letters.
const GAP: f32 = 1.7;

/// A line of text that stands or lies somewhere.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    pub words: &'a [u8],
    /// Lower left corner of its first letter, world.
    pub origin: Vec3,
    /// A step of the grid to the right, world units along x.
    pub right: f32,
    /// A step of the grid up, world.
    pub up: Vec3,
    /// Of the strokes, see [`Beam::width`].
    pub width: f32,
    pub colour: Vec3,
}

/// Adds the strokes of the first `shown` letters to `beams`; the last of them is dimmed by the fraction.
#[inline(never)]
pub fn write(beams: &mut Vec<Beam>, line: &Line, eye: Vec3, mut shown: f32) {
    let mut origin = line.origin;
    for &name in line.words {
        if shown <= 0.0 {
            return;
        }
        let (mut wide, mut found, mut pen) = (0.0, false, None);
        let mut i = 0;
        while i < FONT.len() {
            let (a, b) = (FONT[i], FONT[i + 1]);
            i += 1;
            if a == b',' {
                pen = None;
                continue;
            }
            i += 1;
            if a == b' ' {
                (found, pen) = (b == name, None);
            } else if found {
                let step = |c: u8| i32::from(c - b'0') as f32;
                let to = origin + Vec3::X * (step(a) * line.right) + line.up * step(b);
                wide = step(a).max(wide);
                if let Some(from) = pen.replace(to) {
                    let along: Vec3 = to - from;
                    let sine = cross(along.normalize_or(Vec3::X), normalize(to - eye)).length();
                    let colour = line.colour * (shown.min(1.0) * sine);
                    beams.push(Beam { from, to, width: line.width, colour, fade: 0.0 });
                }
            }
        }
        origin.x += (wide + GAP) * line.right;
        shown -= 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_the_show_have_their_letters_and_no_more() {
        let lines = super::super::end::WORDS.into_iter().chain([super::super::luc::LINE.words]);
        #[allow(unused_mut, reason = "not all programs have all parts")]
        let mut text: Vec<u8> = lines.flatten().copied().collect();
        #[cfg(feature = "cost")]
        {
            text.extend(super::super::cost::CAPTIONS.concat());
            text.extend(b"0123456789");
        }
        for name in &text {
            assert!(FONT.windows(2).any(|pair| pair == [b' ', *name]), "{}", char::from(*name));
        }
        for letter in FONT.split(|&b| b == b' ').skip(3) {
            assert!(text.contains(&letter[0]), "{} is never written", char::from(letter[0]));
        }
    }

    #[test]
    fn every_letter_lies_on_the_grid_and_in_its_place() {
        for name in FONT.split(|&b| b == b' ').skip(3).filter_map(|glyph| glyph.first()) {
            let words = [*name, *name];
            let line = Line {
                words: Box::leak(Box::new(words)),
                origin: Vec3::ZERO,
                right: 1.0,
                up: Vec3::Y,
                width: 0.1,
                colour: Vec3::ONE,
            };
            let (mut one, mut two) = (Vec::new(), Vec::new());
            write(&mut one, &line, Vec3::new(2.0, 2.0, 1e6), 1.0);
            write(&mut two, &line, Vec3::new(2.0, 2.0, 1e6), 2.0);
            let letter = char::from(*name);
            assert!(!one.is_empty(), "{letter} has no strokes");
            assert_eq!(two.len(), 2 * one.len(), "{letter} twice");
            let wide = one.iter().map(|beam| beam.from.x.max(beam.to.x)).fold(0.0, f32::max);
            for beam in &one {
                assert!(beam.from.x.min(beam.to.x) >= 0.0 && wide <= 4.0, "{letter} {beam:?}");
                assert!((0.0..8.0).contains(&beam.from.y) && (0.0..8.0).contains(&beam.to.y), "{letter}");
                assert!((beam.colour - 1.0).abs().max_element() < 1e-3, "{letter} faces the eye: {beam:?}");
            }
            let moved = two[one.len()].from - one[0].from;
            assert!((moved - Vec3::X * (wide + GAP)).length() < 1e-5, "{letter} moved by {moved}");
        }
    }

    #[test]
    fn no_word_is_cut_off_at_any_shape_of_the_picture() {
        use super::super::{end, luc};
        let mut seen = [0; 2];
        let luc = (0..144).map(|i| ("luc", 5 * i, luc::scene(5 * i), luc::LINE.width));
        let end = (0..96).map(|i| ("end", 5 * i, end::scene(5 * i), end::STROKE));
        for (part, frame, scene, width) in luc.chain(end) {
            let (camera, view) = (scene.camera, scene.camera.world_from_camera().transpose());
            for beam in scene.beams.iter().filter(|beam| beam.width == width) {
                seen[(part == "end") as usize] += 1;
                for world in [beam.from, beam.to] {
                    let p = view * (world - camera.position);
                    // Half of a picture 16 wide, with half a stroke to spare.
                    let at = (p.truncate().abs() + width) * (8.0 / p.z / camera.half_width());
                    for (w, h) in
                        [(16.0, 9.0), (16.0, 10.0), (4.0, 3.0), (21.0, 9.0), (1.0, 1.0), (32.0, 9.0)]
                    {
                        let spanned: f32 = f32::min(w, h * 16.0 / 9.0);
                        let room = [w, h].map(|side| side * 8.0 / spanned);
                        assert!(
                            at.x < room[0] && at.y < room[1],
                            "{part} {frame} at {w}:{h}: {at} of {room:?}"
                        );
                    }
                }
            }
        }
        assert!(seen.iter().all(|&strokes| strokes > 1000), "{seen:?} strokes");
    }
}
