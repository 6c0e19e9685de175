//! Writes timings: CSV, JSON, and a trace for Perfetto and chrome://tracing.

use std::io::Write;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde_json::json;
use whitewater::Timing;

use crate::failure::{Failure, Outcome};
use crate::output;
use crate::progress::Steps;

/// A step of this program; times in microseconds since the start.
struct Step {
    name: &'static str,
    frame: u64,
    start: f64,
    length: f64,
}

/// All measurements.
struct Record {
    began: Instant,
    adapter: String,
    driver: String,
    steps: Vec<Step>,
    /// For each frame: its number, the start of the step of this program that submitted it (microseconds since the
    /// measurements began), and its passes on the GPU.
    frames: Vec<(u64, f64, Vec<Timing>)>,
}

/// A shared handle of the measurements. All clones write to one record, so the Ctrl-C handler, which has a clone, can
/// save the measurements before the program ends.
#[derive(Clone)]
pub struct Times {
    record: Arc<Mutex<Record>>,
    steps: Steps,
}

impl Times {
    /// `steps` also shows the steps as progress.
    pub fn new(steps: Steps, adapter: &str, driver: &str) -> Self {
        let record = Record {
            began: Instant::now(),
            adapter: adapter.into(),
            driver: driver.into(),
            steps: Vec::new(),
            frames: Vec::new(),
        };
        Self { record: Arc::new(Mutex::new(record)), steps }
    }

    fn record(&self) -> MutexGuard<'_, Record> {
        self.record.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Prints a line that stays.
    pub fn say(&self, line: &str) {
        self.steps.say(line);
    }

    /// Runs a step and records its duration.
    pub fn step<T>(&self, name: &'static str, frame: u64, work: impl FnOnce() -> T) -> T {
        let start = self.now();
        let result = self.steps.during(format_args!("frame {frame}: {name}"), work);
        let length = self.now() - start;
        self.record().steps.push(Step { name, frame, start, length });
        result
    }

    /// Microseconds since the start.
    fn now(&self) -> f64 {
        self.record().began.elapsed().as_secs_f64() * 1.0e6
    }

    /// Records the measured GPU passes of a frame or of a simulation step. Their common start is taken as that of the
    /// step of this program that was recorded last.
    pub fn passes(&self, frame: u64, passes: Vec<Timing>) {
        if passes.is_empty() {
            return;
        }
        let mut record = self.record();
        let start = record.steps.last().map_or(0.0, |s| s.start);
        record.frames.push((frame, start, passes));
    }

    /// Fails early if the extension of a timings file is unknown.
    pub fn check(path: &Path, trace: bool) -> Outcome<()> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("json") => Ok(()),
            Some("csv") if !trace => Ok(()),
            _ => Err(Failure::usage(format!(
                "expected a file that ends in {}, found {}; rename it",
                if trace { ".json" } else { ".csv or .json" },
                path.display()
            ))),
        }
    }

    /// Writes frame, pass, start and length in nanoseconds.
    pub fn write(&self, path: &Path) -> Outcome<()> {
        let Record { adapter, driver, frames, .. } = &*self.record();
        let csv = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"));
        output::write(path, |to| {
            if csv {
                writeln!(to, "frame,pass,start,nanoseconds")?;
                for (frame, _, passes) in frames {
                    for p in passes {
                        writeln!(to, "{frame},{},{:.0},{:.0}", p.name, p.start, p.nanoseconds)?;
                    }
                }
                return Ok(());
            }
            let frames: Vec<_> = frames
                .iter()
                .map(|(frame, _, passes)| {
                    let passes: Vec<_> = passes
                        .iter()
                        .map(|p| json!({"pass": p.name, "start": p.start, "nanoseconds": p.nanoseconds}))
                        .collect();
                    json!({"frame": frame, "passes": passes})
                })
                .collect();
            let all = json!({"adapter": adapter, "driver": driver, "frames": frames});
            serde_json::to_writer_pretty(&mut *to, &all)?;
            writeln!(to)
        })
    }

    /// Writes all measurements as Chrome trace events: steps of this program, and passes on the device. The two
    /// clocks are not synchronised; the first pass of a frame is placed at the start of its submission.
    pub fn write_trace(&self, path: &Path) -> Outcome<()> {
        let Record { adapter, steps, frames, .. } = &*self.record();
        let thread = |tid: u32, name: &str| json!({"ph": "M", "name": "thread_name", "pid": 1, "tid": tid, "args": {"name": name}});
        let mut events = vec![thread(1, "whitewater"), thread(2, adapter)];
        for s in steps {
            events.push(json!({"ph": "X", "pid": 1, "tid": 1, "name": s.name, "ts": s.start,
                "dur": s.length, "args": {"frame": s.frame}}));
        }
        for (frame, start, passes) in frames {
            for p in passes {
                events.push(json!({"ph": "X", "pid": 1, "tid": 2, "name": p.name,
                    "ts": start + p.start * 1.0e-3, "dur": p.nanoseconds * 1.0e-3,
                    "args": {"frame": frame}}));
            }
        }
        output::write(path, |to| {
            serde_json::to_writer(&mut *to, &json!({"traceEvents": events}))?;
            writeln!(to)
        })
    }
}
