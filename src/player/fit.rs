//! The picture in a window of another shape: as large as fits, in the middle, black around it.
//!
//! minifb's own scaling repeats pixels, so the player does it: bilinear, in whole numbers. A source row
//! is widened once and then blended for all the rows between it and the next. Two colour channels are
//! worked on in one word, since they cannot reach each other in 16 bits.

/// A rectangle in the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    pub x: usize,
    pub y: usize,
    pub width: usize,
    pub height: usize,
}

/// The largest rectangle of the shape `picture` in the middle of `window`; sides are at least 1.
pub fn rect(picture: (usize, usize), window: (usize, usize)) -> Rect {
    let ((pw, ph), (ww, wh)) = (picture, window);
    // Rounded up, so that a window of the same shape up to a pixel is filled.
    let width = (wh * pw).div_ceil(ph).clamp(1, ww);
    let height = (ww * ph).div_ceil(pw).clamp(1, wh);
    Rect { x: (ww - width) / 2, y: (wh - height) / 2, width, height }
}

/// Fills `out`, the window's pixels, with `pixels` stretched over a rectangle of it.
pub fn fit(pixels: &[u32], picture: (usize, usize), r: &Rect, out: &mut Vec<u32>, window: (usize, usize)) {
    out.resize(window.0 * window.1, 0);
    out[..r.y * window.0].fill(0);
    out[(r.y + r.height) * window.0..].fill(0);
    // Two neighbouring source rows, widened; `held` is the number of the upper one.
    let mut upper = vec![0; r.width];
    let mut lower = vec![0; r.width];
    let mut held = None;
    // Dividing for each pixel of each row would take longer than all else.
    let columns: Vec<_> = (0..r.width).map(|x| source(x, r.width, picture.0)).collect();
    for y in 0..r.height {
        let (row, weight) = source(y, r.height, picture.1);
        if held != Some(row) {
            if held.is_some_and(|h| h + 1 == row) {
                std::mem::swap(&mut upper, &mut lower);
            } else {
                widen(&pixels[row * picture.0..][..picture.0], &columns, &mut upper);
            }
            let below = (row + 1).min(picture.1 - 1);
            widen(&pixels[below * picture.0..][..picture.0], &columns, &mut lower);
            held = Some(row);
        }
        let line = &mut out[(r.y + y) * window.0..][..window.0];
        line[..r.x].fill(0);
        line[r.x + r.width..].fill(0);
        for ((to, &a), &b) in line[r.x..].iter_mut().zip(&upper).zip(&lower) {
            *to = blend(a, b, weight);
        }
    }
}

/// Where the middle of pixel `i` of `to` falls among `from` pixels: the pixel left of it and the weight
/// of the next, of 256.
fn source(i: usize, to: usize, from: usize) -> (usize, u32) {
    let at = ((2 * i + 1) * from * 128 / to).saturating_sub(128);
    (at >> 8, (at & 255) as u32)
}

fn widen(from: &[u32], columns: &[(usize, u32)], to: &mut [u32]) {
    for (pixel, &(x, weight)) in to.iter_mut().zip(columns) {
        *pixel = blend(from[x], from[(x + 1).min(from.len() - 1)], weight);
    }
}

/// Mixes two colours, `weight` of 256 from `b`.
fn blend(a: u32, b: u32, weight: u32) -> u32 {
    const EVEN: u32 = 0xff_00ff;
    let keep = 256 - weight;
    let red_blue = ((a & EVEN) * keep + (b & EVEN) * weight) >> 8 & EVEN;
    let green = ((a >> 8 & EVEN) * keep + (b >> 8 & EVEN) * weight) & !EVEN;
    red_blue | green
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(pixels: &[u32], picture: (usize, usize), window: (usize, usize)) -> Vec<u32> {
        let mut out = vec![0xdead; 2_000];
        fit(pixels, picture, &rect(picture, window), &mut out, window);
        assert_eq!(out.len(), window.0 * window.1);
        out
    }

    #[test]
    fn the_picture_keeps_its_shape_in_the_middle() {
        assert_eq!(rect((1280, 720), (1280, 720)), Rect { x: 0, y: 0, width: 1280, height: 720 });
        assert_eq!(rect((1280, 720), (1920, 1200)), Rect { x: 0, y: 60, width: 1920, height: 1080 });
        assert_eq!(rect((1280, 720), (3440, 1440)), Rect { x: 440, y: 0, width: 2560, height: 1440 });
        assert_eq!(rect((1280, 720), (1366, 768)), Rect { x: 0, y: 0, width: 1366, height: 768 });
        assert_eq!(rect((1, 4320), (100, 100)), Rect { x: 49, y: 0, width: 1, height: 100 });
        assert_eq!(rect((7680, 1), (1, 1)), Rect { x: 0, y: 0, width: 1, height: 1 });
    }

    #[test]
    fn every_window_is_covered_without_leaving_it() {
        let pixels: Vec<u32> = (0..35).map(|i| i * 0x1_0203).collect();
        for width in 1..40 {
            for height in 1..40 {
                fitted(&pixels, (7, 5), (width, height));
            }
        }
    }

    #[test]
    fn the_same_size_is_the_same_picture() {
        let pixels: Vec<u32> = (0..35).map(|i| i * 0x7_0501).collect();
        assert_eq!(fitted(&pixels, (7, 5), (7, 5)), pixels);
    }

    #[test]
    fn one_colour_stays_exact_and_the_bars_are_black() {
        let out = fitted(&[0xfe_80_01; 6], (3, 2), (30, 40));
        for (i, &p) in out.iter().enumerate() {
            let inside = (10..30).contains(&(i / 30));
            assert_eq!(p, if inside { 0xfe_80_01 } else { 0 }, "row {}", i / 30);
        }
    }

    #[test]
    fn doubling_blends_a_quarter_and_three_quarters() {
        let out = fitted(&[0x00_00_00, 0x80_40_20], (2, 1), (4, 2));
        assert_eq!(out[..4], [0x00_00_00, 0x20_10_08, 0x60_30_18, 0x80_40_20]);
        assert_eq!(out[4..], out[..4]);
    }
}
