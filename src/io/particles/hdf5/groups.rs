//! Decides which groups of an HDF5 file are frames, by their names and times.
//!
//! The word before the number in a group's name says what the number counts. `step_0010`, `t=0.5` and `0010` are
//! frames. `rank_3` is a piece of a frame. `body1` is neither.

/// What the groups with positions are.
#[derive(Debug, PartialEq)]
pub(super) enum Order {
    /// The frame of each group, from 0; `None` for a group beside the frames.
    Frames(Vec<Option<usize>>),
    /// All groups belong to the same frames.
    Together,
    /// The names differ in a number that may count anything.
    Unsure,
}

/// Words before the number of a frame: ends of words, and whole words.
const FRAMES: [&[&str]; 2] = [
    &["step", "frame", "time", "iter", "iteration", "cycle", "snapshot", "output", "dump"],
    &[
        "t", "ts", "it", "f", "snap", "out", "plt", "plot", "state", "tick", "data", "result",
        "save",
    ],
];
/// Words before the number of a piece. `part` is none: DualSPHysics calls its frames so.
const PIECES: [&[&str]; 2] = [
    &["rank", "piece", "domain", "chunk", "processor", "process", "partition"],
    &["proc", "cpu", "mpi", "task", "block"],
];
/// Words before the number of one of several liquids.
const FLUIDS: [&[&str]; 2] = [&["fluid", "water", "liquid"], &[]];

/// A number in a path, and the word before it.
struct Number<'a> {
    word: &'a str,
    value: f64,
}

impl Number<'_> {
    fn counts(&self, [ends, whole]: [&[&str]; 2]) -> bool {
        let lower = self.word.to_lowercase();
        // `dataT1`: the last word begins with a capital.
        let capital = self.word.rfind(|c: char| c.is_uppercase()).unwrap_or(0);
        let last = self.word.get(capital..).unwrap_or_default().to_lowercase();
        ends.iter().any(|end| lower.ends_with(end))
            || [lower, last].iter().any(|word| whole.contains(&word.as_str()))
    }
}

/// The numbers in a path, and the path without them.
fn split(path: &str) -> (Vec<Number<'_>>, String) {
    let (mut numbers, mut text, mut rest) = (Vec::new(), String::new(), path);
    while let Some((before, number)) =
        rest.find(|c: char| c.is_ascii_digit()).and_then(|at| rest.split_at_checked(at))
    {
        let Some((number, behind)) = number.split_at_checked(length(number)) else { break };
        let name = before.rsplit('/').next().unwrap_or(before);
        let word = name.trim_end_matches(|c: char| !c.is_alphabetic());
        let start = word.char_indices().rev().take_while(|(_, c)| c.is_alphabetic()).last();
        // A minus behind a name separates: `step-5`.
        let minus =
            name.strip_suffix('-').is_some_and(|name| !name.ends_with(char::is_alphanumeric));
        let value: f64 = number.parse().unwrap_or(0.0);
        numbers.push(Number {
            word: start.and_then(|(at, _)| word.get(at..)).unwrap_or_default(),
            value: if minus { -value } else { value },
        });
        text.push_str(before);
        text.push('0');
        rest = behind;
    }
    text.push_str(rest);
    (numbers, text)
}

/// Length of the number that a text begins with.
fn length(text: &str) -> usize {
    let digits =
        |text: &str| text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let behind = |at: usize| text.get(at..).unwrap_or_default();
    let mut at = digits(text);
    if let Some(more) = behind(at).strip_prefix('.').map(digits).filter(|more| *more > 0) {
        at += 1 + more;
    }
    if let Some(power) = behind(at).strip_prefix(['e', 'E']) {
        let signed = power.strip_prefix(['-', '+']);
        let more = digits(signed.unwrap_or(power));
        if more > 0 {
            at += 1 + usize::from(signed.is_some()) + more;
        }
    }
    at
}

/// The frame of each key in ascending order; `None` if fewer than two keys differ.
fn ranked(keys: Vec<Option<Vec<f64>>>) -> Option<Order> {
    let compare = |a: &Vec<f64>, b: &Vec<f64>| {
        let pairs = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
        pairs.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then).then(a.len().cmp(&b.len()))
    };
    let mut sorted: Vec<_> = keys.iter().flatten().cloned().collect();
    sorted.sort_by(compare);
    sorted.dedup_by(|a, b| compare(a, b).is_eq());
    let frame = |key: Vec<f64>| sorted.binary_search_by(|other| compare(other, &key)).ok();
    (sorted.len() > 1).then(|| Order::Frames(keys.into_iter().map(|key| frame(key?)).collect()))
}

/// Decides what groups are, from the path and the time of each.
pub(super) fn order(groups: &[(&str, Option<f64>)]) -> Order {
    let all: Vec<_> = groups.iter().map(|(path, _)| split(path)).collect();
    let keys = |of: &dyn Fn(&Number<'_>) -> bool| -> Vec<Option<Vec<f64>>> {
        let key = |numbers: &Vec<Number<'_>>| -> Vec<f64> {
            numbers.iter().filter(|number| of(number)).map(|number| number.value).collect()
        };
        all.iter().map(|(numbers, _)| Some(key(numbers)).filter(|key| !key.is_empty())).collect()
    };
    let mut named = keys(&|number| number.counts(FRAMES));
    if named.iter().all(Option::is_none) {
        named = keys(&|number| number.word.is_empty());
    }
    let in_frame = named.iter().any(Option::is_some);
    let timed = || ranked(groups.iter().map(|(_, time)| Some(vec![(*time)?])).collect());
    if let Some(frames) = ranked(named).or_else(timed) {
        return frames;
    }
    let paths: Vec<&str> = groups.iter().map(|(path, _)| *path).collect();
    match varying(&paths) {
        Some(numbers) if !in_frame && !numbers.is_empty() => {
            let known = |number: &Number<'_>| number.counts(PIECES) || number.counts(FLUIDS);
            if numbers.iter().all(known) { Order::Together } else { Order::Unsure }
        }
        _ => Order::Together,
    }
}

/// Whether the paths differ only in the numbers of pieces.
pub(super) fn are_pieces(paths: &[&str]) -> bool {
    let numbers = varying(paths).unwrap_or_default();
    !numbers.is_empty() && numbers.iter().all(|number| number.counts(PIECES))
}

/// The numbers in which paths differ; `None` if they differ in text.
fn varying<'a>(paths: &[&'a str]) -> Option<Vec<Number<'a>>> {
    let mut all = paths.iter().map(|path| split(path));
    let (first, text) = all.next()?;
    let mut varies = vec![false; first.len()];
    for (numbers, other) in all {
        if other != text {
            return None;
        }
        let pairs = varies.iter_mut().zip(first.iter().zip(&numbers));
        pairs.for_each(|(varies, (a, b))| *varies |= a.value != b.value);
    }
    let numbers = first.into_iter().zip(varies);
    Some(numbers.filter_map(|(number, varies)| varies.then_some(number)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_before_a_number_decides() {
        let of =
            |paths: &[&str]| order(&paths.iter().map(|path| (*path, None)).collect::<Vec<_>>());
        let frames = |frames: &[usize]| Order::Frames(frames.iter().copied().map(Some).collect());
        for paths in [
            ["/Step#2", "/Step#10"],
            ["/0000/fluid", "/0005/fluid"],
            ["/t_1e-05", "/t_0.5"],
            ["/t=-0.5", "/t=0"],
            ["/step-5", "/step-10"],
            ["/TimeStep2", "/TimeStep10"],
            ["/run/dataT2", "/run/dataT3"],
            ["/data0002", "/data0010"],
            ["/output_1/step_9", "/output_2/step_0"],
        ] {
            assert_eq!(of(&paths), frames(&[0, 1]), "{paths:?}");
        }
        assert_eq!(of(&["/frame_3/a", "/frame_2/a", "/frame_3/b"]), frames(&[1, 0, 1]));
        assert_eq!(of(&["/walls", "/it2", "/it1"]), Order::Frames(vec![None, Some(1), Some(0)]));
        for paths in [
            ["/rank_0", "/rank_1"],
            ["/fluid1", "/fluid2"],
            ["/step_1/body0", "/step_1/body1"],
            ["/a", "/b"],
        ] {
            assert_eq!(of(&paths), Order::Together, "{paths:?}");
        }
        for paths in [
            ["/body0", "/body1"],
            ["/Part_0001", "/Part_0002"],
            ["/PartType1", "/PartType2"],
            ["/rank_0/s1", "/rank_1/s2"],
        ] {
            assert_eq!(of(&paths), Order::Unsure, "{paths:?}");
        }
        assert_eq!(order(&[("/body0", Some(1.0)), ("/body1", Some(0.5))]), frames(&[1, 0]));
        assert_eq!(order(&[("/body0", Some(1.0)), ("/body1", Some(1.0))]), Order::Unsure);
        assert!(are_pieces(&["/step_1/rank_0/p", "/step_1/rank_1/p"]));
        assert!(!are_pieces(&["/rank_0", "/body_1"]) && !are_pieces(&["/fluid1", "/fluid2"]));
    }
}
