//! How far it is: a bar on a terminal, else a line for each frame. On stderr.

use std::io::IsTerminal;
use std::time::Instant;

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

/// Of a run over many frames.
pub struct Progress {
    bar: Option<ProgressBar>,
    total: usize,
    done: usize,
    began: Instant,
}

impl Progress {
    pub fn new(total: usize) -> Self {
        let bar = (total > 1 && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new(total as u64);
            let template = "{bar:30} {pos}/{len} frames, {elapsed} gone, {eta} to go  {msg}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        });
        Self { bar, total, done: 0, began: Instant::now() }
    }

    /// A line that stays.
    pub fn say(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| eprintln!("whitewater: {line}")),
            None => eprintln!("whitewater: {line}"),
        }
    }

    /// One more frame is done, well or not; `line` is shown where there is no bar.
    pub fn advance(&mut self, line: &str) {
        self.done += 1;
        if let Some(bar) = &self.bar {
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
