//! Finds the numbers and times of the frames.

use std::cmp::Ordering;
use std::path::PathBuf;

use super::names::{Number, Part, compare, is_rank, parts, stem};
use super::{Frame, SequenceError};

/// A file. `levels` holds the name of the file without extension, the name of its folder, of the folder above,
/// and so on, each split into numbers and text.
pub(super) struct Named {
    levels: Vec<Vec<Part>>,
    /// The frame's number and time, if a list of files or a `%d` in the input determines them; `None` if only the
    /// name can tell.
    pub(super) said: Option<(u64, Option<f64>)>,
    /// Whether they come from a list of files.
    pub(super) listed: bool,
    pub(super) path: PathBuf,
}

/// Files of a list, numbered from 0 in the order of their times.
pub(super) fn listed_frames(mut files: Vec<(PathBuf, Option<f64>)>) -> Vec<Named> {
    let timed = files.iter().all(|(_, time)| time.is_some());
    if timed {
        files.sort_by(|a, b| a.1.unwrap_or_default().total_cmp(&b.1.unwrap_or_default()));
    }
    let mut frames: Vec<Named> = Vec::new();
    for (path, time) in files {
        let last = frames.last().and_then(|frame| frame.said);
        let number = match last {
            Some((number, before)) if timed && before == time => number,
            Some((number, _)) => number + 1,
            None => 0,
        };
        let named = Named::new(path, Some((number, time)));
        frames.push(Named { listed: true, ..named });
    }
    frames
}

impl Named {
    pub(super) fn new(path: PathBuf, said: Option<(u64, Option<f64>)>) -> Self {
        let mut names =
            path.components().rev().map(|c| c.as_os_str().to_string_lossy().into_owned());
        let mut levels = vec![parts(stem(&names.next().unwrap_or_default()))];
        levels.extend(names.map(|name| parts(&name)));
        Self { levels, said, listed: false, path }
    }

    pub(super) fn cmp(&self, other: &Self) -> Ordering {
        let all = |named: &Self| named.levels.len();
        let folders = self.levels.iter().skip(1).rev().zip(other.levels.iter().skip(1).rev());
        let mut order = all(self).cmp(&all(other));
        order = folders.fold(order, |order, (a, b)| order.then_with(|| compare(a, b)));
        match (self.levels.first(), other.levels.first()) {
            (Some(a), Some(b)) => order.then_with(|| compare(a, b)),
            _ => order,
        }
    }

    /// The numbers in one name of the path (`level` 0 is the file, 1 its folder), without process ranks, and whether
    /// the name has a process rank.
    fn numbers(&self, level: usize) -> (Vec<&Number>, bool) {
        let (mut numbers, mut ranked, mut before) = (Vec::new(), false, "");
        for part in self.levels.get(level).into_iter().flatten() {
            match part {
                Part::Number(number) if !is_rank(before) => numbers.push(number),
                Part::Number(_) => ranked = true,
                Part::Text(text) => before = text,
            }
        }
        (numbers, ranked)
    }
}

/// The number in each file's name that distinguishes it from the others. `None` if a name has no number, or if it is
/// unclear which of its numbers counts the frames.
fn telling(named: &[Named]) -> Option<Vec<Number>> {
    let depth = named.iter().map(|named| named.levels.len()).min().unwrap_or(0);
    for level in 0..depth {
        let ranked = named.iter().any(|named| named.numbers(level).1);
        let numbers: Vec<_> = named.iter().map(|named| named.numbers(level).0).collect();
        let runs = numbers.first().map_or(0, Vec::len);
        let same = numbers.iter().all(|n| n.len() == runs);
        let first = |run: usize| numbers.first().and_then(|first| first.get(run).copied());
        let differs = |run: &usize| numbers.iter().any(|n| n.get(*run).copied() != first(*run));
        // The last number that differs between files. `None` if the names do not have equally many numbers;
        // then the last number of each name counts.
        let run = (0..runs).rev().find(differs).filter(|_| same);
        // A hash or the seconds of an hour may follow the frame's number. Then the files, which are sorted by
        // all numbers in their names, are not in the order of the last one.
        let values = |run: usize| numbers.iter().map(move |n| n.get(run).map(|n| n.scaled()));
        let sorted = |run: usize| values(run).is_sorted();
        let single = |run: usize| {
            let mut bits: Vec<_> = values(run).map(|v| v.map(f64::to_bits)).collect();
            bits.sort_unstable();
            bits.windows(2).all(|pair| pair.first() != pair.last())
        };
        let run = match run {
            Some(last) if !sorted(last) && single(last) => {
                let first = (0..last).find(differs);
                Some(first.filter(|first| sorted(*first) && single(*first))?)
            }
            run => run,
        };
        let own = |n: &Vec<&Number>| match run {
            Some(run) => n.get(run).copied().cloned(),
            None => n.last().copied().cloned(),
        };
        let alike = same && run.is_none();
        if !alike || (level == 0 && named.len() == 1 && runs > 0) {
            return numbers.iter().map(own).collect();
        }
        // Files with the same name in many folders.
        let names = named.iter().map(|named| named.levels.get(level));
        let text = |parts: Option<&Vec<Part>>| parts.cloned();
        let other = names.clone().any(|n| text(n) != text(names.clone().next().flatten()));
        if other {
            if runs == 0 && ranked {
                // Parts of one frame.
                return Some(vec![Number::parse("0")?; named.len()]);
            }
            return if runs > 0 { numbers.iter().map(own).collect() } else { None };
        }
    }
    None
}

/// Assigns numbers to files; files without a number are counted in their order.
///
/// # Errors
/// Some numbers have units of time, which differ, and others have none.
pub(super) fn number(mut named: Vec<Named>) -> Result<Vec<Frame>, SequenceError> {
    if named.iter().all(|named| named.said.is_some()) {
        let frame = |named: Named| {
            let (number, time) = named.said.unwrap_or_default();
            let in_seconds = time.is_some() && !named.listed;
            Frame { in_seconds, ..Frame::new(number, time, named.path) }
        };
        return Ok(named.into_iter().map(frame).collect());
    }
    let Some(numbers) = telling(&named) else {
        let frame = |(i, named): (usize, Named)| Frame::new(i as u64, None, named.path);
        return Ok(named.into_iter().enumerate().map(frame).collect());
    };
    let units: Vec<_> = numbers.iter().filter_map(|number| number.unit).collect();
    let differ = units.windows(2).any(|two| two.first() != two.last());
    // In seconds, if all numbers have a unit.
    let times: Option<Vec<f64>> = numbers.iter().map(Number::seconds).collect();
    let times = times.filter(|_| !units.is_empty());
    let seconds = |i: usize| times.as_ref().and_then(|times| times.get(i)).copied();
    let whole: Option<Vec<u64>> = numbers.iter().map(|number| number.whole).collect();
    let without = numbers.iter().position(|number| number.seconds().is_none());
    if let Some(file) = without.filter(|_| differ).and_then(|i| named.get(i)) {
        return Err(SequenceError::Pattern {
            pattern: file.path.display().to_string(),
            expected: "a unit of time behind the number (ns, us, ms, s, min or h), as other files of the pattern have; \
                       rename it, or narrow the pattern"
                .into(),
        });
    }
    if let Some(whole) = whole.filter(|_| !differ) {
        let frame = |(i, (named, number)): (usize, (Named, u64))| {
            let frame = Frame::new(number, seconds(i), named.path);
            Frame { in_seconds: times.is_some(), ..frame }
        };
        return Ok(named.into_iter().zip(whole).enumerate().map(frame).collect());
    }
    // Programs write times either with a fixed number of decimals or without zeros at the end. In names that do
    // neither, `1.10` is therefore the pair of integers 1 and 10, which follows `1.9`.
    let pairs: Option<Vec<_>> = numbers.iter().map(|number| number.pair).collect();
    let widths = |pairs: &[(u64, u64, usize)]| {
        let first = pairs.first().map_or(0, |pair| pair.2);
        let zero = pairs.iter().any(|(_, behind, _)| behind.is_multiple_of(10) && *behind > 0);
        pairs.iter().any(|pair| pair.2 != first) && zero
    };
    let pairs = pairs.filter(|pairs| widths(pairs) && times.is_none());
    let decimal = numbers.iter().any(|number| number.decimal) && pairs.is_none();
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    let key = |i: usize| -> (Option<(u64, u64)>, f64) {
        let pair = pairs.as_ref().and_then(|pairs| pairs.get(i)).map(|pair| (pair.0, pair.1));
        (pair, seconds(i).unwrap_or_else(|| numbers.get(i).map_or(0.0, |number| number.value)))
    };
    let by = |a: &usize, b: &usize| {
        let (a, b) = (key(*a), key(*b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    };
    order.sort_by(by);
    let mut frames = Vec::new();
    let mut last: Option<(usize, u64)> = None;
    for i in order {
        // Files with the same time have the same number.
        let number = match last {
            Some((before, number)) if by(&before, &i) == Ordering::Equal => number,
            Some((_, number)) => number + 1,
            None => 0,
        };
        last = Some((i, number));
        let own = || numbers.get(i).map(|number| number.value).filter(|_| decimal);
        let time = seconds(i).or_else(own);
        if let Some(named) = named.get_mut(i) {
            let frame = Frame::new(number, time, std::mem::take(&mut named.path));
            frames.push(Frame { in_seconds: times.is_some(), ..frame });
        }
    }
    Ok(frames)
}
