//! Meanings of attribute names, in the spellings of different programs.
//!
//! Case, blanks, `_ - . :` and units in brackets are ignored: `Pos.x [m]`, `pos_x` and `PosX` are one name.
//! Components are `x y z`, numbers from 0 or 1, `i j k` or, of long names, `u v w`, bare or in brackets: `Points:0`,
//! `v_1`, `velocity[2]`, `Velocity[i]`, `Velocity u`. A prefix `particle` or `part` is ignored: `Part id`,
//! `particle_velocity_x`; before vectors also `Track: Parcel` and `Translational`.

use std::collections::HashSet;
use std::sync::LazyLock;

/// Plain names with one meaning, in order of preference.
pub(super) type Names = &'static [&'static str];

pub(super) const POSITION: Names = &[
    "position",
    "positions",
    "pos",
    "points",
    "point",
    "coordinates",
    "coordinate",
    "coords",
    "coord",
    "location",
    "locations",
    "xyz",
    "x",
    "xp",
    "p",
    "r",
];
pub(super) const VELOCITY: Names = &[
    "velocity",
    "velocities",
    "vel",
    "vels",
    "velo",
    "linearvelocity",
    "linvel",
    "linvelvec",
    "v",
    "vp",
    "pv",
    "u",
    "speed",
    "geschwindigkeit",
    "geschw",
    "vitesse",
    "velocidad",
];
/// Names of vectors that often mean something else, such as a momentum, a radius or a displacement.
pub(super) const VAGUE: Names = &["p", "r", "u"];
/// Names of components of velocities that by themselves often mean something else, such as texture coordinates.
pub(super) const BARE: [&str; 3] = ["u", "v", "w"];
pub(super) const DENSITY: Names =
    &["density", "densities", "rho", "rhop", "dens", "massdensity", "ρ", "crho"];
pub(super) const ID: Names = &[
    "id",
    "ids",
    "idp",
    "pid",
    "pids",
    "gid",
    "gids",
    "globalid",
    "globalids",
    "uid",
    "identifier",
    "originalparticleid",
    "originalid",
    "origid",
    "index",
    "particlenumber",
    "particleindex",
    "atomid",
    "label",
    "nodenumber",
    "particle",
];
/// The time that a particle has left, or in all if its age is there too.
pub(super) const LIFETIME: Names = &["lifetime"];
/// The time that a particle may live in all, as in Houdini.
pub(super) const LIFE: Names = &["life"];
pub(super) const AGE: Names = &["age", "ages"];
pub(super) const KIND: Names = &["type"];
/// Names that mark copies of particles of another piece.
pub(super) const GHOST: Names =
    &["vtkghosttype", "vtkghostlevels", "vtkghosttypeofcells", "vtkghostlevelsofcells"];
/// Suffix that is added to the name of a ghost attribute if its values belong to cells instead of points.
pub(super) const OF_CELLS: &str = " of cells";
/// Names of the time or step of a particle, in files with several frames. Times come first, because a step number does
/// not tell how much time passes from frame to frame.
pub(super) const STEP: Names = &[
    "time",
    "timevalue",
    "simtime",
    "simulationtime",
    "physicaltime",
    "currenttime",
    "elapsedtime",
    "zeit",
    "tiempo",
    "timestep",
    "step",
    "frame",
    "frameid",
    "frameno",
    "framenr",
    "framenumber",
    "frameindex",
    "stepno",
    "stepnumber",
    "nstep",
    "tstep",
    "timestepnumber",
    "iteration",
    "iter",
    "cycle",
    "snapshot",
    "timestamp",
    "currentstep",
    "temps",
    "tempo",
    "t",
    "ts",
    "it",
    "output",
];
/// Those of them that often mean something else, such as a temperature or a tag. They count only if their values look
/// like the times of frames.
const UNSURE_STEP: Names = &["t", "ts", "it", "output", "temps", "tempo"];

/// Names to suggest in the error if there are no positions.
pub(super) const POSITION_NAMES: &str = "`position`, `positions`, `pos`, `points` or `x` with 3 components, or `x` `y` `z`, `Points:0` `Points:1` `Points:2`";

/// Suffixes of the components of a vector.
const SUFFIXES: [[&str; 3]; 5] =
    [["x", "y", "z"], ["0", "1", "2"], ["1", "2", "3"], ["i", "j", "k"], ["u", "v", "w"]];
/// Whether a text in brackets names a component.
pub(super) fn is_suffix(text: &str) -> bool {
    SUFFIXES.iter().any(|suffixes| suffixes.contains(&text.to_ascii_lowercase().as_str()))
}

/// Words before the name of a vector that are ignored.
const WORDS: [&str; 7] =
    ["particles", "particle", "parcel", "part", "track", "translational", "linear"];

/// The plain form of a name, without the parts that are ignored.
pub(super) fn plain(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let behind = rest.get(first.len_utf8()..).unwrap_or_default();
        let closing = match first {
            '[' => ']',
            '(' => ')',
            '{' => '}',
            _ => {
                // Houdini's `@id`, or the type prefix in `v@P`.
                let marked = first == '@' && out.is_empty();
                if !marked && !first.is_whitespace() && !"_-.:\"'#`".contains(first) {
                    out.extend(first.to_lowercase());
                }
                rest = behind;
                continue;
            }
        };
        let (inner, behind) = behind.split_once(closing).unwrap_or((behind, ""));
        let inner = inner.trim().to_ascii_lowercase();
        // A unit, unless it names a component.
        if !out.is_empty() && is_suffix(&inner) {
            out.push_str(&inner);
        }
        rest = behind;
    }
    // A prefix such as `particle` carries no meaning.
    let of_particle = ["particles", "particle", "parcel", "part"].iter();
    let stripped = of_particle.filter_map(|word| out.strip_prefix(word)).find(|rest| known(rest));
    match stripped.or_else(|| vector_behind(&out)) {
        Some(rest) => rest.to_string(),
        None => out,
    }
}

/// The name of a vector or component, after words that are ignored.
fn vector_behind(name: &str) -> Option<&str> {
    let rest = WORDS.iter().find_map(|word| name.strip_prefix(word))?;
    let vector = [POSITION, VELOCITY].iter().any(|names| {
        let mut long = names.iter().filter(|base| base.len() > 2);
        long.any(|base| {
            let end = rest.strip_prefix(base);
            end.is_some_and(|end| {
                end.is_empty() || SUFFIXES.iter().any(|suffixes| suffixes.contains(&end))
            })
        })
    });
    if vector { Some(rest) } else { vector_behind(rest) }
}

/// The plain names of three scalars that form a position, and of those that form a velocity.
static TRIPLES: LazyLock<[Vec<[String; 3]>; 2]> =
    LazyLock::new(|| [POSITION, VELOCITY].map(|names| all_triples(names).collect()));
/// Names of single components of positions, and of velocities.
static COMPONENTS: LazyLock<[HashSet<&str>; 2]> = LazyLock::new(|| {
    TRIPLES.each_ref().map(|triples| triples.iter().flatten().map(String::as_str).collect())
});

/// The plain names of three scalars that form a vector, which is a position or a velocity.
pub(super) fn triples(names: Names) -> &'static [[String; 3]] {
    let [positions, velocities] = &*TRIPLES;
    if names == POSITION { positions } else { velocities }
}

fn all_triples(names: Names) -> impl Iterator<Item = [String; 3]> {
    let position = names == POSITION;
    let bare = std::iter::once("").filter(move |_| position);
    let split = bare.chain(names.iter().copied()).flat_map(move |base| {
        let suffixes = SUFFIXES.iter().filter(move |[first, ..]| match base {
            "" => *first == "x",
            // `xx` is a component of a tensor, whereas `x_0 x_1 x_2` is a position.
            "x" | "xp" | "xyz" if *first == "x" => false,
            // `ui` could have any meaning.
            _ => !matches!(*first, "i" | "u") || base.len() > 2,
        });
        suffixes.map(move |suffixes| suffixes.map(|suffix| format!("{base}{suffix}")))
    });
    // An axis before a long name counts (`X_vel`, `x-coordinate`), before a short name it does not, because
    // such names have other meanings.
    let long = names.iter().copied().filter(|base| base.len() > 2);
    let before = long.map(|base| ["x", "y", "z"].map(|axis| format!("{axis}{base}")));
    let own: &[[&str; 3]] = match position {
        true => &[["easting", "northing", "elevation"], ["easting", "northing", "height"]],
        false if names == VELOCITY => {
            &[["u", "v", "w"], ["xdot", "ydot", "zdot"], ["dx/dt", "dy/dt", "dz/dt"]]
        }
        false => &[],
    };
    split.chain(before).chain(own.iter().map(|names| names.map(String::from)))
}

/// Whether a plain name has a meaning.
pub(super) fn known(name: &str) -> bool {
    [POSITION, VELOCITY, DENSITY, ID, LIFETIME, LIFE, AGE, KIND, GHOST, STEP]
        .iter()
        .any(|names| names.contains(&name))
        || COMPONENTS.iter().any(|components| components.contains(name))
}

/// Whether an attribute with this name is a vector.
pub(super) fn is_vector(name: &str) -> bool {
    let plain = plain(name);
    POSITION.contains(&plain.as_str()) || VELOCITY.contains(&plain.as_str())
}

/// Whether an attribute with this name marks ghosts.
pub(super) fn is_ghost(name: &str) -> bool {
    GHOST.contains(&plain(name).as_str())
}

/// Whether this is the name of positions.
pub(super) fn is_position(name: &str) -> bool {
    POSITION.contains(&plain(name).as_str())
}

/// Whether this is the name of one component of positions.
pub(super) fn is_component(name: &str) -> bool {
    let [positions, _] = &*COMPONENTS;
    positions.contains(plain(name).as_str())
}

/// Whether this is the name of a list of times.
pub(super) fn is_time(name: &str) -> bool {
    time_rank(name).is_some()
}

/// How well a name fits a frame's time, or a list of times: lower is better, and times come before step numbers. `None`
/// if it is no such name.
pub(super) fn time_rank(name: &str) -> Option<usize> {
    let plain = plain(name);
    let name = match plain.as_str() {
        "times" => "time",
        "timesteps" => "timestep",
        "steps" => "step",
        // A value per frame, unlike one per particle, is no temperature.
        "t" => "tiempo",
        name => name,
    };
    STEP.iter().position(|step| *step == name)
}

/// Whether some of these names denote positions, either as a vector or as two or three components.
pub(super) fn may_have_positions<N: AsRef<str>>(names: &[N]) -> bool {
    let whole = |name: &N| POSITION.contains(&plain(name.as_ref()).as_str());
    names.iter().any(whole) || have_positions(names)
}

/// Whether an attribute with this name may be text: a kind, an id, a time or an age, all of which are dropped if they
/// are no numbers, or an unknown one.
pub(super) fn may_be_text(name: &str) -> bool {
    let plain = plain(name);
    [KIND, ID, STEP, AGE, LIFE].iter().any(|names| names.contains(&plain.as_str()))
        || !known(&plain)
}

/// Whether the name of a time or step often means something else.
pub(super) fn is_unsure_step(name: &str) -> bool {
    UNSURE_STEP.contains(&plain(name).as_str())
}

/// Whether columns with these names contain positions, in two dimensions at least. This distinguishes a line
/// of names from other lines.
pub(super) fn have_positions<N: AsRef<str>>(names: &[N]) -> bool {
    let plain: Vec<String> = names.iter().map(|name| plain(name.as_ref())).collect();
    let found = |names: &[String; 3]| names.iter().filter(|name| plain.contains(name)).count() > 1;
    triples(POSITION).iter().any(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_name_in_many_spellings() {
        for (name, expected) in [
            ("Pos.x [m]", "posx"),
            ("  \"Vel.z [m/s]\" ", "velz"),
            ("Points:0", "points0"),
            ("Points_2", "points2"),
            ("velocity[1] (m/s)", "velocity1"),
            ("velocity (x)", "velocityx"),
            ("Vel [m/s]:0", "vel0"),
            ("v_1", "v1"),
            ("X (m)", "x"),
            ("Rhop [kg/m^3]", "rhop"),
            ("OriginalParticle_ID", "originalparticleid"),
            ("Part id", "id"),
            ("particle_position_x", "positionx"),
            ("Particle Type", "type"),
            ("PART", "part"),
            ("particle_flags", "particleflags"),
            ("Track: Parcel Velocity[k] (m/s)", "velocityk"),
            ("Particle : Translational Velocity : X [m/s]", "velocityx"),
            ("Velocity u [ m s^-1 ]", "velocityu"),
            ("Parcel Temperature", "parceltemperature"),
            ("Linear Density", "lineardensity"),
            ("@id", "id"),
            ("[m]", ""),
            ("x[", "x"),
            ("Vitesse (\u{b5}m/s)", "vitesse"),
        ] {
            assert_eq!(plain(name), expected, "{name}");
        }
    }

    #[test]
    fn times_rank_before_steps() {
        for (time, step) in [
            ("time", "step"),
            ("time", "TimeStep"),
            ("times", "steps"),
            ("t", "frame"),
            ("t", "timestep"),
            ("sim_time", "iteration"),
            ("TimeValue", "cycle"),
        ] {
            assert!(time_rank(time) < time_rank(step), "{time} {step}");
            assert!(is_time(time) && is_time(step));
        }
        assert_eq!(time_rank("dt"), None);
    }

    #[test]
    fn what_is_wanted() {
        for name in [
            "U",
            "u",
            "v_3",
            "v_0",
            "Idp",
            "origId",
            "Rhop",
            "Part id",
            "ux",
            "VX",
            "w",
            "X_vel",
            "y-coordinate",
            "rz",
            "Northing",
            "Speed_Y",
            "Velocity[j]",
            "velocity w",
            "Track: Parcel Velocity[i] (m/s)",
            "c_rho",
            "linVelVec",
            "particle_age",
        ] {
            assert!(known(&plain(name)), "{name}");
        }
        for name in [
            "xx",
            "d",
            "PART",
            "mass",
            "nx",
            "Points_Magnitude",
            "v_4",
            "v_mag",
            "",
            "nage",
            "ui",
            "pw",
        ] {
            assert!(!known(&plain(name)), "{name}");
        }
    }
}
