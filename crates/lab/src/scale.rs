//! Pictures scaled up bilinearly, as the player does.

use crate::metric::Picture;
use luc_core::parallel;

/// Fills `out` with `small`, scaled up; centres of pixels stay where they are.
pub fn enlarge(small: &Picture, out: &mut Picture) {
    let (from, to) = (small.size, out.size);
    let place = |i: usize, from: u32, to: u32| {
        let at = ((i as f32 + 0.5) * from as f32 / to as f32 - 0.5).max(0.0);
        let low = (at as usize).min(from as usize - 1);
        (low, (low + 1).min(from as usize - 1), at - low as f32)
    };
    let columns: Vec<_> = (0..to.0 as usize).map(|x| place(x, from.0, to.0)).collect();
    parallel::each(out.pixels.chunks_mut(to.0 as usize), |y, row| {
        let (top, bottom, v) = place(y, from.1, to.1);
        let [top, bottom] = [top, bottom].map(|y| &small.pixels[y * from.0 as usize..]);
        for (pixel, &(left, right, u)) in row.iter_mut().zip(&columns) {
            let channel = |shift: u32| {
                let value = |row: &[u32], x: usize| (row[x] >> shift & 255) as f32;
                let mix = |row| value(row, left) + (value(row, right) - value(row, left)) * u;
                (((mix(top) + (mix(bottom) - mix(top)) * v + 0.5) as u32).min(255)) << shift
            };
            *pixel = channel(16) | channel(8) | channel(0);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_stays_even_and_equal_size_stays_the_same() {
        let grey = Picture { size: (3, 2), pixels: vec![0x0012_80ff; 6] };
        let mut out = Picture::new((11, 7));
        enlarge(&grey, &mut out);
        assert!(out.pixels.iter().all(|&p| p == 0x0012_80ff));
        let ramp = Picture { size: (3, 2), pixels: vec![1, 2, 3, 0x40_0000, 5, 6] };
        let mut same = Picture::new((3, 2));
        enlarge(&ramp, &mut same);
        assert_eq!(same.pixels, ramp.pixels);
    }
}
