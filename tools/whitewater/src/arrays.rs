//! NumPy arrays in files of their own, as `numpy.save` writes them: positions in `x_0001.npy`, velocities in
//! `v_0001.npy`.

use std::ops::Range;
use std::path::{Path, PathBuf};

use whitewater::io::particles::{self, Attribute, AttributeType, Meaning, Particles, Step};

const POSITIONS: [&str; 10] =
    ["x", "p", "pos", "position", "positions", "point", "points", "coords", "xyz", "xp"];
const VELOCITIES: [&str; 7] = ["v", "u", "vel", "vels", "velocity", "velocities", "vp"];

/// Position of the first of these words in a file's name.
fn word(stem: &str, words: &[&str]) -> Option<Range<usize>> {
    let letter = |at: usize| stem.as_bytes().get(at).is_some_and(u8::is_ascii_alphabetic);
    let starts = (0..stem.len()).filter(|at| letter(*at) && (*at == 0 || !letter(*at - 1)));
    let mut runs = starts
        .map(|start| start..(start..stem.len()).find(|at| !letter(*at)).unwrap_or(stem.len()));
    runs.rfind(|run| words.contains(&stem[run.clone()].to_lowercase().as_str()))
}

fn stem(path: &Path) -> Option<&str> {
    path.file_name()?.to_str()?.strip_suffix(".npy")
}

/// The name of the positions, if all other names are velocities.
pub fn positions_of<'a>(names: &[&'a str]) -> Option<&'a str> {
    let is = |name: &str, words: &[&str]| {
        stem(Path::new(name)).is_some_and(|stem| word(stem, words).is_some())
    };
    let (positions, rest): (Vec<_>, Vec<_>) =
        names.iter().copied().partition(|name| is(name, &POSITIONS));
    match positions.as_slice() {
        [one] if rest.iter().all(|name| is(name, &VELOCITIES)) => Some(*one),
        _ => None,
    }
}

/// The velocity file that belongs to a position file.
pub fn velocities_beside(path: &Path) -> Option<PathBuf> {
    let stem = stem(path)?;
    let at = word(stem, &POSITIONS)?;
    let upper = stem[at.clone()].starts_with(|c: char| c.is_ascii_uppercase());
    let named = |word: &str| {
        let word = if upper { word[..1].to_uppercase() + &word[1..] } else { word.into() };
        path.with_file_name(format!("{}{word}{}.npy", &stem[..at.start], &stem[at.end..]))
    };
    VELOCITIES.iter().map(|word| named(word)).find(|path| path.is_file())
}

/// Whether a file holds velocities, by its name.
pub fn is_of_velocities(path: &Path) -> bool {
    stem(path)
        .is_some_and(|stem| word(stem, &VELOCITIES).is_some() && word(stem, &POSITIONS).is_none())
}

/// If the particles of the position file `path` have no velocities, adds those of the velocity file beside it, such
/// as `v_0001.npy` beside `x_0001.npy`. If each file holds several frames, `step` selects one. What does not fit
/// becomes a warning.
pub fn add(particles: &mut Particles, path: &Path, step: Option<Step>) {
    if particles.velocities.is_some() {
        return;
    }
    if is_of_velocities(path) {
        let why = "the file's name says that these are velocities, but they are read as positions";
        particles.warnings.push(why.into());
        return;
    }
    let Some(beside) = velocities_beside(path) else { return };
    let name = beside.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let read = match step {
        Some(step) => particles::read_step(&beside, Step::new(step.index, step.time), &[]),
        None => particles::read(&beside),
    };
    match read {
        Ok(mut other) if other.positions.len() == particles.positions.len() => {
            other.move_to([0.0; 3]);
            particles.velocities = Some(other.positions);
            let ty = other.attributes.first().map_or(AttributeType::F32, |array| array.ty);
            particles.attributes.push(Attribute { name: name.clone(), components: 3, ty });
            particles.meanings.push((Meaning::Velocity, vec![name]));
        }
        Ok(other) => particles.warnings.push(format!(
            "{name} has {} vectors, expected {}; its velocities are ignored",
            other.positions.len(),
            particles.positions.len()
        )),
        Err(error) => particles
            .warnings
            .push(format!("cannot read the velocities from the file beside it: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_told_by_their_files() {
        for (names, expected) in [
            (&["a/v_*.npy", "a/x_*.npy"][..], Some("a/x_*.npy")),
            (&["velocity.npy", "position.npy"], Some("position.npy")),
            (&["sim_*_Vel.npy", "sim_*_Pos.npy"], Some("sim_*_Pos.npy")),
            (&["x_*.npy", "foam_*.npy"], None),
            (&["x_*.npy", "p_*.npy"], None),
            (&["v_*.csv", "x_*.csv"], None),
            (&["max_*.npy", "v_*.npy"], None),
        ] {
            assert_eq!(positions_of(names), expected, "{names:?}");
        }
    }

    /// An array of these vectors in NumPy's format.
    fn npy(vectors: &[[f32; 3]]) -> Vec<u8> {
        let header = format!(
            "{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, 3), }}",
            vectors.len()
        );
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(vectors.iter().flatten().flat_map(|c| c.to_le_bytes()));
        bytes
    }

    #[test]
    fn velocities_are_read_from_the_file_beside() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let (x, v) = ([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], [[0.5, 0.0, -1.0], [0.0, 7.0, 0.0]]);
        std::fs::write(at("X_0001.npy"), npy(&x)).unwrap();
        std::fs::write(at("V_0001.npy"), npy(&v)).unwrap();
        std::fs::write(at("pos_2.npy"), npy(&x)).unwrap();
        std::fs::write(at("vel_2.npy"), npy(&v[..1])).unwrap();
        let read = |name: &str| {
            let mut particles = particles::read(&at(name)).unwrap();
            add(&mut particles, &at(name), None);
            particles
        };
        let found = read("X_0001.npy");
        assert_eq!((found.positions, found.velocities), (x.to_vec(), Some(v.to_vec())));
        let short = read("pos_2.npy");
        assert!(short.velocities.is_none() && short.warnings[0].contains("vel_2.npy has 1"));
        assert!(read("V_0001.npy").warnings[0].contains("these are velocities"));
    }
}
