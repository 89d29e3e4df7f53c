//! crossbeam-deque: the same queues behind a lock each, without its collector of garbage.
//!
//! Tasks of the engine are long, so queues are rarely asked for.

use super::super::edit::Source;
use crate::Error;

/// Replaces the crate's source.
pub fn trim(source: &mut Source) -> Result<(), Error> {
    source.replace_file("src/lib.rs", CROSSBEAM_DEQUE, "replace its queues")
}

const CROSSBEAM_DEQUE: &str = r#"
use std::cell::UnsafeCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

extern "C" {
    fn sched_yield() -> i32;
}

/// A queue that anyone may push to and take from.
pub struct Injector<T> {
    locked: AtomicBool,
    tasks: UnsafeCell<Vec<T>>,
}

unsafe impl<T: Send> Send for Injector<T> {}
unsafe impl<T: Send> Sync for Injector<T> {}

/// What taking from a queue gave.
pub enum Steal<T> {
    Empty,
    Success(T),
    Retry,
}

impl<T> Injector<T> {
    pub fn new() -> Self {
        Injector { locked: AtomicBool::new(false), tasks: UnsafeCell::new(Vec::new()) }
    }

    fn with<R>(&self, act: impl FnOnce(&mut Vec<T>) -> R) -> R {
        while self.locked.swap(true, Ordering::SeqCst) {
            unsafe { sched_yield() };
        }
        let result = act(unsafe { &mut *self.tasks.get() });
        self.locked.store(false, Ordering::SeqCst);
        result
    }

    #[inline(never)]
    pub fn push(&self, task: T) {
        self.with(|tasks| tasks.push(task))
    }

    /// The oldest task, or the newest.
    #[inline(never)]
    fn take(&self, oldest: bool) -> Option<T> {
        self.with(|tasks| {
            let end = tasks.len().checked_sub(1)?;
            Some(tasks.remove(if oldest { 0 } else { end }))
        })
    }

    pub fn steal(&self) -> Steal<T> {
        match self.take(true) {
            Some(task) => Steal::Success(task),
            None => Steal::Empty,
        }
    }

    #[inline(never)]
    pub fn is_empty(&self) -> bool {
        self.with(|tasks| tasks.is_empty())
    }
}

/// The end of a queue for the thread that owns it: last in, first out.
pub struct Worker<T>(Arc<Injector<T>>);

impl<T> Worker<T> {
    pub fn new_lifo() -> Self {
        Worker(Arc::new(Injector::new()))
    }

    pub fn stealer(&self) -> Stealer<T> {
        Stealer(self.0.clone())
    }

    pub fn push(&self, task: T) {
        self.0.push(task)
    }

    pub fn pop(&self) -> Option<T> {
        self.0.take(false)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// The other end, for other threads.
pub struct Stealer<T>(Arc<Injector<T>>);

impl<T> Stealer<T> {
    pub fn steal(&self) -> Steal<T> {
        self.0.steal()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
"#;
