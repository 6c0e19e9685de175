//! Times and numbers of steps in lines of a text.

/// Longest part of a line in which a time is looked for.
const LABELLED: usize = 1 << 8;

/// The time or number of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Label {
    pub(in super::super) time: Option<f64>,
    step: Option<f64>,
}

const TIMES: [&str; 7] =
    ["time", "t", "simtime", "simulationtime", "physicaltime", "solutiontime", "currenttime"];
const STEPS: [&str; 9] =
    ["step", "timestep", "frame", "snapshot", "iteration", "iter", "cycle", "nstep", "tstep"];
/// Words before `time` that make it another one.
const OTHERS: [&str; 9] =
    ["end", "final", "max", "total", "wall", "cpu", "run", "start", "computation"];

impl Label {
    /// The label in a line.
    pub(in super::super) fn of(line: &[u8]) -> Option<Self> {
        let line = line.get(..line.len().min(LABELLED)).unwrap_or(line);
        let text = String::from_utf8_lossy(line);
        let (mut time, mut step) = (None, None);
        let mut rest = text.as_ref();
        let mut before = "";
        while let Some(at) = rest.find(char::is_alphabetic) {
            let apart = !rest.get(..at)?.ends_with(|c: char| c.is_ascii_digit());
            rest = rest.get(at..)?;
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
            let word = rest.get(..end)?;
            if let Some((own, value)) = Self::at(rest).filter(|_| apart) {
                if own && !OTHERS.contains(&before.to_ascii_lowercase().as_str()) {
                    time = time.or(Some(value));
                } else if !own {
                    step = step.or(Some(value));
                }
            }
            before = word;
            rest = rest.get(end..)?;
        }
        (time.is_some() || step.is_some()).then_some(Self { time, step })
    }

    /// The label in a line of a table.
    pub(super) fn in_line(line: &[u8]) -> Option<Self> {
        Self::of(line).or_else(|| Self::alone(line))
    }

    /// The label that is all of a line.
    pub(in super::super) fn alone(line: &[u8]) -> Option<Self> {
        let end = line.iter().position(|b| !b.is_ascii_alphabetic()).unwrap_or(line.len());
        let word = line.get(..end)?;
        let mut known = TIMES.iter().chain(&STEPS);
        known.find(|name| word.eq_ignore_ascii_case(name.as_bytes()))?;
        let text = std::str::from_utf8(line).ok().filter(|_| line.len() < LABELLED)?;
        // In a table a separator may follow each word.
        let text = text.replace([',', ';', '\t', '|'], " ");
        let few = text.split_whitespace().count() < 5;
        Self::at(&text).filter(|_| few)?;
        Self::of(text.as_bytes())
    }

    /// Whether a text begins with a time (otherwise a step), and its value.
    fn at(text: &str) -> Option<(bool, f64)> {
        let end = text.find(|c: char| !(c.is_alphabetic() || c == '_')).unwrap_or(text.len());
        let (word, rest) = text.split_at_checked(end)?;
        let plain = word.replace('_', "").to_ascii_lowercase();
        let is_time = TIMES.contains(&plain.as_str());
        if !is_time && !STEPS.contains(&plain.as_str()) {
            return None;
        }
        let mut rest = rest.trim_start();
        let spaced = rest.len() < text.len() - end;
        // A unit, or what a number is.
        for (open, close) in [('[', ']'), ('(', ')')] {
            if let Some((_, behind)) = rest.strip_prefix(open).and_then(|r| r.split_once(close)) {
                rest = behind.trim_start();
            }
        }
        for word in ["number", "no.", "nr.", "#"] {
            rest = rest.strip_prefix(word).unwrap_or(rest).trim_start();
        }
        let value = rest.trim_start_matches(['=', ':']).trim_start();
        let equals = value.len() < rest.len() && rest.starts_with(['=', ':']);
        let joined = !is_time && value.starts_with(|c: char| c.is_ascii_digit());
        // A `t` may be anything.
        if !(equals || joined || (spaced && plain != "t")) {
            return None;
        }
        let value = value.trim_start_matches(['"', '\'']);
        let end = value.find(|c: char| c.is_whitespace() || ",;\"')]|".contains(c));
        let value = value.get(..end.unwrap_or(value.len()))?;
        // A unit may follow, but not the rest of a date.
        let unit = value.trim_end_matches(|c: char| c.is_alphabetic());
        let number = [value, unit].into_iter().find_map(|v| v.parse::<f64>().ok())?;
        let whole = number.fract() == 0.0 && number >= 0.0;
        (number.is_finite() && (is_time || whole)).then_some((is_time, number))
    }

    /// Whether both are of one step.
    pub(super) fn same(self, other: Option<Self>) -> bool {
        other.is_some_and(|other| match (self.time, other.time) {
            (Some(a), Some(b)) => a == b,
            _ => self.step == other.step && self.time == other.time,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_steps_are_labels() {
        let of = |line: &str| Label::of(line.as_bytes()).map(|label| (label.time, label.step));
        for (line, time) in [
            ("time = 0.1", 0.1),
            ("t=0.2", 0.2),
            ("T: 0.5", 0.5),
            ("Time 3", 3.0),
            ("time [s] = 0.25, 12 particles", 0.25),
            ("Simulation time: 1e-3 s", 1e-3),
            ("time=0.1s", 0.1),
            ("sim_time 2", 2.0),
        ] {
            assert_eq!(of(line), Some((Some(time), None)), "{line}");
        }
        for (line, step) in [
            ("step 3", 3.0),
            ("Timestep: 100", 100.0),
            ("time step 7", 7.0),
            ("frame_0003", 3.0),
            ("frame0012", 12.0),
            ("iteration no. 5", 5.0),
            ("snapshot #4", 4.0),
        ] {
            assert_eq!(of(line), Some((None, Some(step))), "{line}");
        }
        assert_eq!(of("step 3, t = 0.3"), Some((Some(0.3), Some(3.0))));
        for line in [
            "dt = 0.1",
            "time step = 0.001",
            "t 0.1",
            "end time = 5",
            "Time: 2024-05-01 12:00",
            "time 10:30:00",
            "walls",
            "x y z t",
            "steps",
            "",
        ] {
            assert_eq!(of(line), None, "{line}");
        }
    }
}
