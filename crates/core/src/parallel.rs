//! The one way in which work is spread over threads: the same work on each item of a list.
//!
//! Each task writes to places of its own, so the order in which threads take them can't show. Type
//! erasure keeps a single copy of the thread pool's machinery in the program, where each parallel
//! iterator would bring its own (1 to 4 kB).

/// A piece of work.
type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Calls `work` with each item and its number on the current rayon pool; returns when all is done.
pub fn each<T: Send>(items: impl Iterator<Item = T> + Send, work: impl Fn(usize, T) + Sync) {
    let work = &work;
    let mut items = items.enumerate();
    start(&mut || {
        let (i, item) = items.next()?;
        Some(Box::new(move || work(i, item)))
    });
}

#[inline(never)]
fn start<'a>(next: &mut (dyn FnMut() -> Option<Task<'a>> + Send)) {
    rayon::scope(|scope| {
        while let Some(task) = next() {
            scope.spawn(|_| task());
        }
    });
}
