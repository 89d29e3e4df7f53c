//! rayon-core: one pool, which never ends, of threads that the C library starts and that take work from one
//! queue and sleep in one place.
//!
//! As many threads as the system lets this process run on: the published crate also asks environment
//! variables, and the standard library reads the limits of control groups from files.

use super::super::edit::Source;
use crate::Error;

/// Trims the crate.
pub fn trim(source: &mut Source) -> Result<(), Error> {
    source.replace(
        "src/lib.rs",
        "            let default = || {\n                thread::available_parallelism()",
        "        }\n    }\n\n    /// Get the thread name for the thread with the given index.",
        RAYON_COUNT,
        "replace the default number of threads",
    )?;
    let registry = "src/registry.rs";
    let edit = "start threads by the C library";
    source.replace(
        registry,
        "        let mut b = thread::Builder::new();",
        "    }\n}\n\n/// Spawns a thread with a user's custom callback.",
        RAYON_SPAWN,
        edit,
    )?;

    let edit = "keep one pool that never ends";
    source.replace(
        registry,
        "        let breadth_first = builder.get_breadth_first();",
        "    pub(super) fn current() -> Arc<Registry> {",
        RAYON_NEW,
        edit,
    )?;
    source.replace(
        registry,
        "    // If we're running in an environment that doesn't support threads at all",
        "struct Terminator<'a>",
        "    result\n}\n\n",
        edit,
    )?;
    source.replace_text(
        registry,
        "        for info in &self.thread_infos {\n            info.primed.wait();\n        }\n",
        "",
        edit,
    )?;
    source.replace(
        registry,
        "    let worker_thread = &WorkerThread::from(thread);",
        "/// If already in a worker-thread, just execute `op`.",
        RAYON_LOOP,
        edit,
    )?;
    source.replace(
        registry,
        "        Latch::set(&registry.thread_infos[index].stopped);",
        "    fn find_work(&self)",
        "    }\n\n",
        edit,
    )?;
    source.replace(
        registry,
        "    /// Latch set once thread has started",
        "    /// The latch used to signal that terminated",
        "",
        edit,
    )?;
    source.replace_text(
        registry,
        "            primed: LockLatch::new(),\n            stopped: LockLatch::new(),\n",
        "",
        edit,
    )?;
    source.replace(registry, "            } else if (*worker_thread).registry().id() != self.id() {", "            } else {\n                // Perfectly valid to give them a `&T`: this is the\n                // current thread, so we know the data structure won't be\n                // invalidated until we return.\n                op(&*worker_thread, false)", "", edit)?;

    let edit = "leave out broadcasts";
    source.replace_text(
        registry,
        "    stealer: Stealer<JobRef>,\n    registry: Arc<Registry>,\n    index: usize,\n}",
        "    registry: Arc<Registry>,\n    index: usize,\n}",
        edit,
    )?;
    source.replace_text(
        registry,
        "    /// the \"stealer\" half of the worker's broadcast deque\n    stealer: Stealer<JobRef>,\n",
        "",
        edit,
    )?;
    source.replace_text(registry, "            stealer: thread.stealer,\n", "", edit)?;
    source.replace(
        registry,
        "        loop {\n            match self.stealer.steal() {",
        "    fn has_injected_job(&self) -> bool {\n        !self.stealer.is_empty()",
        "        None\n    }\n\n",
        edit,
    )?;
    source.replace_text(registry, "!self.stealer.is_empty() || self.registry", "self.registry", edit)?;

    let edit = "choose victims without hashing";
    source.replace(
        registry,
        "        // Any non-zero seed will do",
        "        XorShift64Star {\n            state: Cell::new(seed),",
        RAYON_SEED,
        edit,
    )?;
    one_queue(source)?;
    for_ever(source)
}

/// All work in the queue that anyone may push to, the newest first, and all who have none asleep in one place.
fn one_queue(source: &mut Source) -> Result<(), Error> {
    let edit = "keep one queue";
    let registry = "src/registry.rs";
    for (start, end, new) in [
        (
            "        let worker_thread = WorkerThread::current();\n        unsafe {\n            if !worker_thread.is_null() && (",
            "    /// Push a job into the \"external jobs\" queue",
            "        self.inject(job_ref);\n    }\n\n",
        ),
        (
            "        let queue_was_empty = self.injected_jobs.is_empty();",
            "    fn has_injected_job(&self) -> bool {\n        !self.injected",
            "        self.injected_jobs.push(injected_job);\n        self.sleep.wake();\n    }\n\n",
        ),
        (
            "        let queue_was_empty = self.worker.is_empty();",
            "    #[inline]\n    pub(super) unsafe fn push_fifo",
            "        self.registry.inject(job);\n    }\n\n",
        ),
        (
            "        let popped_job = self.worker.pop();",
            "    fn has_injected_job(&self) -> bool {\n        self",
            "        None\n    }\n\n",
        ),
        ("            // Check for local work *before*", "            let mut idle_state = self", ""),
        (
            "            let mut idle_state = self",
            "            while !latch.probe() {",
            "            let mut rounds = 0;\n",
        ),
        (
            "                    self.registry.sleep.work_found();\n                    self.execute",
            "                    // The job might",
            "                    self.execute(job);\n",
        ),
        (
            "                    self.registry\n                        .sleep\n",
            "        mem::forget(abort_guard); // successful execution, do not",
            RAYON_WAIT,
        ),
        (
            "        self.take_local_job()\n            .or_else",
            "    pub(super) fn yield_now",
            "        self.registry.pop_injected_job()\n    }\n\n",
        ),
    ] {
        source.replace(registry, start, end, new, edit)?;
    }
    for call in [
        "self.sleep.notify_worker_latch_is_set(i)",
        "self.sleep.notify_worker_latch_is_set(target_worker_index)",
    ] {
        source.replace_text(registry, call, "self.sleep.wake()", edit)?;
    }
    source.replace_text(
        "src/latch.rs",
        "        let old_state = (*this).state.swap(SET, Ordering::AcqRel);\n        old_state == SLEEPING\n",
        "        (*this).state.store(SET, Ordering::SeqCst);\n        true\n",
        edit,
    )?;
    source.replace_file("src/sleep/mod.rs", RAYON_SLEEP, edit)
}

/// What lives as long as the program needs no counts of those who hold it, and is never asked whether it is
/// there: the player makes the pool before all else.
fn for_ever(source: &mut Source) -> Result<(), Error> {
    let edit = "let the pool live for ever";
    let registry = "src/registry.rs";
    for file in [
        "src/latch.rs",
        "src/scope/mod.rs",
        "src/spawn/mod.rs",
        "src/thread_pool/mod.rs",
        "src/broadcast/mod.rs",
    ] {
        source.replace_text(file, "use std::sync::Arc;\n", "use crate::for_ever::Arc;\n", edit)?;
    }
    let (old, new) = ("job: Arc<ArcJob<FUNC>>", "job: std::sync::Arc<ArcJob<FUNC>>");
    source.replace_text("src/scope/mod.rs", old, new, edit)?;
    source.replace_text(registry, "use std::sync::{Arc, Once};\n", "use crate::for_ever::Arc;\n", edit)?;
    source.replace_text("src/lib.rs", "mod sleep;\n", RAYON_FOR_EVER, edit)?;
    for (start, end, new) in [
        (
            "static THE_REGISTRY_SET: Once",
            "/// Starts the worker threads (if that has not already happened). If",
            "",
        ),
        (
            "    set_global_registry(default_global_registry)\n",
            "/// Starts the worker threads (if that has not already happened) with\n",
            "    unsafe { (*ptr::addr_of!(THE_REGISTRY)).as_ref().unwrap_unchecked() }\n}\n\n",
        ),
        (
            "    let mut result = Err(ThreadPoolBuildError::new(\n        ErrorKind::GlobalPool",
            "fn default_global_registry()",
            RAYON_SET,
        ),
        (
            "        let previous = self.terminate_count.fetch_add(1, Ordering::AcqRel);",
            "    /// Signals that the thread pool which owns",
            "    }\n\n",
        ),
        (
            "        if self.terminate_count.fetch_sub(1, Ordering::AcqRel) == 1 {",
            "    /// Notify the worker that the latch",
            "    }\n\n",
        ),
        (
            "        thread_local!(static LOCK_LATCH",
            "            // This thread isn't a member of *any* thread pool",
            "        (|l: &LockLatch| {\n",
        ),
        (
            "            job.latch.wait_and_reset();",
            "    #[cold]\n    unsafe fn in_worker_cross",
            "            job.latch.wait();\n\n            job.into_result()\n        })(&LockLatch::new())\n    }\n\n",
        ),
    ] {
        source.replace(registry, start, end, new, edit)?;
    }
    Ok(())
}

const RAYON_SPAWN: &str = r#"        unsafe extern "C" {
            fn pthread_create(
                thread: *mut usize,
                attributes: *const u8,
                start: extern "C" fn(*mut ThreadBuilder) -> *mut u8,
                argument: *mut ThreadBuilder,
            ) -> i32;
        }
        extern "C" fn start(thread: *mut ThreadBuilder) -> *mut u8 {
            unsafe { main_loop(*Box::from_raw(thread)) };
            ptr::null_mut()
        }
        let thread = Box::into_raw(Box::new(thread));
        match unsafe { pthread_create(&mut 0, ptr::null(), start, thread) } {
            0 => Ok(()),
            error => Err(io::Error::from_raw_os_error(error)),
        }
"#;

const RAYON_NEW: &str = r#"        let mut builder = mem::ManuallyDrop::new(builder);
        let mut workers = Vec::new();
        let mut thread_infos = Vec::new();
        for _ in 0..n_threads {
            let worker = Worker::new_lifo();
            thread_infos.push(ThreadInfo::new(worker.stealer()));
            workers.push(worker);
        }
        let registry = Arc::new(Registry {
            thread_infos,
            sleep: Sleep::new(n_threads),
            injected_jobs: Injector::new(),
            broadcasts: Mutex::new(Vec::new()),
            terminate_count: AtomicUsize::new(1),
            panic_handler: None,
            start_handler: None,
            exit_handler: None,
        });
        for (index, worker) in workers.into_iter().enumerate() {
            let thread = ThreadBuilder {
                name: None,
                stack_size: None,
                registry: Arc::clone(&registry),
                worker,
                index,
            };
            if let Err(e) = builder.get_spawn_handler().spawn(thread) {
                return Err(ThreadPoolBuildError::new(ErrorKind::IOError(e)));
            }
        }
        Ok(registry)
    }

"#;

const RAYON_LOOP: &str = r#"    let worker_thread = Box::leak(Box::new(WorkerThread::from(thread)));
    WorkerThread::set_current(worker_thread);
    worker_thread.wait_until_out_of_work();
}

"#;

const RAYON_SEED: &str = r#"        static COUNTER: AtomicUsize = AtomicUsize::new(0);
        let seed = COUNTER.fetch_add(1, Ordering::Relaxed) as u64 + 1;
"#;

const RAYON_COUNT: &str = r#"            unsafe extern "C" {
                fn sched_getaffinity(process: i32, size: usize, set: *mut u64) -> i32;
            }
            // Room for as many processors as Linux can have.
            let mut set = [0u64; 128];
            unsafe { sched_getaffinity(0, 1024, set.as_mut_ptr()) };
            let count: u32 = set.iter().map(|word| word.count_ones()).sum();
            (count as usize).max(1)
"#;

const RAYON_SLEEP: &str = r#"
use std::sync::{Condvar, Mutex};
use std::thread;

pub(crate) const THREADS_MAX: usize = u16::MAX as usize;

/// Where those who have nothing to do sleep, and how many do.
pub(super) struct Sleep {
    asleep: Mutex<usize>,
    condvar: Condvar,
}

impl Sleep {
    pub(super) fn new(_: usize) -> Sleep {
        Sleep { asleep: Mutex::new(0), condvar: Condvar::new() }
    }

    /// Waits a little, and after some rounds until woken, unless there is something to do.
    pub(super) fn wait(&self, rounds: &mut u32, has_work: impl FnOnce() -> bool) {
        *rounds += 1;
        if *rounds < 32 {
            return thread::yield_now();
        }
        let mut asleep = self.asleep.lock().unwrap();
        if !has_work() {
            *asleep += 1;
            asleep = self.condvar.wait(asleep).unwrap();
            *asleep -= 1;
        }
    }

    /// Wakes all, after work or the end of a wait was made known. Who is about to sleep either sees that or
    /// is counted.
    #[inline(never)]
    pub(super) fn wake(&self) {
        let asleep = self.asleep.lock().unwrap();
        if *asleep != 0 {
            self.condvar.notify_all();
        }
    }
}
"#;

const RAYON_FOR_EVER: &str = r#"mod sleep;

mod for_ever {
    /// A reference to what is never freed, by the name of what counts its owners.
    pub(super) struct Arc<T: 'static>(&'static T);

    impl<T> Arc<T> {
        pub(super) fn new(value: T) -> Self {
            Arc(Box::leak(Box::new(value)))
        }
    }

    impl<T> Clone for Arc<T> {
        fn clone(&self) -> Self {
            Arc(self.0)
        }
    }

    impl<T> std::ops::Deref for Arc<T> {
        type Target = T;
        fn deref(&self) -> &T {
            self.0
        }
    }
}
"#;

const RAYON_SET: &str = r#"    registry().map(|registry| unsafe {
        ptr::addr_of_mut!(THE_REGISTRY).write(Some(registry));
        global_registry()
    })
}

"#;

const RAYON_WAIT: &str = r#"                    let has_work = || latch.probe() || self.has_injected_job();
                    self.registry.sleep.wait(&mut rounds, has_work);
                }
            }
            break;
        }

"#;
