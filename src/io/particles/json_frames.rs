//! Separates the frames of a JSON file that holds several.

use std::collections::HashMap;
use std::ops::Range;

use serde_json::{Map, Value};

use super::json::{is_list_of_particles, lists};
use super::names;

/// How the frames of a file are stored.
enum Frames {
    /// A list with one entry per frame. An entry is a list of particles, an object with such a list, or an object
    /// with an array per attribute.
    List(usize),
    /// Objects or lists by name, ordered by the number in the name.
    Named(Vec<String>),
    /// Arrays with an additional dimension for frames.
    Stacked(usize),
    /// Frames inside an object with this single name.
    Behind(String),
}

/// Whether a value is one frame: a list of particles (each a list of numbers, or an object with a position), or an
/// object with a list of particles or with columns (an array per attribute, such as x, y and z).
fn is_frame(value: &Value) -> bool {
    match value {
        Value::Array(rows) => rows.first().is_some_and(|row| match row {
            Value::Array(row) => row.iter().all(Value::is_number) && row.len() > 1,
            Value::Object(row) => names::may_have_positions(&row.keys().collect::<Vec<_>>()),
            _ => false,
        }),
        Value::Object(map) => {
            let known = names::may_have_positions(&map.keys().collect::<Vec<_>>());
            // A particle has numbers and short vectors; a frame has lists of them.
            let columns = map.iter().any(|(name, value)| {
                if names::is_position(name) && lists(value).is_some() {
                    return true;
                }
                let Value::Array(list) = value else { return false };
                let vectors = list.first().is_some_and(|first| !first.is_number());
                names::is_component(name)
                    || (names::is_position(name) && (vectors || list.len() >= 6))
            });
            columns || (!known && map.values().any(is_list_of_particles))
        }
        _ => false,
    }
}

fn frames(value: &Value) -> Option<Frames> {
    match value {
        Value::Array(list) if list.first().is_some_and(is_frame) => {
            // A list of one frame is that frame.
            (list.len() > 1 && list.iter().all(|frame| is_frame(frame) || is_none(frame)))
                .then_some(Frames::List(list.len()))
        }
        Value::Object(map) => of_object(map),
        _ => None,
    }
}

/// Whether a value can be a frame without particles.
fn is_none(value: &Value) -> bool {
    let empty = |value: &Value| value.as_array().is_some_and(Vec::is_empty);
    empty(value) || value.as_object().is_some_and(|map| map.values().any(empty))
}

fn of_object(map: &Map<String, Value>) -> Option<Frames> {
    let positions = |name: &&String| names::is_position(name) || names::is_component(name);
    if let Some(name) = map.keys().find(positions) {
        let list = map.get(name)?.as_array()?;
        let first = list.first()?.as_array()?;
        let stacked = match names::is_component(name) {
            true => first.first().is_some_and(Value::is_number) && first.len() > 3,
            false => first.first().is_some_and(|row| row.is_array() || row.is_object()),
        };
        return (stacked && list.len() > 1).then_some(Frames::Stacked(list.len()));
    }
    let held = map.iter().filter(|(_, value)| value.is_array() || value.is_object());
    let mut several = held.clone().filter(|(_, value)| frames(value).is_some());
    if let (Some((name, _)), None) = (several.next(), several.next()) {
        return Some(Frames::Behind(name.clone()));
    }
    // Settings may be beside the frames.
    let other = |(name, value): &(&String, &Value)| {
        value.is_object() && number(name).is_none() && !is_frame(value)
    };
    let held = held.filter(|each| !other(each));
    let numbered =
        held.map(|(name, value)| Some((number(name)?, name)).filter(|_| is_frame(value)));
    let mut all: Vec<(u64, &String)> = numbered.collect::<Option<_>>()?;
    all.sort_unstable();
    (all.len() > 1).then(|| Frames::Named(all.into_iter().map(|(_, name)| name.clone()).collect()))
}

/// The last number in a name.
fn number(name: &str) -> Option<u64> {
    let end = name.rfind(|c: char| c.is_ascii_digit())? + 1;
    let digits = name.get(..end)?;
    let start = digits.rfind(|c: char| !c.is_ascii_digit()).map_or(0, |at| at + 1);
    digits.get(start..)?.parse().ok()
}

/// The time of a frame. Its time in seconds is preferred to its step number.
pub(super) fn time(map: &Map<String, Value>) -> Option<f64> {
    let times = map.iter().filter_map(|(name, value)| {
        let time = value.as_f64()?;
        Some((names::time_rank(name)?, time))
    });
    times.min_by_key(|(rank, _)| *rank).map(|(_, time)| time)
}

/// The times of all frames; empty for one frame.
pub(super) fn times(value: &Value) -> Vec<Option<f64>> {
    let of = |value: &Value| value.as_object().and_then(time);
    match (frames(value), value) {
        (Some(Frames::List(_)), Value::Array(list)) => list.iter().map(of).collect(),
        (Some(Frames::Named(all)), Value::Object(map)) => {
            all.iter().map(|name| map.get(name).and_then(of)).collect()
        }
        (Some(Frames::Stacked(count)), Value::Object(map)) => {
            let lists = map.iter().filter_map(|(name, value)| {
                let list = value.as_array().filter(|list| list.len() == count)?;
                Some((names::time_rank(name)?, list))
            });
            let list = lists.min_by_key(|(rank, _)| *rank).map(|(_, list)| list);
            (0..count).map(|i| list.and_then(|list| list.get(i)?.as_f64())).collect()
        }
        (Some(Frames::Behind(name)), Value::Object(map)) => {
            map.get(&name).map_or_else(Vec::new, times)
        }
        _ => Vec::new(),
    }
}

/// If the value is a list whose only entry is an object that is a frame (with arrays of particles' attributes),
/// returns that object; otherwise returns the value.
pub(super) fn alone(value: Value) -> Value {
    match value {
        Value::Array(mut list)
            if list.len() == 1 && list.iter().all(|v| v.is_object() && is_frame(v)) =>
        {
            list.swap_remove(0)
        }
        value => value,
    }
}

/// One frame; the value itself if it holds only one.
pub(super) fn one(value: Value, index: usize) -> Value {
    match (frames(&value), value) {
        (Some(Frames::List(count)), Value::Array(mut list)) => {
            list.swap_remove(index.min(count.saturating_sub(1)))
        }
        (Some(Frames::Named(all)), Value::Object(mut map)) => {
            let name = all.get(index).or(all.last());
            name.and_then(|name| map.remove(name)).unwrap_or_default()
        }
        (Some(Frames::Stacked(count)), Value::Object(map)) => {
            let part = |(name, value): (String, Value)| match value {
                // A value that is no list of frames belongs to all frames.
                Value::Array(mut list) if list.len() == count => {
                    (name, list.swap_remove(index.min(count.saturating_sub(1))))
                }
                value => (name, value),
            };
            Value::Object(map.into_iter().map(part).collect())
        }
        (Some(Frames::Behind(name)), Value::Object(mut map)) => {
            one(map.remove(&name).unwrap_or_default(), index)
        }
        (_, value) => value,
    }
}

/// Max number of arrays of a frame that are located in the text.
const ARRAYS: usize = 8;

/// Position of a frame in the JSON text: for each of its arrays the byte range of the array's name and that of its
/// value. If the range of the name is empty, the value is the whole frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::io::particles) struct Part([[u64; 4]; ARRAYS]);

impl Part {
    /// From the arrays' byte ranges: name and value.
    fn of(arrays: impl Iterator<Item = (Range<usize>, Range<usize>)>) -> Self {
        let mut part = Self::default();
        for (to, (name, range)) in part.0.iter_mut().zip(arrays) {
            *to = [name.start, name.end, range.start, range.end].map(|at| at as u64);
        }
        part
    }

    /// This position in a larger text, in which the text that it refers to begins at byte `by`.
    fn moved(self, by: usize) -> Self {
        let moved = |[a, b, c, d]: [u64; 4]| {
            let at = |x: u64| x + by as u64;
            if a == b { [0, 0, at(c), at(d)] } else { [a, b, c, d].map(at) }
        };
        Self(self.0.map(|range| if range == [0; 4] { range } else { moved(range) }))
    }

    /// The frame as JSON text; `read` returns the bytes of a range.
    pub(super) fn text(self, mut read: impl FnMut(u64, u64) -> Option<Vec<u8>>) -> Option<Vec<u8>> {
        let mut text = Vec::new();
        for [from, to, start, end] in self.0.into_iter().filter(|[.., end]| *end > 0) {
            let value = read(start, end)?;
            if from == to {
                return Some(value);
            }
            text.push(if text.is_empty() { b'{' } else { b',' });
            text.extend(read(from, to)?);
            text.push(b':');
            text.extend(value);
        }
        text.push(b'}');
        Some(text)
    }
}

/// Position of each frame in the JSON text, so that one frame can be read alone. `None` if there is a single frame,
/// or if a frame has more than `ARRAYS` arrays.
pub(super) fn parts(value: &Value, text: &[u8]) -> Option<Vec<Part>> {
    let named = || {
        let name = |(name, part): (Range<usize>, _)| {
            let own: String = serde_json::from_slice(text.get(name.clone())?).ok()?;
            Some((own, (name, part)))
        };
        // If two names are equal, the last one is used.
        held(text, 1).into_iter().filter_map(name).collect::<HashMap<_, _>>()
    };
    let whole = |range: Range<usize>| Part::of(std::iter::once((0..0, range)));
    match (frames(value)?, value) {
        (Frames::List(count), _) => {
            // One value per line, or an array.
            let lines = held(text, 0);
            let all = if lines.len() == 1 { held(text, 1) } else { lines };
            let parts: Vec<_> = all.into_iter().map(|(_, part)| whole(part)).collect();
            (parts.len() == count).then_some(parts)
        }
        (Frames::Named(all), _) => {
            let named = named();
            all.iter().map(|name| named.get(name).map(|(_, part)| whole(part.clone()))).collect()
        }
        (Frames::Stacked(count), _) => {
            let arrays = named();
            let mut parts = vec![Vec::new(); count];
            let all = arrays.iter().filter(|(name, _)| !names::is_time(name));
            for (_, (name, range)) in all.filter(|_| arrays.len() <= ARRAYS) {
                let inner = held(text.get(range.clone())?, 1);
                for (i, part) in parts.iter_mut().enumerate() {
                    // A value that is no list of frames belongs to all frames.
                    let own = inner.get(i).filter(|_| inner.len() == count);
                    let own = own.map_or(range.clone(), |(_, own)| {
                        own.start + range.start..own.end + range.start
                    });
                    part.push((name.clone(), own));
                }
            }
            let parts = parts.into_iter().map(|part| Part::of(part.into_iter()));
            (arrays.len() <= ARRAYS).then(|| parts.collect())
        }
        (Frames::Behind(name), Value::Object(map)) => {
            let (_, inner) = named().get(&name)?.clone();
            let parts = parts(map.get(&name)?, text.get(inner.clone())?)?;
            Some(parts.into_iter().map(|part| part.moved(inner.start)).collect())
        }
        _ => None,
    }
}

/// Finds the arrays and objects at a nesting level (0: outermost) of valid JSON text, which may have comments.
/// Returns for each the byte range of the string before it (in an object, its name), and its own byte range.
fn held(text: &[u8], level: usize) -> Vec<(Range<usize>, Range<usize>)> {
    let mut all = Vec::new();
    let (mut depth, mut begin) = (0_usize, 0);
    let (mut quote, mut escaped) = (None, false);
    let mut name = 0..0;
    let mut comment = 0;
    for (at, byte) in text.iter().enumerate() {
        if at < comment {
            continue;
        }
        if let Some(from) = quote {
            match byte {
                _ if escaped => escaped = false,
                b'\\' => escaped = true,
                b'"' => {
                    quote = None;
                    if depth == level {
                        name = from..at + 1;
                    }
                }
                _ => {}
            }
            continue;
        }
        match byte {
            b'"' => quote = Some(at),
            // No JSON value begins with a slash.
            b'/' => {
                let rest = text.get(at..).unwrap_or_default();
                comment = at + super::json::comment(rest).unwrap_or(1);
            }
            b'[' | b'{' => {
                if depth == level {
                    begin = at;
                }
                depth += 1;
            }
            b']' | b'}' => {
                depth = depth.saturating_sub(1);
                if depth == level {
                    all.push((name.clone(), begin..at + 1));
                }
            }
            _ => {}
        }
    }
    all
}
