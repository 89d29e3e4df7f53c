//! What a frame takes from the heap when its buffers are there: after the first frame of its part no list
//! of samples, rays or pixels is allocated, however large the picture. What is left are two small pieces
//! for each task that threads share, and the tables of the stage, which are made anew for each frame as the
//! scene is.

use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator, which counts.
struct Counting;

/// Pieces, those over [`SMALL`], and the bytes of those.
static TAKEN: [AtomicUsize; 3] = [const { AtomicUsize::new(0) }; 3];

/// Bytes of a task, and more.
const SMALL: usize = 128;

fn count(size: usize) {
    TAKEN[0].fetch_add(1, Relaxed);
    if size > SMALL {
        TAKEN[1].fetch_add(1, Relaxed);
        TAKEN[2].fetch_add(size, Relaxed);
    }
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, piece: *mut u8, layout: Layout) {
        unsafe { System.dealloc(piece, layout) }
    }

    unsafe fn realloc(&self, piece: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        unsafe { System.realloc(piece, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What `work` takes.
fn taken(work: impl FnOnce()) -> [usize; 3] {
    TAKEN.iter().for_each(|n| n.store(0, Relaxed));
    work();
    TAKEN.each_ref().map(|n| n.load(Relaxed))
}

#[test]
fn a_frame_whose_buffers_are_there_takes_no_more_for_more_pixels() {
    let (_, quality) = Quality::PRESETS[Quality::DEFAULT];
    // On one thread, so that its buffers have met all tiles.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for part in show::PARTS {
        let n = part.frames / 8;
        let frame = |size: (u32, u32)| {
            let mut renderer = Renderer::default();
            let mut pixels = vec![0; (size.0 * size.1) as usize];
            let scene = (part.scene)(n);
            let mut draw =
                || pool.install(|| taken(|| renderer.frame(&scene, n, size, &quality, &mut pixels)));
            [draw(), draw(), draw()]
        };
        let [small, large] = [(320, 192), (640, 384)].map(frame);
        let name = part.name;
        for [_, pieces, bytes] in [small[2], large[2]] {
            assert!(pieces <= 16 && bytes < 200_000, "{name}: {pieces} pieces of {bytes} bytes");
        }
        assert!(
            large[2][1] <= small[2][1] + 1,
            "{name}: more pieces in a larger picture, {small:?} {large:?}"
        );
        // Three passes over 60 tiles and some over strips of rows, twice in a split frame.
        assert!(large[2][0] <= 24 * 60, "{name}: {} pieces", large[2][0]);
        assert!(large[0][2] > 60 * 3 * 4 * 64 * 64, "{name}: the first frame makes the tiles");
    }
}
