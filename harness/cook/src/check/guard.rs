//! Processes a user's file in a separate thread with a large stack for deeply nested texts, while
//! its time and memory are monitored: a compiler may request more than the machine has.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, Once, PoisonError};
use std::time::{Duration, Instant};

/// Stack size in bytes: naga needs some kilobytes for each operator that a text may chain.
const STACK_BYTES: usize = 512 << 20;
/// Memory limit in bytes; checks of the cookbook's own functions need less than a tenth of it.
const MOST_BYTES: u64 = 2 << 30;
/// Time limit for reading and compiling. Drivers compile at the first run, which has that time besides its own.
const MOST_COMPILING: Duration = Duration::from_secs(120);
/// Time limit of each case of a run: a thousand times what the cookbook's functions take.
const MOST_OF_A_CASE: Duration = Duration::from_millis(2);
/// Interval between two checks of memory and time.
const LOOK: Duration = Duration::from_millis(10);
/// Name of the thread, by which its panics are recognised.
const THREAD: &str = "a user's file";

/// What the thread is currently doing, since when and for how long at most.
#[derive(Clone, Debug)]
pub struct Stage(Arc<Mutex<(String, Instant, Duration)>>);

impl Stage {
    fn new(what: &str) -> Self {
        Self(Arc::new(Mutex::new((what.to_owned(), Instant::now(), MOST_COMPILING))))
    }

    /// Starts a compilation step.
    pub fn compiling(&self, what: &str) {
        self.set(what, MOST_COMPILING);
    }

    /// Starts a run of so many cases.
    pub fn running(&self, what: &str, cases: u64) {
        self.set(what, MOST_COMPILING + MOST_OF_A_CASE.mul_f64(cases as f64));
    }

    fn set(&self, what: &str, most: Duration) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = (what.to_owned(), Instant::now(), most);
    }

    fn get(&self) -> (String, Instant, Duration) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Why the work was aborted; each message is a single line.
#[derive(Debug, thiserror::Error)]
pub enum GuardError {
    /// The memory limit was exceeded.
    #[error("{0} takes over {most} MiB of memory; make its arrays smaller", most = MOST_BYTES >> 20)]
    Memory(String),
    /// The time limit was exceeded.
    #[error("{0} takes over {most} s; make it simpler", most = .1.as_secs())]
    Time(String, Duration),
    /// The compiler or this program panicked.
    #[error("{stage} breaks the compiler ({reason}); change the lines that it cannot take")]
    Panic {
        /// The stage at which it panicked.
        stage: String,
        /// The panic's message.
        reason: String,
    },
    /// The system could not create a thread.
    #[error("no thread with a stack of {size} MiB: {0}", size = STACK_BYTES >> 20)]
    Thread(std::io::Error),
}

/// Runs `work` in a separate thread. If a limit is exceeded, the error is returned immediately; the
/// thread only ends with the process, which should then exit.
pub fn watched<T: Send + 'static>(work: impl FnOnce(&Stage) -> T + Send + 'static) -> Result<T, GuardError> {
    watched_within(MOST_BYTES, work)
}

fn watched_within<T: Send + 'static>(
    most_bytes: u64,
    work: impl FnOnce(&Stage) -> T + Send + 'static,
) -> Result<T, GuardError> {
    silence_panics();
    let stage = Stage::new("reading the file");
    let before = resident_bytes();
    let (sender, receiver) = channel();
    let its_stage = stage.clone();
    let thread = std::thread::Builder::new()
        .name(THREAD.to_owned())
        .stack_size(STACK_BYTES)
        // If nobody is waiting any more, the process is about to end.
        .spawn(move || sender.send(work(&its_stage)).unwrap_or_default())
        .map_err(GuardError::Thread)?;
    loop {
        match receiver.recv_timeout(LOOK) {
            Ok(done) => return Ok(done),
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {}
        }
        let (what, since, most) = stage.get();
        if resident_bytes().saturating_sub(before) > most_bytes {
            return Err(GuardError::Memory(what));
        }
        if since.elapsed() > most {
            return Err(GuardError::Time(what, most));
        }
    }
    let reason = match thread.join() {
        Err(panic) => match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
            (Some(text), _) => (*text).to_owned(),
            (_, Some(text)) => text.clone(),
            _ => String::new(),
        },
        Ok(()) => String::new(),
    };
    let reason = reason.lines().next().unwrap_or_default().to_owned();
    Err(GuardError::Panic { stage: stage.get().0, reason })
}

/// Returns the process's resident memory in bytes; 0 if the system does not report it.
fn resident_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kibibytes =
        status.lines().find_map(|line| line.strip_prefix("VmRSS:")?.trim().strip_suffix(" kB")?.parse().ok());
    kibibytes.map_or(0, |kibibytes: u64| kibibytes << 10)
}

/// Suppresses the message of a panic in the thread, because it becomes an error.
fn silence_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if std::thread::current().name() != Some(THREAD) {
                usual(panic);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_done_and_what_breaks_is_said() {
        assert_eq!(watched(|_| 7).expect("done"), 7);
        let error: Result<(), GuardError> = watched(|stage| {
            stage.compiling("compiling `f`");
            panic!("no such type\nat all")
        });
        let error = error.expect_err("a panic").to_string();
        assert_eq!(error, "compiling `f` breaks the compiler (no such type); change the lines that it cannot take");
        // Needs far more stack than a thread usually has.
        fn deep(depth: u64) -> u64 {
            let frame = std::hint::black_box([depth; 64]);
            if depth == 0 { frame[0] } else { deep(depth - 1) + frame[63] - depth + 1 }
        }
        assert_eq!(watched(|_| deep(100_000)).expect("done"), 100_000);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn memory_is_bounded() {
        let error = watched_within(128 << 20, |_| {
            let mut kept = Vec::new();
            while kept.len() < 64 {
                kept.push(std::hint::black_box(vec![1u8; 8 << 20]));
                std::thread::sleep(Duration::from_millis(15));
            }
            kept.len()
        });
        assert!(matches!(error, Err(GuardError::Memory(_))), "{error:?}");
    }
}
