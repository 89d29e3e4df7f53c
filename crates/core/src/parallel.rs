//! The one way in which work is spread over threads: the same work on each item of a list.
//!
//! Self-scheduling: each thread takes the next item as soon as it is done with one, so long and short ones
//! share out evenly. An item's work writes to places of its own, so which thread took it can't show. Nothing
//! here is on the heap, and type erasure keeps a single copy of the thread pool's machinery in the program,
//! where each parallel iterator would bring its own (1 to 4 kB).

use std::iter::Enumerate;
use std::sync::Mutex;

/// Calls `work` with each item and its number on the current rayon pool; returns when all is done.
pub fn each<T: Send>(items: impl ExactSizeIterator<Item = T> + Send, work: impl Fn(usize, T) + Sync) {
    let workers = items.len().min(rayon::current_num_threads());
    share(workers, &List { items: Mutex::new(items.enumerate()), work });
}

/// A list and what is to be done with its items.
struct List<I, W> {
    items: Mutex<Enumerate<I>>,
    work: W,
}

/// Work that any number of threads may join in. Not a closure: of those an object has three entries.
trait Task: Sync {
    /// Returns when nothing is left to take.
    fn join_in(&self);
}

impl<T, I: Iterator<Item = T> + Send, W: Fn(usize, T) + Sync> Task for List<I, W> {
    fn join_in(&self) {
        while let Some((i, item)) = next(&self.items) {
            (self.work)(i, item);
        }
    }
}

/// Holds the lock only while it takes an item; none if a thread panicked as it did.
#[inline(never)]
fn next<I: Iterator>(items: &Mutex<I>) -> Option<I::Item> {
    items.lock().ok()?.next()
}

/// Has so many workers join in, on as many threads as have nothing else to do; by halves, so that all are soon
/// awake.
#[inline(never)]
fn share(workers: usize, task: &dyn Task) {
    if workers > 1 {
        rayon::join(|| share(workers / 2, task), || share(workers - workers / 2, task));
    } else {
        task.join_in();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_item_is_taken_once_with_its_number_on_any_number_of_threads() {
        for threads in [1, 2, 3, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for count in [0, 1, 2, 7, 1000] {
                let mut items: Vec<usize> = (0..count).map(|i| 3 * i).collect();
                pool.install(|| each(items.iter_mut(), |i, item| *item += i + 1));
                assert!(items.iter().enumerate().all(|(i, &item)| item == 4 * i + 1), "{count} on {threads}");
            }
        }
    }

    /// Work within work, as when a scene is built while another is drawn.
    #[test]
    fn work_may_share_out_work() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let mut sums = [0_usize; 40];
        pool.install(|| {
            each(sums.iter_mut(), |i, sum| {
                let mut parts = [0; 9];
                each(parts.iter_mut(), |k, part| *part = i * k);
                *sum = parts.iter().sum();
            });
        });
        assert!(sums.iter().enumerate().all(|(i, &sum)| sum == 36 * i), "{sums:?}");
    }
}
