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
    /// When the first item was finished: it takes longer than the others, because pipelines are created for it.
    first: Option<Instant>,
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
        Self { bar, step, total, done: 0, first: None }
    }

    /// A handle for code that runs steps.
    pub fn steps(&self) -> Steps {
        Steps { bar: self.bar.clone(), step: Arc::clone(&self.step) }
    }

    /// Prints a line that stays.
    pub fn say(&self, line: &str) {
        self.aside(|| out::note(format_args!("{line}")));
    }

    /// Says that this many frames are not drawn, because they are finished. They do not count as items.
    pub fn skipped(&self, count: usize) {
        match count {
            0 => {}
            1 => self.say("1 finished frame is skipped (--overwrite draws it again)"),
            _ => self.say(&format!(
                "{count} finished frames are skipped (--overwrite draws them again)"
            )),
        }
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
        let (total, done) = (self.total, self.done);
        let first = *self.first.get_or_insert_with(Instant::now);
        let left = time_left(first.elapsed(), done, total)
            .map(|left| format!(", {} to go", HumanDuration(left)));
        match total {
            1 => self.say(line),
            _ => self.say(&format!("{line} ({done} of {total}{})", left.unwrap_or_default())),
        }
    }

    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Time that the remaining items will take, from the time since the first was finished; `None` if there is no other
/// one yet, or none is left.
fn time_left(since_first: Duration, done: usize, total: usize) -> Option<Duration> {
    let (timed, left) = (done.checked_sub(1)? as u32, total.saturating_sub(done) as u32);
    (timed > 0 && left > 0).then(|| since_first * left / timed)
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
    fn the_first_item_does_not_count_for_the_time_left() {
        let seconds = Duration::from_secs;
        assert_eq!(time_left(seconds(0), 1, 10), None);
        assert_eq!(time_left(seconds(3), 2, 10), Some(seconds(24)));
        assert_eq!(time_left(seconds(6), 3, 10), Some(seconds(21)));
        assert_eq!(time_left(seconds(27), 10, 10), None);
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
