//! Progress on stderr: a bar on a terminal (a spinner for one frame), otherwise a line per frame and per long
//! step.

use std::fmt::Display;
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::out;

/// Time after which a step that still runs is first reported on stderr, if there is no bar. It is reported again when
/// it has run ten times as long, and then each time that its running time has doubled.
const PATIENCE: Duration = Duration::from_secs(3);

/// The current step.
struct Step {
    name: String,
    began: Instant,
    /// Time of its next report.
    due: Duration,
}

impl Step {
    /// The report that is due after this time.
    fn told(&mut self, gone: Duration) -> Option<String> {
        (gone >= self.due).then(|| {
            self.due = (2 * self.due).max(10 * PATIENCE);
            format!("{}, {} s so far", self.name, gone.as_secs())
        })
    }
}

/// Progress over a number of frames or other items.
pub struct Progress {
    bar: Option<ProgressBar>,
    step: Arc<Mutex<Option<Step>>>,
    total: usize,
    done: usize,
    began: Instant,
}

/// Reports steps.
#[derive(Clone)]
pub struct Steps {
    bar: Option<ProgressBar>,
    step: Arc<Mutex<Option<Step>>>,
}

fn lock(step: &Mutex<Option<Step>>) -> MutexGuard<'_, Option<Step>> {
    step.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Progress {
    /// `things` names the items, such as frames.
    pub fn new(total: usize, things: &str) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let (bar, template) = match total {
                1 => (ProgressBar::new_spinner(), "{spinner} {msg}, {elapsed} gone".to_string()),
                _ => {
                    let bar = ProgressBar::new(total as u64);
                    let gone = "{elapsed} gone, {eta} to go  {msg}";
                    (bar, format!("{{bar:30}} {{pos}}/{{len}} {things}, {gone}"))
                }
            };
            if let Ok(style) = ProgressStyle::with_template(&template) {
                bar.set_style(style);
            }
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        let step = Arc::new(Mutex::new(None));
        if bar.is_none() {
            let watched = Arc::downgrade(&step);
            std::thread::spawn(move || watch(&watched));
        }
        Self { bar, step, total, done: 0, began: Instant::now() }
    }

    /// A handle for code that runs steps.
    pub fn steps(&self) -> Steps {
        Steps { bar: self.bar.clone(), step: Arc::clone(&self.step) }
    }

    /// Prints a line that stays.
    pub fn say(&self, line: &str) {
        self.aside(|| out::note(format_args!("{line}")));
    }

    /// Runs `write`, which prints to the terminal, without the bar in its way.
    pub fn aside<T>(&self, write: impl FnOnce() -> T) -> T {
        match &self.bar {
            Some(bar) => bar.suspend(write),
            None => write(),
        }
    }

    /// Counts one more item, successful or not. `line` is shown beside the bar; it is printed if there is no bar or
    /// only one item.
    pub fn advance(&mut self, line: &str) {
        self.done += 1;
        if let Some(bar) = &self.bar
            && self.total > 1
        {
            bar.set_message(line.to_string());
            bar.inc(1);
            return;
        }
        let left = self.total.saturating_sub(self.done);
        let eta = self.began.elapsed() * left as u32 / self.done as u32;
        match (self.total, left) {
            (1, _) => self.say(line),
            (total, 0) => self.say(&format!("{line} ({} of {total})", self.done)),
            (total, _) => {
                self.say(&format!(
                    "{line} ({} of {total}, {} to go)",
                    self.done,
                    HumanDuration(eta)
                ));
            }
        }
    }

    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Steps {
    /// Prints a line that stays.
    pub fn say(&self, line: &str) {
        let note = || out::note(format_args!("{line}"));
        match &self.bar {
            Some(bar) => bar.suspend(note),
            None => note(),
        }
    }

    /// Runs a step, and reports it if it takes long.
    pub fn during<T>(&self, name: impl Display, work: impl FnOnce() -> T) -> T {
        if let Some(bar) = &self.bar {
            bar.set_message(name.to_string());
        }
        let now = Step { name: name.to_string(), began: Instant::now(), due: PATIENCE };
        let outer = lock(&self.step).replace(now);
        let result = work();
        *lock(&self.step) = outer;
        result
    }
}

/// Reports long steps until all handles are dropped.
fn watch(step: &Weak<Mutex<Option<Step>>>) {
    while let Some(step) = step.upgrade() {
        if let Some(step) = lock(&step).as_mut()
            && let Some(line) = step.told(step.began.elapsed())
        {
            out::note(format_args!("{line}"));
        }
        drop(step);
        std::thread::sleep(PATIENCE / 6);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_that_last_are_told_of() {
        let mut step = Step { name: "draw".into(), began: Instant::now(), due: PATIENCE };
        let told: Vec<u64> =
            (0..200).filter(|s| step.told(Duration::from_secs(*s)).is_some()).collect();
        assert_eq!(told, [3, 30, 60, 120]);
        assert_eq!(step.told(Duration::from_secs(300)).as_deref(), Some("draw, 300 s so far"));
    }

    #[test]
    fn a_step_within_a_step_gives_it_back() {
        let progress = Progress::new(1, "frames");
        let steps = progress.steps();
        let name = || lock(&steps.step).as_ref().map(|step| step.name.clone());
        steps.during("outer", || {
            assert_eq!(steps.during("inner", name).as_deref(), Some("inner"));
            assert_eq!(name().as_deref(), Some("outer"));
        });
        assert_eq!(name(), None);
    }
}
