//! The bar that is seen while the show is prepared: a thin warm line that grows over black.

/// The line's colour, that of the show's gold.
const WARM: u32 = 0xe8_b0_60;
/// What is still to do.
const DIM: u32 = 0x38_2b_1a;

/// Fills `out`, the pixels of a window of `width` by `height`, with the bar at `done` of `total`.
pub fn draw(out: &mut Vec<u32>, (width, height): (usize, usize), done: usize, total: usize) {
    out.clear();
    out.resize(width * height, 0);
    let left = width / 4;
    let length = (width / 2).max(1);
    let thick = (height / 240).max(1);
    let lit = (length * done / total.max(1)).min(length);
    for y in (height - thick) / 2..(height - thick) / 2 + thick {
        let line = &mut out[y * width + left..][..length];
        line[..lit].fill(WARM);
        line[lit..].fill(DIM);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_grows_with_the_work_done() {
        let mut out = Vec::new();
        let mut before = 0;
        for done in 0..=8 {
            draw(&mut out, (320, 180), done, 8);
            let lit = out.iter().filter(|&&p| p == WARM).count();
            assert_eq!(lit, 20 * done, "at {done} of 8");
            assert!(done == 0 || lit > before);
            before = lit;
            let line = out.iter().filter(|&&p| p != 0).count();
            assert_eq!(line, 160, "the whole line is always seen");
        }
    }

    #[test]
    fn any_window_can_hold_it() {
        for size in [(1, 1), (2, 1), (1, 1000), (3, 3), (7680, 4320)] {
            let mut out = Vec::new();
            draw(&mut out, size, 5, 3);
            assert_eq!(out.len(), size.0 * size.1);
            assert!(out.contains(&WARM));
        }
    }
}
