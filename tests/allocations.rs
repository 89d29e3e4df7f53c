//! What a frame takes from the heap when its buffers are there: nothing, on any number of threads, in any part
//! and quality, also where smoke goes on by a step and figures are written over the picture.
//!
//! Set `LUC_TELL=1` and run with `--nocapture` to see what a part's first frame takes, and its scene.

use luc::show::{self, Part};
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator, which counts what the threads that render take.
struct Counting;

/// Pieces and bytes.
static TAKEN: [AtomicUsize; 2] = [const { AtomicUsize::new(0) }; 2];

thread_local! {
    /// Whether this thread renders: what the test harness takes at the same time doesn't count.
    static RENDERS: Cell<bool> = const { Cell::new(false) };
}

fn count(size: usize) {
    if RENDERS.get() {
        TAKEN[0].fetch_add(1, Relaxed);
        TAKEN[1].fetch_add(size, Relaxed);
    }
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc_zeroed(layout) }
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

/// One test at a time counts.
static TURN: Mutex<()> = Mutex::new(());

/// Pieces and bytes that `work` takes.
fn taken(work: impl FnOnce()) -> [usize; 2] {
    TAKEN.iter().for_each(|n| n.store(0, Relaxed));
    work();
    TAKEN.each_ref().map(|n| n.load(Relaxed))
}

/// So many threads, all awake, that count.
fn pool(threads: usize) -> ThreadPool {
    let builder = ThreadPoolBuilder::new().num_threads(threads).start_handler(|_| RENDERS.set(true));
    let pool = builder.build().unwrap();
    pool.broadcast(|_| ());
    pool
}

/// What each of `frames` takes with one renderer.
fn frames(
    pool: &ThreadPool,
    part: &Part,
    frames: impl Iterator<Item = u64>,
    size: (u32, u32),
    quality: &Quality,
) -> Vec<[usize; 2]> {
    let mut renderer = Renderer::default();
    let mut pixels = vec![0; (size.0 * size.1) as usize];
    let mut draw = |n| {
        let mut scene = Scene::default();
        let built = pool.install(|| taken(|| scene = (part.scene)(n)));
        if std::env::var_os("LUC_TELL").is_some() {
            println!("{:7} frame {n}: its scene takes {built:?}", part.name);
        }
        pool.install(|| taken(|| renderer.frame(&scene, n, size, quality, &mut pixels)))
    };
    frames.map(&mut draw).collect()
}

#[test]
fn a_frame_drawn_again_takes_nothing_on_any_number_of_threads() {
    let _turn = TURN.lock();
    let (_, quality) = Quality::PRESETS[Quality::DEFAULT];
    for (threads, size) in [(1, (320, 192)), (2, (320, 192)), (3, (320, 192)), (2, (640, 384))] {
        let pool = pool(threads);
        for part in show::PARTS {
            let n = part.frames / 8;
            let [first, again @ ..] = &frames(&pool, part, [n; 4].into_iter(), size, &quality)[..] else {
                panic!("four frames")
            };
            let tiles = size.0 as usize * size.1 as usize * 3 * 4;
            assert!(first[1] > tiles, "{}: the first frame makes the tiles, {first:?}", part.name);
            assert_eq!(again, [[0; 2]; 3], "{} at {size:?} on {threads} threads, after {first:?}", part.name);
        }
    }
}

/// As in the show, one frame after another, where smoke goes on by a step and the figures change. A list that holds
/// more than ever before still grows, to twice its room, so that the part's first frames come before.
#[test]
fn frames_that_follow_take_nothing() {
    let _turn = TURN.lock();
    let (_, quality) = Quality::PRESETS[Quality::DEFAULT];
    let pool = pool(1);
    for part in show::PARTS {
        let n = part.frames / 8;
        let all = frames(&pool, part, n..n + 20, (320, 192), &quality);
        assert_eq!(all[8..], [[0; 2]; 12], "{} from {n} on: {all:?}", part.name);
    }
}

#[test]
fn every_quality_takes_nothing() {
    let _turn = TURN.lock();
    let pool = pool(2);
    for (name, quality) in &Quality::PRESETS {
        for part in show::PARTS {
            let n = part.frames / 2;
            let all = frames(&pool, part, [n; 3].into_iter(), (100, 60), quality);
            assert_eq!(all[1..], [[0; 2]; 2], "{} at {name}, after {:?}", part.name, all[0]);
        }
    }
}
