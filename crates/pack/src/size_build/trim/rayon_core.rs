//! rayon-core: one pool, which never ends, of threads that the C library starts.
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
    )
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

const RAYON_NEW: &str = r#"        let mut workers = Vec::new();
        let mut thread_infos = Vec::new();
        for _ in 0..n_threads {
            let worker = Worker::new_lifo();
            thread_infos.push(ThreadInfo::new(worker.stealer()));
            workers.push(worker);
        }
        let registry = mem::ManuallyDrop::new(Arc::new(Registry {
            thread_infos,
            sleep: Sleep::new(n_threads),
            injected_jobs: Injector::new(),
            broadcasts: Mutex::new(Vec::new()),
            terminate_count: AtomicUsize::new(1),
            panic_handler: None,
            start_handler: None,
            exit_handler: None,
        }));
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
        Ok(mem::ManuallyDrop::into_inner(registry))
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
