//! Finds the particles of a JSON object that has other things beside them, such as settings.

use serde_json::{Map, Value};

use super::error::ReadError;
use super::json::{is_list_of_particles, lists};
use super::names;

/// Names of objects and lists that have positions but no particles. They do not count beside others.
const OTHERS: [&str; 14] = [
    "box",
    "boxes",
    "bbox",
    "boundingbox",
    "aabb",
    "domain",
    "bounds",
    "extent",
    "extents",
    "limits",
    "range",
    "cell",
    "camera",
    "gravity",
];

/// Where particles may be.
struct Place {
    /// Names of the members on the way; `None` for the only entry of a list.
    path: Vec<Option<String>>,
    /// Whether the names in it say that these are particles; otherwise it is a list of lists.
    named: bool,
}

impl Place {
    fn name(&self) -> String {
        let names: Vec<_> = self.path.iter().flatten().map(String::as_str).collect();
        format!("`{}`", names.join("."))
    }

    fn is_other(&self) -> bool {
        let last = self.path.iter().flatten().next_back();
        last.is_some_and(|name| OTHERS.contains(&names::plain(name).as_str()))
    }
}

/// Whether a value is a list of particles that have more than a position.
fn is_rows(value: &Value) -> bool {
    let first = value.as_array().and_then(|rows| rows.first()).and_then(Value::as_object);
    first.is_some_and(|row| {
        let names: Vec<_> = row.keys().collect();
        names::have_positions(&names) && !row.keys().all(|name| names::is_component(name))
    })
}

/// Whether an object has lists of positions.
pub(super) fn has_positions(map: &Map<String, Value>) -> bool {
    let listed = |(name, value): &(&String, &Value)| {
        (value.is_array() && !is_rows(value)) || (names::is_vector(name) && lists(value).is_some())
    };
    let names: Vec<_> = map.iter().filter(listed).map(|(name, _)| name).collect();
    names::may_have_positions(&names)
}

fn search(value: &Value, path: &mut Vec<Option<String>>, found: &mut Vec<Place>) {
    let mut place = |named| found.push(Place { path: path.clone(), named });
    match value {
        Value::Object(map) if has_positions(map) => place(true),
        Value::Object(map) => {
            for (name, value) in
                map.iter().filter(|(_, value)| value.is_array() || value.is_object())
            {
                path.push(Some(name.clone()));
                search(value, path, found);
                path.pop();
            }
        }
        Value::Array(rows) => match (rows.first(), rows.len()) {
            (Some(Value::Object(row)), _)
                if names::may_have_positions(&row.keys().collect::<Vec<_>>()) =>
            {
                place(true);
            }
            (Some(only @ Value::Object(_)), 1) => {
                path.push(None);
                search(only, path, found);
                path.pop();
            }
            (Some(Value::Array(_)), _) if is_list_of_particles(value) => place(false),
            _ => {}
        },
        _ => {}
    }
}

/// The only place of an object that has particles, with the objects on the way to it, the outermost first, without
/// other members; `None` if no place has. Lists that may be particles too are told.
///
/// # Errors
/// There are several places.
pub(super) fn only(
    map: &mut Map<String, Value>,
    warnings: &mut Vec<String>,
) -> Result<Option<(Value, Option<f64>)>, ReadError> {
    let (mut path, mut all) = (Vec::new(), Vec::new());
    for (name, value) in map.iter() {
        path.push(Some(name.clone()));
        search(value, &mut path, &mut all);
        path.pop();
    }
    let named = all.iter().any(|place| place.named && !place.is_other());
    let better = all.iter().any(|place| place.named == named && !place.is_other());
    let (best, rest): (Vec<&Place>, Vec<&Place>) =
        all.iter().partition(|place| !better || (place.named == named && !place.is_other()));
    let list = |places: &[&Place]| {
        let some: Vec<_> = places.iter().take(8).map(|place| place.name()).collect();
        some.join(", ") + if places.len() > some.len() { " ..." } else { "" }
    };
    let [place] = best.as_slice() else {
        if best.is_empty() {
            return Ok(None);
        }
        return Err(ReadError::Unsupported {
            what: format!("a file with positions inside several objects: {}", list(&best)),
            advice: "write each object to a file of its own",
        });
    };
    let unread: Vec<&Place> = rest.into_iter().filter(|place| !place.is_other()).collect();
    if !unread.is_empty() {
        warnings.push(format!(
            "the particles are those of {}; other lists are not read: {}",
            place.name(),
            list(&unread)
        ));
    }
    let mut steps = place.path.iter();
    let first = steps.next().and_then(Option::as_ref).and_then(|name| map.remove(name));
    let (mut value, mut time) = (first.unwrap_or_default(), None);
    for step in steps {
        if let Value::Object(map) = &value {
            time = super::json_frames::time(map).or(time);
        }
        value = match (step, value) {
            (Some(name), Value::Object(mut map)) => map.remove(name).unwrap_or_default(),
            (None, Value::Array(mut list)) if !list.is_empty() => list.swap_remove(0),
            (_, value) => value,
        };
    }
    if let Value::Object(map) = &value {
        time = super::json_frames::time(map).or(time);
    }
    Ok(Some((value, time)))
}
