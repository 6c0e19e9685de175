//! Settings from TOML: a mirror of `whitewater::Settings` in which every value may be left out.

mod bubbles;
mod diffuse;
pub mod generate;
pub mod shore;

use std::path::Path;

use serde::Deserialize;
use whitewater::Settings;
use whitewater::water::settings::{
    Amplitude, Convolution, Fresnel, Medium, Shadows, WaterSettings,
};

use crate::failure::{Failure, Outcome};

/// The file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SettingsFile {
    pub water: WaterTable,
    pub foam: FoamTable,
    pub spray: SprayTable,
    pub diffuse: diffuse::DiffuseTable,
    pub bubbles: bubbles::BubbleTable,
    pub generate: generate::GenerateTable,
    pub shore: shore::ShoreTable,
    pub shoreline: shore::ShorelineTable,
    pub contact: shore::ContactTable,
    pub shadow: ShadowTable,
    pub noise: NoiseTable,
    pub light: LightTable,
}

/// Table `[water]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WaterTable {
    pub spacing: Option<f32>,
    pub rest_density: Option<f32>,
    density_threshold: Option<f32>,
    density_full: Option<f32>,
    smoothing_width: Option<f32>,
    depth_falloff: Option<f32>,
    amplitude: Option<String>,
    medium: Option<toml::Value>,
    fresnel: Option<toml::Value>,
    refraction: Option<f32>,
    specular: Option<f32>,
    shininess: Option<f32>,
}

/// Table `[foam]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FoamTable {
    extinction: Option<f32>,
    front_extinction: Option<f32>,
    front_depth: Option<f32>,
    motion_threshold: Option<f32>,
    noise: Option<f32>,
    noise_rate: Option<f32>,
    pattern: Option<f32>,
    pattern_size: Option<f32>,
    pattern_period: Option<f32>,
    front_power: Option<f32>,
    veil: Option<f32>,
    relief: Option<f32>,
    shadow: Option<f32>,
    back_color: Option<[f32; 3]>,
    front_color: Option<[f32; 3]>,
}

/// Table `[spray]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SprayTable {
    opacity: Option<f32>,
    size: Option<f32>,
    droplets: Option<u32>,
    densities: Option<[f32; 3]>,
    spread: Option<f32>,
    shutter: Option<f32>,
    color: Option<[f32; 3]>,
    additive: Option<bool>,
}

/// Table `[shadow]`: of the scene's shadow map. The first four choose the passes.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShadowTable {
    filter: Option<String>,
    terms: Option<u32>,
    texels: Option<u32>,
    bits: Option<u32>,
    width: Option<f32>,
    damping: Option<f32>,
    offset: Option<f32>,
    scale: Option<f32>,
}

/// Table `[noise]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NoiseTable {
    weight: Option<f32>,
    falloff: Option<f32>,
    size: Option<f32>,
    cells: Option<f32>,
    foam: Option<f32>,
    color: Option<[f32; 3]>,
}

/// Table `[light]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightTable {
    pub direction: Option<[f32; 3]>,
    pub color: Option<[f32; 3]>,
    pub ambient: Option<[f32; 3]>,
    pub irradiance: Option<[f32; 3]>,
    pub shade: Option<[f32; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Physical {
    absorption: [f32; 3],
    scattering: [f32; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Source {
    base: [f32; 3],
    falloff: [f32; 4],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Schlick {
    f0: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Biased {
    bias: f32,
    scale: f32,
    power: f32,
}

impl SettingsFile {
    /// Reads a file.
    pub fn read(path: &Path) -> Outcome<Self> {
        let text = std::fs::read_to_string(path).map_err(|e| Failure::reading(path, &e))?;
        Self::parse(&text).map_err(|why| Failure::input(format!("{}: {why}", path.display())))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let file: Self = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(0, |span| {
                text.get(..span.start).unwrap_or_default().matches('\n').count() + 1
            });
            format!("line {line}: {}", one_line(error.message()))
        })?;
        // Found out now, not when the first frame is drawn.
        file.apply(&mut Settings::default())?;
        file.shadows()?;
        Ok(file)
    }

    /// How the scene's shadow map is filtered.
    pub fn shadows(&self) -> Result<Shadows, String> {
        let table = &self.shadow;
        let Convolution { terms, texels, bits } = Convolution::default();
        match table.filter.as_deref() {
            None | Some("pcf") => Ok(Shadows::Map),
            Some("convolution") => Ok(Shadows::Convolution(Convolution {
                terms: table.terms.unwrap_or(terms),
                texels: table.texels.unwrap_or(texels),
                bits: table.bits.unwrap_or(bits),
            })),
            Some(other) => {
                Err(format!("shadow.filter: expected pcf or convolution, found '{other}'"))
            }
        }
    }

    /// Puts what the file says over settings.
    pub fn apply(&self, settings: &mut Settings) -> Result<(), String> {
        let set = |to: &mut f32, from: Option<f32>| *to = from.unwrap_or(*to);
        let (water, table) = (&mut settings.water, &self.water);
        set(&mut water.spacing, table.spacing);
        set(&mut water.rest_density, table.rest_density);
        set(&mut water.density_threshold, table.density_threshold);
        set(&mut water.density_full, table.density_full);
        set(&mut water.smoothing_width, table.smoothing_width);
        set(&mut water.depth_falloff, table.depth_falloff);
        set(&mut water.refraction, table.refraction);
        set(&mut water.specular, table.specular);
        set(&mut water.shininess, table.shininess);
        match table.amplitude.as_deref() {
            None => {}
            Some("volume") => water.amplitude = Amplitude::Volume,
            Some("source") => water.amplitude = Amplitude::Source,
            Some(other) => {
                return Err(format!("water.amplitude: expected volume or source, found '{other}'"));
            }
        }
        if let Some(value) = &table.medium {
            water.medium = medium(value, water)?;
        }
        if let Some(value) = &table.fresnel {
            water.fresnel = fresnel(value)?;
        }
        self.shoreline.apply(&mut settings.shore.shoreline)?;
        self.contact.apply(&mut settings.shore.contact);
        settings.shore.period = self.shore.period.or(settings.shore.period);
        let (foam, table) = (&mut settings.foam, &self.foam);
        set(&mut foam.extinction, table.extinction);
        set(&mut foam.front_extinction, table.front_extinction);
        set(&mut foam.front_depth, table.front_depth);
        set(&mut foam.motion_threshold, table.motion_threshold);
        set(&mut foam.noise, table.noise);
        set(&mut foam.noise_rate, table.noise_rate);
        set(&mut foam.pattern, table.pattern);
        set(&mut foam.pattern_size, table.pattern_size);
        set(&mut foam.pattern_period, table.pattern_period);
        set(&mut foam.front_power, table.front_power);
        set(&mut foam.veil, table.veil);
        set(&mut foam.relief, table.relief);
        set(&mut foam.shadow, table.shadow);
        foam.back_color = table.back_color.unwrap_or(foam.back_color);
        foam.front_color = table.front_color.unwrap_or(foam.front_color);
        let (spray, table) = (&mut settings.spray, &self.spray);
        set(&mut spray.opacity, table.opacity);
        set(&mut spray.size, table.size);
        spray.droplets = table.droplets.unwrap_or(spray.droplets);
        spray.densities = table.densities.unwrap_or(spray.densities);
        set(&mut spray.spread, table.spread);
        set(&mut spray.shutter, table.shutter);
        spray.color = table.color.unwrap_or(spray.color);
        spray.additive = table.additive.unwrap_or(spray.additive);
        self.diffuse.apply(&mut settings.diffuse);
        self.bubbles.apply(&mut settings.bubbles);
        let (shadow, table) = (&mut settings.shadow, &self.shadow);
        set(&mut shadow.width, table.width);
        set(&mut shadow.damping, table.damping);
        set(&mut shadow.offset, table.offset);
        set(&mut shadow.scale, table.scale);
        let (noise, table) = (&mut settings.noise, &self.noise);
        set(&mut noise.weight, table.weight);
        set(&mut noise.falloff, table.falloff);
        set(&mut noise.size, table.size);
        set(&mut noise.cells, table.cells);
        set(&mut noise.foam, table.foam);
        noise.color = table.color.unwrap_or(noise.color);
        let light = &mut settings.light;
        light.direction = self.light.direction.unwrap_or(light.direction);
        light.color = self.light.color.unwrap_or(light.color);
        light.ambient = self.light.ambient.unwrap_or(light.ambient);
        light.irradiance = self.light.irradiance.unwrap_or(light.irradiance);
        light.shade = self.light.shade.unwrap_or(light.shade);
        Ok(())
    }
}

fn medium(value: &toml::Value, water: &WaterSettings) -> Result<Medium, String> {
    let expected = "water.medium: expected clear, pool, ocean, milk, source, \
                    {absorption=[r,g,b], scattering=[r,g,b]} or {base=[r,g,b], falloff=[r,g,b,a]}";
    if let Some(name) = value.as_str() {
        return Ok(match name {
            "clear" => Medium::CLEAR,
            "pool" => Medium::POOL,
            "ocean" => Medium::OCEAN,
            "milk" => Medium::MILK,
            "source" => Medium::source(water.spacing),
            _ => return Err(format!("{expected}, found '{name}'")),
        });
    }
    if value.get("base").is_some() {
        let Source { base, falloff } = table(value, expected)?;
        Ok(Medium::Source { base, falloff })
    } else {
        let Physical { absorption, scattering } = table(value, expected)?;
        Ok(Medium::Physical { absorption, scattering })
    }
}

fn fresnel(value: &toml::Value) -> Result<Fresnel, String> {
    let expected = "water.fresnel: expected {f0=0.02} or {bias=0.1, scale=0.4, power=2}";
    if value.get("f0").is_some() {
        let Schlick { f0 } = table(value, expected)?;
        Ok(Fresnel::Schlick { f0 })
    } else {
        let Biased { bias, scale, power } = table(value, expected)?;
        Ok(Fresnel::Source { bias, scale, power })
    }
}

fn table<T: serde::de::DeserializeOwned>(value: &toml::Value, expected: &str) -> Result<T, String> {
    value.clone().try_into().map_err(|e: toml::de::Error| {
        format!("{expected}, found something else: {}", one_line(e.message()))
    })
}

/// Settings as a file of them has it.
pub fn to_toml(settings: &Settings) -> String {
    let (water, light) = (&settings.water, &settings.light);
    let medium = match &water.medium {
        Medium::Physical { absorption, scattering } => {
            format!("{{ absorption = {absorption:?}, scattering = {scattering:?} }}")
        }
        Medium::Source { base, falloff } => {
            format!("{{ base = {base:?}, falloff = {falloff:?} }}")
        }
    };
    let fresnel = match &water.fresnel {
        Fresnel::Schlick { f0 } => format!("{{ f0 = {f0:?} }}"),
        Fresnel::Source { bias, scale, power } => {
            format!("{{ bias = {bias:?}, scale = {scale:?}, power = {power:?} }}")
        }
    };
    let amplitude = match water.amplitude {
        Amplitude::Volume => "volume",
        Amplitude::Source => "source",
    };
    let numbers = [
        ("spacing", water.spacing),
        ("rest_density", water.rest_density),
        ("density_threshold", water.density_threshold),
        ("density_full", water.density_full),
        ("smoothing_width", water.smoothing_width),
        ("depth_falloff", water.depth_falloff),
        ("refraction", water.refraction),
        ("specular", water.specular),
        ("shininess", water.shininess),
    ];
    let (foam, spray) = (&settings.foam, &settings.spray);
    let of_foam = [
        ("extinction", foam.extinction),
        ("front_extinction", foam.front_extinction),
        ("front_depth", foam.front_depth),
        ("motion_threshold", foam.motion_threshold),
        ("noise", foam.noise),
        ("noise_rate", foam.noise_rate),
        ("pattern", foam.pattern),
        ("pattern_size", foam.pattern_size),
        ("pattern_period", foam.pattern_period),
        ("front_power", foam.front_power),
        ("veil", foam.veil),
        ("relief", foam.relief),
        ("shadow", foam.shadow),
    ];
    let of_spray = [
        ("opacity", spray.opacity),
        ("size", spray.size),
        ("spread", spray.spread),
        ("shutter", spray.shutter),
    ];
    let shadow = &settings.shadow;
    let of_shadow = [
        ("width", shadow.width),
        ("damping", shadow.damping),
        ("offset", shadow.offset),
        ("scale", shadow.scale),
    ];
    let noise = &settings.noise;
    let of_noise = [
        ("weight", noise.weight),
        ("falloff", noise.falloff),
        ("size", noise.size),
        ("cells", noise.cells),
        ("foam", noise.foam),
    ];
    let lines = |numbers: &[(&str, f32)]| -> String {
        numbers.iter().map(|(name, v)| format!("{name} = {v:?}\n")).collect()
    };
    format!(
        "[water]\n{}amplitude = '{amplitude}'\nmedium = {medium}\nfresnel = {fresnel}\n\n\
         [foam]\n{}back_color = {:?}\nfront_color = {:?}\n\n\
         [spray]\n{}droplets = {}\ndensities = {:?}\ncolor = {:?}\nadditive = {}\n\n\
         {}\n\
         [shadow]\n{}\n\
         [noise]\n{}color = {:?}\n\n\
         [light]\ndirection = {:?}\ncolor = {:?}\nambient = {:?}\nirradiance = {:?}\nshade = {:?}\n",
        lines(&numbers),
        lines(&of_foam),
        foam.back_color,
        foam.front_color,
        lines(&of_spray),
        spray.droplets,
        spray.densities,
        spray.color,
        spray.additive,
        diffuse::to_toml(&settings.diffuse),
        lines(&of_shadow),
        lines(&of_noise),
        noise.color,
        light.direction,
        light.color,
        light.ambient,
        light.irradiance,
        light.shade,
    )
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitewater::foam::{DiffuseLook, Mixing, Reach, Submerged};
    use whitewater::water::{NoiseLook, SprayLook};

    #[test]
    fn values_arrive() {
        let text = "[water]\nspacing = 0.1\nmedium = 'source'\nfresnel = {f0 = 0.05}\n\
                    [light]\nambient = [1, 2.0, 3.0]";
        let file = SettingsFile::parse(&text.replace("[1,", "[1.0,")).unwrap();
        let mut settings = Settings::default();
        file.apply(&mut settings).unwrap();
        assert_eq!(settings.water.spacing, 0.1);
        assert_eq!(settings.water.medium, Medium::source(0.1));
        assert_eq!(settings.water.fresnel, Fresnel::Schlick { f0: 0.05 });
        assert_eq!(settings.light.ambient, [1.0, 2.0, 3.0]);
        assert_eq!(settings.light.color, Settings::default().light.color);
    }

    #[test]
    fn shadows_are_filtered_as_asked() {
        let of = |text: &str| SettingsFile::parse(text).unwrap().shadows().unwrap();
        assert_eq!(of("[shadow]\nwidth = 5.0"), Shadows::Map);
        let convolution = Convolution { terms: 8, ..Convolution::default() };
        let text = "[shadow]\nfilter = 'convolution'\nterms = 8";
        assert_eq!(of(text), Shadows::Convolution(convolution));
    }

    #[test]
    fn settings_go_out_and_come_back() {
        let mut settings = Settings::default();
        settings.water.medium = Medium::source(0.02);
        settings.water.shininess = 1.0e-7;
        settings.water.amplitude = Amplitude::Source;
        settings.foam.veil = 0.25;
        settings.foam.front_color = [0.1, 0.2, 0.3];
        settings.spray = SprayLook { size: 1.5, ..SprayLook::SOURCE };
        settings.diffuse = DiffuseLook {
            submerged: Submerged::Falloff { most: 0.3, n: 2.0, m: 4.0 },
            reach: Reach::Metres(5.0),
            mixing: Mixing::Source,
            samples: [8, 64],
            ..DiffuseLook::of_spacing(0.1)
        };
        settings.shadow.width = 7.5;
        settings.noise = NoiseLook { cells: 0.7, ..NoiseLook::SOURCE };
        settings.light.irradiance = [1.0, 2.0, 3.0];
        let mut back = Settings::default();
        SettingsFile::parse(&to_toml(&settings)).unwrap().apply(&mut back).unwrap();
        assert_eq!(back, settings);
    }

    #[test]
    fn mistakes_are_named() {
        for (text, part) in [
            ("[water]\nspacin = 1.0", "`spacing`"),
            ("[watr]", "`water`"),
            ("[water]\n\nspacing = 'a'", "line 3"),
            ("[water]\nmedium = 'mud'", "clear, pool, ocean, milk, source"),
            ("[water]\nmedium = {absorption=[1.0,1.0,1.0], scatter=[0.0,0.0,0.0]}", "scatter"),
            ("[water]\namplitude = 'loud'", "volume or source"),
            ("[shadow]\nfilter = 'soft'", "pcf or convolution"),
            ("[water", "line 1"),
        ] {
            let message = SettingsFile::parse(text).unwrap_err();
            assert!(message.contains(part) && !message.contains('\n'), "{message}");
        }
    }
}
