//! The one way in which work is spread over threads: a list of independent tasks.
//!
//! Each task writes to places of its own, so the order in which threads take them can't show. Type
//! erasure keeps a single copy of the thread pool's machinery in the program, where each parallel
//! iterator would bring its own (1 to 4 kB).

/// A piece of work.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Runs all tasks on the current rayon pool and returns when all are done.
pub fn run(tasks: impl Iterator<Item = impl FnOnce() + Send>) {
    start(tasks.map(|task| Box::new(task) as Task).collect());
}

#[inline(never)]
fn start(tasks: Vec<Task>) {
    rayon::scope(|scope| {
        for task in tasks {
            scope.spawn(|_| task());
        }
    });
}
