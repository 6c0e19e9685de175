//! The gallery: ten pictures with default settings, of our own scenes and of public caches, and the page that shows
//! them.

use std::fmt::Write;
use std::path::Path;

use crate::Outcome;
use crate::panels::save;
use crate::tool::{Tool, sequence};

/// Subject of a picture.
enum Of {
    /// A frame of one of our own scenes.
    Scene(&'static str, u32),
    /// A file in the folder of public caches, and further arguments.
    Cache(&'static str, &'static str),
}

/// A picture of the gallery.
struct Shown {
    /// Name of its file, without the extension.
    name: &'static str,
    of: Of,
    /// Caption: subject and source of the data.
    about: &'static str,
}

const SPLISHSPLASH: &str =
    "[SPlisHSPlasH](https://github.com/InteractiveComputerGraphics/SPlisHSPlasH) (MIT), DFSPH";

const ALL: [Shown; 10] = [
    Shown {
        name: "waterfall",
        of: Of::Scene("waterfall", 240),
        about: "A chute pours into a basin, past a pillar; own scene",
    },
    Shown {
        name: "corridor",
        of: Of::Scene("corridor", 120),
        about: "A gate floods a corridor of obstacles; own scene",
    },
    Shown {
        name: "bamboo",
        of: Of::Scene("bamboo", 200),
        about: "A bamboo pipe tips into a bowl; own scene",
    },
    Shown {
        name: "pillar",
        of: Of::Cache("double_dam_pillar/ParticleData_Fluid_46.bgeo", ""),
        about: "Two columns of water meet at a pillar; 27 528 particles of {splishsplash}",
    },
    Shown {
        name: "pillar-foam",
        of: Of::Cache(
            "double_dam_pillar/ParticleData_Fluid_52.bgeo",
            "--whitewater {caches}/double_dam_pillar/foam/foam_52.bgeo",
        ),
        about: "The same later, with the whitewater of its FoamGenerator",
    },
    Shown {
        name: "inflow",
        of: Of::Cache("inflow/ParticleData_Fluid_130.bgeo", ""),
        about: "Two jets fill a tank; {splishsplash}",
    },
    Shown {
        name: "dam",
        of: Of::Cache("big_dam/ParticleData_Fluid_46.bgeo", ""),
        about: "A dam breaks over a thin layer of water; 139 995 particles of {splishsplash}",
    },
    Shown {
        name: "double-dam",
        of: Of::Cache("double_dam_small/ParticleData_Fluid_20.bgeo", ""),
        about: "The stock double dam break; 4732 particles of {splishsplash}",
    },
    Shown {
        name: "splashsurf",
        of: Of::Cache("splashsurf/dam_break_frame_23_24389_particles.bgeo", ""),
        about: "A dam break, positions only; a file of \
                [splashsurf](https://github.com/InteractiveComputerGraphics/splashsurf) (MIT)",
    },
    Shown {
        name: "spheric",
        of: Of::Cache("pysph/spheric2_fluid_01180.vtu", "--up-axis z"),
        about: "SPHERIC's benchmark 2, a dam break on a box; [PySPH](https://github.com/pypr/pysph) (BSD), WCSPH",
    },
];

/// Draws all pictures, or one, into the folder `gallery` of the documents, and writes the page.
pub fn draw(tool: &Tool, docs: &Path, public: &Path, only: Option<&str>) -> Outcome<()> {
    let wanted: Vec<_> = ALL.iter().filter(|s| only.is_none_or(|only| only == s.name)).collect();
    if wanted.is_empty() {
        let names: Vec<_> = ALL.iter().map(|shown| shown.name).collect();
        return Err(format!("there is no such picture; there are {}", names.join(", ")));
    }
    let cannot = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    let folder = docs.join("gallery");
    std::fs::create_dir_all(&folder).map_err(|error| cannot(&folder, error))?;
    for shown in wanted {
        eprintln!("figures: gallery, {}", shown.name);
        let arguments = arguments(tool, shown, public)?;
        let png = tool.temporary("gallery.png");
        let picture = tool.draw(&arguments, &png)?;
        save(&picture, &folder.join(format!("{}.jpg", shown.name)))?;
    }
    let file = docs.join("gallery.md");
    std::fs::write(&file, page()).map_err(|error| cannot(&file, error))
}

/// Arguments that draw a picture, without the output path.
fn arguments(tool: &Tool, shown: &Shown, public: &Path) -> Outcome<Vec<String>> {
    match shown.of {
        Of::Scene(scene, frame) => {
            let folder = tool.scene(scene)?;
            Ok(vec![
                sequence(&folder, scene),
                format!("--frames={frame}"),
                format!("--scene={}", folder.join("scene.json").display()),
                format!("--camera={}", folder.join("camera.json").display()),
                "--set=pool".into(),
            ])
        }
        Of::Cache(file, more) => {
            let path = public.join(file);
            if !path.exists() {
                return Err(format!("--public: {} is not there", path.display()));
            }
            let public = public.display().to_string();
            let more = more.split_whitespace().map(|word| word.replace("{caches}", &public));
            Ok(std::iter::once(path.display().to_string()).chain(more).collect())
        }
    }
}

/// Text of the page.
fn page() -> String {
    let mut text = String::from(
        "# Gallery\n\nTen pictures with the default settings. The command below a picture draws this picture. The following commands draw all ten:\n\n```sh\n\
         cargo build --release -p whitewater-cli -p whitewater-figures\n\
         target/release/whitewater-figures --caches DIR --gallery --public CACHES\n```\n\n\
         DIR holds the project's own scenes (`whitewater simulate`), CACHES the public ones under the names below.\n",
    );
    for Shown { name, of, about } in &ALL {
        let about = about.replace("{splishsplash}", SPLISHSPLASH);
        let command = match of {
            Of::Scene(scene, frame) => format!(
                "'DIR/{scene}/{scene}_%04d.bgeo' --frames {frame} --scene DIR/{scene}/scene.json --camera DIR/{scene}/camera.json --set pool"
            ),
            Of::Cache(file, more) => {
                format!("CACHES/{file} {}", more.replace("{caches}", "CACHES"))
            }
        };
        let command = command.trim();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "\n## {about}\n\n![{name}](gallery/{name}.jpg)\n\n`whitewater render {command} -o {name}.png`\n"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_shows_all() {
        let text = page();
        for shown in &ALL {
            assert_eq!(text.matches(&format!("(gallery/{}.jpg)", shown.name)).count(), 1, "{text}");
        }
        assert!(!text.contains('{') && !text.contains("  "), "{text}");
        let names: std::collections::BTreeSet<_> = ALL.iter().map(|shown| shown.name).collect();
        assert_eq!(names.len(), ALL.len());
    }
}
