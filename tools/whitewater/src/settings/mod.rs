//! Settings from TOML and back. Every value is optional.

mod bubbles;
pub mod generate;
mod medium;
mod renamed;
pub mod shore;
mod table;
mod water;
mod whitewater_table;

use std::path::Path;

use serde::{Deserialize, Serialize};
use whitewater::GeneratorSettings;
use whitewater::water::Shadows;
use whitewater::water::WeberSettings;
use whitewater::{Light, Settings};

use crate::args::DrawArgs;
use crate::failure::{Failure, Outcome};

pub use medium::{MediumName, take_back};
#[cfg(test)]
pub use water::Weber;
pub use water::{FoamBy, SurfaceFoamTable};

/// The settings file.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct SettingsFile {
    /// The preset that the tables modify.
    pub look: Option<LookWord>,
    pub water: water::WaterTable,
    pub ellipsoids: water::EllipsoidTable,
    pub wavelets: water::WaveletTable,
    pub surface_foam: water::SurfaceFoamTable,
    pub spray: water::SprayTable,
    pub whitewater: whitewater_table::WhitewaterTable,
    pub bubbles: bubbles::BubbleTable,
    pub generate: generate::GenerateTable,
    pub shore: shore::ShoreTable,
    pub shoreline: shore::ShorelineTable,
    pub contact: shore::ContactTable,
    pub shadow: water::ShadowTable,
    pub noise: water::NoiseTable,
    pub light: water::LightTable,
}

/// A preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum LookWord {
    /// The defaults of this program.
    Default,
    /// The look of the thesis' demo.
    Thesis,
}

/// Settings that were found for a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found<'a> {
    /// Settings of foam formation.
    pub foam: Option<&'a WeberSettings>,
    /// Settings of the whitewater emission, and the max number of particles.
    pub generate: Option<&'a (GeneratorSettings, u32)>,
    /// Whether only the water was drawn, on a transparent background.
    pub matte: bool,
}

impl SettingsFile {
    /// Reads a file.
    pub fn read(path: &Path) -> Outcome<Self> {
        let text = std::fs::read_to_string(path).map_err(|e| Failure::reading(path, &e))?;
        Self::parse(&text).map_err(|why| Failure::input(format!("{}: {why}", path.display())))
    }

    /// Files that the settings name.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let named = [&self.shore.web, &self.shore.strip, &self.contact.mask_picture];
        named.into_iter().filter_map(|path| path.as_deref())
    }

    fn parse(text: &str) -> Result<Self, String> {
        if let Some(why) = renamed::find(text) {
            return Err(why);
        }
        toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(0, |span| {
                text.get(..span.start).unwrap_or_default().matches('\n').count() + 1
            });
            format!("line {line}: {}", one_line(error.message()))
        })
    }

    /// The file of `--settings`, with the preset of `--look`.
    pub fn of_args(args: &DrawArgs) -> Outcome<Self> {
        let file = args.settings.as_deref().map(Self::read).transpose()?.unwrap_or_default();
        let mut water = file.water;
        if let Some(name) = args.medium {
            water.medium = Some(water::MediumTable::Named(name));
        }
        if let Some(other) = file.surface_foam.turbulence.filter(|t| !(0.0..=1.0).contains(t)) {
            let why = format!("[surface_foam] turbulence: expected 0 to 1, found {other}");
            return Err(Failure::input(why));
        }
        Ok(Self { look: args.look.or(file.look), water, ..file })
    }

    /// Whether the preset is the thesis.
    pub fn is_thesis(&self) -> bool {
        self.look == Some(LookWord::Thesis)
    }

    /// The settings of the preset, for particles of this spacing in this light.
    pub fn look(&self, spacing: f32, light: Light) -> Settings {
        let light = self.in_light(light);
        if self.is_thesis() {
            return Settings::thesis(spacing).with(|it| it.light = light);
        }
        Settings::new(spacing, 1.0).with_light(light)
    }

    /// The light, changed by the preset.
    pub fn in_light(&self, light: Light) -> Light {
        if self.is_thesis() { light.thesis() } else { light }
    }

    /// Filter of the scene's shadow map.
    pub fn shadows(&self) -> Shadows {
        self.shadow.passes(self.is_thesis())
    }

    /// Applies the file to settings.
    pub fn apply(&self, settings: &mut Settings) {
        if let Some(liquid) = self.water.liquid() {
            liquid.put(settings);
        }
        self.water.apply(&mut settings.water);
        self.ellipsoids.put(&mut settings.water.ellipsoids);
        self.wavelets.put(&mut settings.water.wavelets);
        self.surface_foam.put(&mut settings.surface_foam);
        self.spray.put(&mut settings.spray);
        self.whitewater.put(&mut settings.whitewater);
        self.bubbles.apply(&mut settings.bubbles);
        self.shore.put(&mut settings.shore);
        self.shoreline.put(&mut settings.shore.shoreline);
        self.contact.put(&mut settings.shore.contact);
        self.shadow.put(&mut settings.shadow);
        self.noise.put(&mut settings.noise);
        self.light.put(&mut settings.light);
    }

    /// The settings file `self` with a value for every key. Keys that are part of the library's [`Settings`] get the
    /// value in `settings`; those of foam formation and whitewater emission the value that was `found` for the run.
    /// The others, such as those that configure passes, keep the value of `self`, or that of its preset where `self`
    /// has none.
    pub fn all(&self, settings: &Settings, found: Found<'_>) -> Self {
        // Two fields are not keys: `up`, because the program's scenes are y-up, and `debug_view`, which follows from the
        // layers that are written.
        let Settings {
            water,
            surface_foam,
            spray,
            whitewater,
            bubbles,
            shore,
            shadow,
            noise,
            light,
            ..
        } = settings;
        Self {
            look: self.look,
            water: self.water.all(water, self.is_thesis(), found.matte),
            ellipsoids: water::EllipsoidTable::of(&water.ellipsoids),
            wavelets: water::WaveletTable::of(&water.wavelets),
            surface_foam: self.surface_foam.all(surface_foam, found.foam),
            spray: water::SprayTable::of(spray),
            whitewater: self.whitewater.all(whitewater),
            bubbles: self.bubbles.all(bubbles),
            generate: found.generate.map_or_else(
                || self.generate.clone(),
                |(settings, most)| generate::GenerateTable::all(settings, *most),
            ),
            shore: self.shore.all(shore),
            shoreline: shore::ShorelineTable::of(&shore.shoreline),
            contact: self.contact.all(&shore.contact),
            shadow: self.shadow.all(shadow, self.is_thesis()),
            noise: water::NoiseTable::of(noise),
            light: water::LightTable::of(light),
        }
    }

    /// The file as TOML.
    pub fn text(&self) -> Result<String, String> {
        toml::to_string(self).map_err(|error| error.to_string())
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests;
