//! Splits names of files and folders into numbers, with their units of time, and text.

use std::cmp::Ordering;

/// A number in a name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    /// Its value as an integer, if it has no sign, point or exponent.
    pub(super) whole: Option<u64>,
    /// Number of characters.
    width: usize,
    /// The integers before and after the decimal point, and the number of digits after it; `None` if the number
    /// has no point, or has a sign or an exponent.
    pub(super) pair: Option<(u64, u64, usize)>,
    /// Whether it has a point or an exponent.
    pub(super) decimal: bool,
    /// The unit right behind it.
    pub(super) unit: Option<Unit>,
}

/// A unit of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unit {
    Nanosecond,
    Microsecond,
    Millisecond,
    Second,
    Minute,
    Hour,
}

/// Units of time as names of files have them. `m` is a metre as often as a minute, so it is none of them. Microseconds
/// have the micro sign or the Greek letter.
const UNITS: [(&str, Unit); 9] = [
    ("ns", Unit::Nanosecond),
    ("us", Unit::Microsecond),
    ("\u{b5}s", Unit::Microsecond),
    ("\u{3bc}s", Unit::Microsecond),
    ("ms", Unit::Millisecond),
    ("sec", Unit::Second),
    ("s", Unit::Second),
    ("min", Unit::Minute),
    ("h", Unit::Hour),
];

impl Unit {
    /// The unit at the start of a text, and its length in bytes. It must end the word: `5h3` has none.
    fn parse(text: &str) -> Option<(Self, usize)> {
        let unit = UNITS.iter().find(|(name, _)| {
            let behind = text.strip_prefix(name);
            behind.is_some_and(|behind| !behind.starts_with(char::is_alphanumeric))
        });
        unit.map(|(name, unit)| (*unit, name.len()))
    }

    /// A time in this unit in seconds. Fractions of a second are divided by whole numbers, so that `900us` and
    /// `0.0009s` are rounded alike.
    fn seconds(self, value: f64) -> f64 {
        match self {
            Self::Nanosecond => value / 1.0e9,
            Self::Microsecond => value / 1.0e6,
            Self::Millisecond => value / 1.0e3,
            Self::Second => value,
            Self::Minute => value * 60.0,
            Self::Hour => value * 3600.0,
        }
    }
}

/// A time in seconds, from a number and the text behind it; `None` if that begins with no unit.
pub(super) fn seconds(number: u64, behind: &str) -> Option<f64> {
    Unit::parse(behind).map(|(unit, _)| unit.seconds(number as f64))
}

/// Length in bytes of the unit of time at the start of a text that follows a number in a file's name (`ms_fluid`);
/// `None` if there is none. The units are ns, us, µs, ms, s, sec, min and h. No letter or digit may follow a unit.
pub fn time_unit(text: &str) -> Option<usize> {
    Unit::parse(text).map(|(_, length)| length)
}

/// A part of a name: a number or the text between two numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    Text(String),
    Number(Number),
}

/// Words before a process rank; each process writes a part of each frame.
const RANKS: [&str; 9] =
    ["rank", "proc", "processor", "process", "piece", "mpi", "cpu", "subdomain", "thread"];

/// Whether `text` ends in a word such as `rank` or `proc`, so that a number after it is a process rank, as in
/// `fluid_10_rank0`. Each process writes a part of each frame.
pub fn is_rank(text: &str) -> bool {
    let text = text.trim_end_matches(['_', '-', '.', '=']);
    let word = text.rsplit(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or(text);
    RANKS.iter().any(|rank| word.eq_ignore_ascii_case(rank))
}

/// The name of a file without extension, and without a second one if the last is `gz` or `sc`.
pub(super) fn stem(name: &str) -> &str {
    let cut = |name: &str| {
        let (stem, extension) = name.rsplit_once('.')?;
        let letter = extension.starts_with(|c: char| c.is_ascii_alphabetic());
        (letter && !stem.is_empty()).then_some((stem.len(), matches!(extension, "gz" | "sc")))
    };
    let Some((end, packed)) = cut(name) else { return name };
    let stem = name.get(..end).unwrap_or(name);
    match cut(stem).filter(|_| packed) {
        Some((end, _)) => stem.get(..end).unwrap_or(stem),
        None => stem,
    }
}

/// Number of digits at the start.
fn digits(text: &str) -> usize {
    text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len())
}

/// Splits a name into numbers and text.
pub(super) fn parts(name: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut text = String::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let sign = first == '-' && !text.ends_with(|c: char| c.is_alphanumeric()) && {
            // The first minus of `step-1` is a separator, the second of `step--1` is a sign.
            !text.is_empty() || parts.is_empty()
        };
        let unsigned = rest.get(usize::from(sign)..).unwrap_or_default();
        let Some(mut number) = Number::parse(unsigned) else {
            text.push(first);
            rest = rest.get(first.len_utf8()..).unwrap_or_default();
            continue;
        };
        if sign {
            number = Number { value: -number.value, whole: None, pair: None, ..number };
        }
        rest = unsigned.get(number.width..).unwrap_or_default();
        if !text.is_empty() {
            parts.push(Part::Text(std::mem::take(&mut text)));
        }
        parts.push(Part::Number(number));
    }
    if !text.is_empty() {
        parts.push(Part::Text(text));
    }
    parts
}

impl Number {
    /// Parses the number at the start of a text. `00008.0000` is two numbers, and so is `1.2.3`.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let integer = digits(text);
        let whole = text.get(..integer)?;
        let plain: u64 = whole.parse().ok()?;
        let behind = |at: usize| text.get(at..).unwrap_or_default();
        let mut end = integer;
        let mut pair = None;
        let fraction = behind(integer).strip_prefix('.').map_or(0, digits);
        // With a unit, `000.50s` is a time.
        let timed = Unit::parse(behind(integer + 1 + fraction)).is_some();
        let padded = whole.len() > 1 && whole.starts_with('0') && !timed;
        let dotted =
            behind(integer + 1 + fraction).strip_prefix('.').is_some_and(|t| digits(t) > 0);
        if fraction > 0 && !padded && !dotted {
            end = integer + 1 + fraction;
            let digits = text.get(integer + 1..end)?;
            pair = digits.parse().ok().map(|behind| (plain, behind, fraction));
        }
        // `2e4` is part of a name; `2e+04` and `2.0e4` are numbers.
        if let Some(exponent) = behind(end).strip_prefix(['e', 'E']) {
            let signed = exponent.starts_with(['+', '-']);
            let count = exponent.get(usize::from(signed)..).map_or(0, digits);
            let last = end + 1 + usize::from(signed) + count;
            let ends = !behind(last).starts_with(char::is_alphanumeric);
            let ends = ends || Unit::parse(behind(last)).is_some();
            if count > 0 && ends && (signed || end > integer) {
                end = last;
                pair = None;
            }
        }
        let decimal = end > integer;
        let value = text.get(..end)?.parse().ok()?;
        let whole = Some(plain).filter(|_| !decimal);
        let unit = Unit::parse(behind(end)).map(|(unit, _)| unit);
        Some(Self { value, whole, width: end, pair, decimal, unit })
    }

    /// The value, in seconds if it has a unit.
    pub(super) fn scaled(&self) -> f64 {
        self.unit.map_or(self.value, |unit| unit.seconds(self.value))
    }

    /// The time in seconds; `None` without a unit. Nothing is 0 in all units.
    pub(super) fn seconds(&self) -> Option<f64> {
        (self.unit.is_some() || self.value == 0.0).then(|| self.scaled())
    }

    fn cmp(&self, other: &Self) -> Ordering {
        // Integers beyond 2^53 may be equal as floats.
        let order = self.scaled().total_cmp(&other.scaled());
        order.then(self.whole.cmp(&other.whole)).then(self.width.cmp(&other.width))
    }
}

pub(super) fn compare(a: &[Part], b: &[Part]) -> Ordering {
    for (a, b) in a.iter().zip(b) {
        let order = match (a, b) {
            (Part::Text(a), Part::Text(b)) => a.cmp(b),
            (Part::Number(a), Part::Number(b)) => a.cmp(b),
            (Part::Number(_), Part::Text(_)) => Ordering::Less,
            (Part::Text(_), Part::Number(_)) => Ordering::Greater,
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    a.len().cmp(&b.len())
}
