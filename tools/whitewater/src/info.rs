//! `whitewater info`: contents of particle files.

use std::collections::{BTreeSet, HashSet};

use serde_json::{Map, Value, json};
use whitewater::io::particles::sequence::{self, Frame, SequenceError};
use whitewater::io::particles::{self, Meaning, Particles};

use crate::args::InfoArgs;
use crate::bounds::Extent;
use crate::extras;
use crate::failure::{Failure, Kind, Outcome};
use crate::fluids::Fluids;
use crate::folder;
use crate::frames;
use crate::out;
use crate::placing;
use crate::radii;
use crate::reader::Has;
use crate::summary::{self, Summary};
use crate::upright;

pub fn run(args: &InfoArgs) -> Outcome<()> {
    let inputs = args.inputs.iter().map(|input| folder::in_folder(input));
    let inputs = inputs.collect::<Outcome<Vec<_>>>()?;
    let frames = expand(&inputs).map_err(frames::advised)?;
    let mut all = Vec::new();
    let mut failed = Vec::new();
    let mut summary = Summary::default();
    for frame in &frames {
        let path = frame.path.display().to_string();
        match extras::read(frame, &[], &Fluids::default(), None) {
            Ok(mut particles) => {
                let unsure = radii::unsure(&particles);
                if let Some(Err(why)) = &unsure {
                    particles.warnings.push(radii::unused(why));
                }
                if let Some(Ok(())) = unsure {
                    radii::take(&mut particles, radii::UNSURE, &frame.path)?;
                }
                let speeds = placing::agree(&mut particles, 1.0);
                particles.warnings.extend(speeds);
                let value = describe(&path, frame, &particles);
                let spacing = value["spacing"].as_f64().map(|spacing| spacing as f32);
                summary.add(frame.number, &particles, spacing);
                if args.json {
                    all.push(value);
                } else {
                    out::print(format_args!("{}", text(&value)))?;
                }
            }
            Err(error) => {
                if frames.len() == 1 {
                    return Err(error);
                }
                out::note(format_args!("{}", error.message));
                all.push(json!({"file": path, "frame": frame.number, "error": error.message}));
                failed.push(path);
            }
        }
    }
    if args.json {
        let value = json!({"frames": all, "sequence": summary.value(&frames)});
        let text = serde_json::to_string_pretty(&value).unwrap_or_default();
        out::print(format_args!("{text}\n"))?;
    } else if let Some(value) = summary.value(&frames) {
        out::print(format_args!("{}", summary::text(&value)))?;
    }
    if failed.is_empty() {
        return Ok(());
    }
    let kind = if failed.len() == frames.len() { Kind::Input } else { Kind::Partly };
    let (some, total) = (failed.len(), frames.len());
    Err(Failure::new(
        kind,
        format!("{some} of {total} files cannot be read: {}", failed.join(", ")),
    ))
}

/// Lists the frames of all inputs as one sequence. If two files have the same frame number, it lists the frames of
/// one input after those of another, and each file once.
fn expand(inputs: &[String]) -> Result<Vec<Frame>, SequenceError> {
    match sequence::expand(inputs, None).map(frames::in_files) {
        Err(SequenceError::Twice { .. }) if inputs.len() > 1 => {
            let each = |input| sequence::expand(std::slice::from_ref(input), None);
            let mut frames = inputs.iter().map(each).collect::<Result<Vec<_>, _>>()?.concat();
            let mut known = HashSet::new();
            frames.retain(|frame| known.insert(frame.path.clone()));
            Ok(frames)
        }
        other => other,
    }
}

fn describe(path: &str, frame: &Frame, particles: &Particles) -> Value {
    let finite = particles.positions.iter().filter(|p| p.iter().all(|c| c.is_finite()));
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in finite {
        for axis in 0..3 {
            min[axis] = min[axis].min(p[axis]);
            max[axis] = max[axis].max(p[axis]);
        }
    }
    let some = min[0] <= max[0];
    let attributes: Vec<Value> = particles
        .attributes
        .iter()
        .map(|a| {
            let meaning = meaning(particles, &a.name).map(|meaning| meaning.to_string());
            let meaning = meaning.or_else(|| beside(particles, &a.name));
            json!({"name": a.name, "type": a.ty.to_string(), "components": a.components, "meaning": meaning})
        })
        .collect();
    let spacing = particles::estimate_spacing(&particles.positions);
    let extent = Extent::of(&particles.positions);
    let phases: Map<String, Value> = extras::phases(particles)
        .into_iter()
        .map(|(name, values)| {
            let values = values.into_iter().map(|(value, count)| (value.to_string(), json!(count)));
            (name.to_string(), Value::Object(values.collect()))
        })
        .collect();
    // As the keys of `phases`.
    let names = |values: BTreeSet<i64>| values.iter().map(i64::to_string).collect::<Vec<_>>();
    let at_rest: Map<String, Value> = extras::phases(particles)
        .into_iter()
        .map(|(name, _)| (name.to_string(), json!(names(extras::at_rest(particles, name)))))
        .collect();
    let radii = radii::radii(particles);
    let misfit = radii.zip(spacing).and_then(|([_, radius, _], s)| radii::misfit(radius, s));
    let warnings: Vec<_> = particles.warnings.iter().chain(&misfit).collect();
    json!({
        "file": path,
        "frame": frame.number,
        "format": particles.format.to_string(),
        "particles": particles.positions.len(),
        "non_finite": particles::count_non_finite(&particles.positions),
        "bounds": some.then(|| json!({"min": min, "max": max})),
        "spacing": spacing,
        "radius": spacing.map(|s| 0.5 * s),
        "density": particles.densities.as_deref().and_then(statistics),
        "attributes": attributes,
        "time": particles.time.or(frame.time),
        "radii": radii,
        "phases": phases,
        "at_rest": at_rest,
        "missing": missing(Has::of(particles)),
        "unit": unit(particles, &extent),
        "up": up(particles, extent),
        "warnings": warnings,
    })
}

/// The axis that points up.
fn up(particles: &Particles, extent: Extent) -> Value {
    match upright::find(std::slice::from_ref(particles), &[extent]) {
        Some(found) => json!({"axis": found.up.name(), "sure": found.sure, "why": found.why}),
        None => json!({
            "axis": "y",
            "sure": "assumed",
            "why": "neither where the water lies nor how it moves shows another axis",
        }),
    }
}

/// The unit of length that the file names, or a message if the water's extent is implausible in metres.
fn unit(particles: &Particles, extent: &Extent) -> Option<String> {
    let hint = || {
        let longest = extent.bulk?.size().max_element();
        placing::hint(longest, placing::fastest(particles))
    };
    let named = placing::named_hint(particles).or_else(hint);
    named.or_else(|| placing::named_metres(particles))
}

/// The meaning of an attribute; `None` if it is ignored.
fn meaning(particles: &Particles, name: &str) -> Option<Meaning> {
    let of_name = |(_, names): &&(Meaning, Vec<String>)| names.iter().any(|n| n == name);
    let (meaning, _) = particles.meanings.iter().find(of_name)?;
    // Values that are not whole numbers are dropped, and those that only some of several joined files have.
    let there = match meaning {
        Meaning::Velocity => particles.velocities.is_some(),
        Meaning::Density => particles.densities.is_some(),
        Meaning::Lifetime => particles.lifetimes.is_some(),
        Meaning::Id => particles.ids.is_some(),
        Meaning::Kind => particles.kinds.is_some(),
        _ => true,
    };
    there.then_some(*meaning)
}

/// Another use of an attribute, beside its meaning.
fn beside(particles: &Particles, name: &str) -> Option<String> {
    if radii::is_radius(name) {
        return radii::radii(particles).map(|_| "radius".into());
    }
    // One called `r` was renamed if it holds the radii.
    let renamed = particles::same_name(name, radii::UNSURE)
        && extras::find(particles, radii::UNSURE).is_none()
        && !particles.attributes.iter().any(|a| radii::is_radius(&a.name));
    if renamed && radii::radii(particles).is_some() {
        return Some("radius".into());
    }
    let phases = extras::phases(particles);
    phases
        .into_iter()
        .find(|(phase, _)| *phase == name)
        .map(|_| "--where can select particles by it".into())
}

/// What is missing, and the consequence.
fn missing(has: Has) -> Option<&'static str> {
    match (has.velocities, has.ids) {
        (true, true) => None,
        (true, false) => Some("no ids: in a sequence foam is found for each frame by itself"),
        (false, true) => Some(
            "no velocities: drawn alone this file has no foam; in a sequence velocities are found by the ids",
        ),
        (false, false) => Some(
            "no velocities and no ids: drawn alone this file has no foam; in a sequence velocities are found if the particles keep their order",
        ),
    }
}

fn statistics(values: &[f32]) -> Option<Value> {
    let mut sorted: Vec<f32> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let (least, most) = (*sorted.first()?, *sorted.last()?);
    let mean = sorted.iter().map(|v| f64::from(*v)).sum::<f64>() / sorted.len() as f64;
    let median = *sorted.get(sorted.len() / 2)?;
    Some(json!({"min": least, "median": median, "mean": mean as f32, "max": most}))
}

/// The report as text.
fn text(value: &Value) -> String {
    let text = |key: &str| value[key].as_str().unwrap_or_default();
    let number = |v: &Value| v.as_f64().map_or("-".into(), |v| format!("{:.6}", v as f32));
    let vector = |v: &Value| {
        let parts = v.as_array().map(Vec::as_slice).unwrap_or_default();
        parts.iter().map(number).collect::<Vec<_>>().join(" ")
    };
    let mut lines = vec![
        text("file").to_owned(),
        format!("  format      {}", text("format")),
        format!("  frame       {}", value["frame"]),
        format!("  particles   {}", value["particles"]),
    ];
    if value["non_finite"] != json!(0) {
        lines.push(format!("  not finite  {}", value["non_finite"]));
    }
    if let Some(bounds) = value["bounds"].as_object() {
        lines.push(format!("  from        {}", vector(&bounds["min"])));
        lines.push(format!("  to          {}", vector(&bounds["max"])));
    }
    let (spacing, radius) = (number(&value["spacing"]), number(&value["radius"]));
    lines.push(format!("  spacing     {spacing} (estimated; radius {radius})"));
    if let [least, _, most] = value["radii"].as_array().map(Vec::as_slice).unwrap_or_default() {
        lines.push(format!("  radii       {} to {}", number(least), number(most)));
    }
    if let Some(time) = value["time"].as_f64() {
        lines.push(format!("  time        {time}"));
    }
    if let Some(density) = value["density"].as_object() {
        let all: Vec<String> =
            density.iter().map(|(name, v)| format!("{name} {}", number(v))).collect();
        lines.push(format!("  density     {}", all.join(", ")));
    }
    for a in value["attributes"].as_array().map(Vec::as_slice).unwrap_or_default() {
        let [name, ty] = ["name", "type"].map(|key| a[key].as_str().unwrap_or_default());
        let meaning = a["meaning"].as_str().unwrap_or("not used");
        lines.push(format!("  attribute   {name} ({ty} x {}): {meaning}", a["components"]));
    }
    for (name, values) in value["phases"].as_object().into_iter().flatten() {
        let at_rest = value["at_rest"][name].as_array().map(Vec::as_slice).unwrap_or_default();
        let one = |(value, count): (&String, &Value)| {
            let rests = at_rest.iter().any(|resting| resting.as_str() == Some(value));
            let rests = if rests { ", all at rest: walls?" } else { "" };
            format!("{value} ({count} particles{rests})")
        };
        let all: Vec<_> = values.as_object().into_iter().flatten().map(one).collect();
        lines.push(format!("  values      {name}: {}", all.join(", ")));
    }
    let [axis, sure, why] =
        ["axis", "sure", "why"].map(|key| value["up"][key].as_str().unwrap_or("-"));
    lines.push(format!("  up          {axis}, {sure}: {why}"));
    if let Some(unit) = value["unit"].as_str() {
        lines.push(format!("  unit        {unit}"));
    }
    if let Some(missing) = value["missing"].as_str() {
        lines.push(format!("  missing     {missing}"));
    }
    for warning in value["warnings"].as_array().map(Vec::as_slice).unwrap_or_default() {
        lines.push(format!("  warning     {}", warning.as_str().unwrap_or_default()));
    }
    lines.join("\n") + "\n"
}
