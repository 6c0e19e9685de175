//! Aborts the run if a test hangs. A shader that never ends would block the driver, and with it all
//! other tests.

use std::cell::RefCell;
use std::io::Write;
use std::sync::{Arc, Mutex, Once, PoisonError, Weak};
use std::thread;
use std::time::{Duration, Instant};

static WATCHED: Mutex<Vec<Weak<Watch>>> = Mutex::new(Vec::new());

thread_local! {
    static OWN: RefCell<Weak<Watch>> = const { RefCell::new(Weak::new()) };
}

/// A test holds this object while it is watched.
pub struct Watch {
    test: String,
    begun: Instant,
    waits: Mutex<Option<Instant>>,
}

impl Watch {
    /// Watches the test on this thread.
    pub fn begin() -> Arc<Self> {
        let test = thread::current().name().unwrap_or("a test").to_owned();
        let watch = Arc::new(Self { test, begun: Instant::now(), waits: Mutex::new(None) });
        let mut all = WATCHED.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|watch| watch.strong_count() > 0);
        all.push(Arc::downgrade(&watch));
        OWN.set(Arc::downgrade(&watch));
        static STARTED: Once = Once::new();
        STARTED.call_once(|| drop(thread::spawn(look)));
        watch
    }

    fn waits(&self, since: Option<Instant>) {
        *self.waits.lock().unwrap_or_else(PoisonError::into_inner) = since;
    }
}

/// Waits for the GPU. The watchdog measures the time of the wait.
pub fn waiting<T>(wait: impl FnOnce() -> T) -> T {
    let own = OWN.with_borrow(Weak::upgrade);
    if let Some(watch) = &own {
        watch.waits(Some(Instant::now()));
    }
    let result = wait();
    if let Some(watch) = &own {
        watch.waits(None);
    }
    result
}

/// Aborts the process if a test hangs; no other way frees a thread that waits in the driver.
fn look() {
    let seconds = std::env::var("WHITEWATER_WATCHDOG").ok().and_then(|s| s.parse().ok());
    let most = Duration::from_secs(seconds.unwrap_or(60));
    loop {
        thread::sleep(Duration::from_millis(250));
        let all: Vec<_> = {
            let all = WATCHED.lock().unwrap_or_else(PoisonError::into_inner);
            all.iter().filter_map(Weak::upgrade).collect()
        };
        for watch in all {
            let waits = *watch.waits.lock().unwrap_or_else(PoisonError::into_inner);
            // Waits inside the library are not visible here, so the duration of the whole test is
            // limited too.
            let hangs = waits.is_some_and(|since| since.elapsed() > most)
                || watch.begun.elapsed() > 10 * most;
            if hangs {
                // Writes to stderr directly, because the test harness captures the output of
                // `eprintln!`.
                let _ = writeln!(
                    std::io::stderr().lock(),
                    "\nwatchdog: {} waits for the GPU for more than {} s: a shader that does not end? \
                     WHITEWATER_WATCHDOG=SECONDS waits longer",
                    watch.test,
                    most.as_secs()
                );
                std::process::abort();
            }
        }
    }
}
