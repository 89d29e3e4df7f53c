//! crossbeam-deque: one queue behind a lock, without its collector of garbage.
//!
//! Tasks of the engine are long, so the queue is rarely asked for.

use super::super::edit::Source;
use crate::Error;

/// Replaces the crate's source.
pub fn trim(source: &mut Source) -> Result<(), Error> {
    source.replace_file("src/lib.rs", CROSSBEAM_DEQUE, "replace its queues")
}

const CROSSBEAM_DEQUE: &str = r#"
use std::cell::UnsafeCell;
use std::marker::PhantomData;
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

    /// The newest task.
    #[inline(never)]
    fn take(&self) -> Option<T> {
        self.with(|tasks| tasks.pop())
    }

    pub fn steal(&self) -> Steal<T> {
        match self.take() {
            Some(task) => Steal::Success(task),
            None => Steal::Empty,
        }
    }

    #[inline(never)]
    pub fn is_empty(&self) -> bool {
        self.with(|tasks| tasks.is_empty())
    }
}

/// A thread's own queue, which nothing is ever put in: the pool keeps one for all.
pub struct Worker<T>(PhantomData<T>);

impl<T> Worker<T> {
    pub fn new_lifo() -> Self {
        Worker(PhantomData)
    }

    pub fn stealer(&self) -> Stealer<T> {
        Stealer(PhantomData)
    }

    pub fn push(&self, _: T) {}

    pub fn is_empty(&self) -> bool {
        true
    }
}

/// The other end, for other threads.
pub struct Stealer<T>(PhantomData<T>);

impl<T> Stealer<T> {
    pub fn steal(&self) -> Steal<T> {
        Steal::Empty
    }

    pub fn is_empty(&self) -> bool {
        true
    }
}
"#;
