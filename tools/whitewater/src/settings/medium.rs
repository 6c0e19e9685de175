//! Liquids by name: medium, index of refraction, and colours of their foam.

use std::str::FromStr;

use serde::{Deserialize, Serialize};
use whitewater::Settings;
use whitewater::water::{Fresnel, Medium};

/// Properties of a liquid besides its medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Liquid {
    /// Index of refraction; `None` keeps the default.
    index: Option<f32>,
    /// Albedo of thick foam and of thin foam; `None` keeps the library's colours, which are white.
    foam: Option<[[f32; 3]; 2]>,
    /// Whether the liquid is so viscous that small waves die at once; then none are drawn.
    thick: bool,
}

/// Its foam is as white as that of water.
const WATERY: Liquid = Liquid { index: None, foam: None, thick: false };

/// Name of a liquid, and a factor for its absorption and scattering.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(try_from = "String", into = "String")]
pub struct MediumName {
    word: Word,
    share: f32,
}

/// Names of [`MediumName`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Word {
    Clear,
    Pool,
    Lake,
    Ocean,
    River,
    Glacier,
    Milk,
    Beer,
    Honey,
    Blood,
    Lava,
    Source,
}

const WORDS: [(&str, Word); 12] = [
    ("clear", Word::Clear),
    ("pool", Word::Pool),
    ("lake", Word::Lake),
    ("ocean", Word::Ocean),
    ("river", Word::River),
    ("glacier", Word::Glacier),
    ("milk", Word::Milk),
    ("beer", Word::Beer),
    ("honey", Word::Honey),
    ("blood", Word::Blood),
    ("lava", Word::Lava),
    ("source", Word::Source),
];

impl FromStr for MediumName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, share) = text.split_once(':').unwrap_or((text, "1"));
        let word = WORDS.iter().find(|(known, _)| *known == name).map(|(_, word)| *word);
        let share = share.parse::<f32>().ok().filter(|s| s.is_finite() && *s >= 0.0);
        match (word, share) {
            (Some(word), Some(share)) => Ok(Self { word, share }),
            (Some(_), None) => {
                Err(format!("expected a share of 0 or more after '{name}:', as {name}:0.1"))
            }
            (None, _) => {
                let names: Vec<_> = WORDS.iter().map(|(name, _)| *name).collect();
                Err(format!("expected one of {}", names.join(", ")))
            }
        }
    }
}

impl TryFrom<String> for MediumName {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<MediumName> for String {
    fn from(MediumName { word, share }: MediumName) -> Self {
        let name = WORDS.iter().find(|(_, known)| *known == word).map_or("", |(name, _)| name);
        if share == 1.0 { name.into() } else { format!("{name}:{share}") }
    }
}

impl MediumName {
    /// The medium, for particles of this spacing.
    pub fn medium(self, spacing: f32) -> Medium {
        let whole = match self.word {
            Word::Clear => Medium::CLEAR,
            Word::Pool => Medium::POOL,
            Word::Lake => Medium::LAKE,
            Word::Ocean => Medium::OCEAN,
            Word::River => Medium::RIVER,
            Word::Glacier => Medium::GLACIER,
            Word::Milk => Medium::MILK,
            Word::Beer => Medium::BEER,
            Word::Honey => Medium::HONEY,
            Word::Blood => Medium::BLOOD,
            Word::Lava => Medium::LAVA,
            Word::Source => Medium::source(spacing),
        };
        whole.thinned(self.share)
    }

    /// Properties of the medium's liquid: index of refraction, foam colours, and whether it is thick (very
    /// viscous). Clear waters keep the library's index and colours. The colours of the others are chosen by eye:
    /// bubbles are as white as those of water, but tinted by the liquid in their walls; lava has the dark colour of
    /// cooled crust.
    pub fn liquid(self) -> Liquid {
        let thick = matches!(self.word, Word::Honey | Word::Lava);
        let of =
            |index, much, little| Liquid { index: Some(index), foam: Some([much, little]), thick };
        match self.word {
            Word::Clear | Word::Pool | Word::Lake | Word::Ocean | Word::Source => WATERY,
            Word::Glacier => of(1.333, [0.86, 0.9, 0.9], [0.55, 0.68, 0.7]),
            Word::River => of(1.333, [0.82, 0.76, 0.65], [0.52, 0.44, 0.32]),
            Word::Milk => of(1.35, [0.9, 0.88, 0.8], [0.82, 0.79, 0.69]),
            // The head is cream.
            Word::Beer => of(1.345, [0.88, 0.8, 0.62], [0.66, 0.53, 0.32]),
            Word::Honey => of(1.49, [0.86, 0.7, 0.38], [0.62, 0.41, 0.13]),
            Word::Blood => of(1.38, [0.72, 0.2, 0.2], [0.42, 0.04, 0.04]),
            // Cooled crust.
            Word::Lava => of(1.6, [0.045, 0.04, 0.037], [0.03, 0.026, 0.024]),
        }
    }
}

impl Liquid {
    /// Applies surface and foam colours to settings.
    pub fn put(&self, settings: &mut Settings) {
        if let Some(index) = self.index {
            settings.water.fresnel = Fresnel::of_index(index);
        }
        if self.thick {
            settings.water.wavelets.slope = 0.0;
            settings.noise.weight *= 1.0 - settings.noise.airborne;
        }
        if let Some([much, little]) = self.foam {
            settings.surface_foam.front_color = much;
            settings.surface_foam.back_color = little;
            settings.spray.color = much;
            settings.whitewater.albedo = much;
        }
    }
}

/// Sets all values that [`Liquid::put`] may set to those of other settings.
pub fn take_back(settings: &mut Settings, from: &Settings) {
    settings.water.fresnel = from.water.fresnel;
    settings.water.wavelets.slope = from.water.wavelets.slope;
    settings.noise.weight = from.noise.weight;
    settings.surface_foam.front_color = from.surface_foam.front_color;
    settings.surface_foam.back_color = from.surface_foam.back_color;
    settings.spray.color = from.spray.color;
    settings.whitewater.albedo = from.whitewater.albedo;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for (name, _) in WORDS {
            let read: MediumName = name.parse().unwrap();
            assert_eq!(String::from(read), name);
            assert_eq!(read.share, 1.0);
        }
        let thin: MediumName = "beer:0.05".parse().unwrap();
        assert_eq!(String::from(thin), "beer:0.05");
        assert_eq!(thin.medium(0.1), Medium::BEER.thinned(0.05));
        for (bad, says) in
            [("mud", "glacier"), ("beer:", "beer:0.1"), ("milk:-1", "share"), ("milk:inf", "share")]
        {
            let message = bad.parse::<MediumName>().unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }

    #[test]
    fn a_liquid_has_its_own_foam_and_surface() {
        let of = |name: &str| {
            let mut settings = Settings::default();
            name.parse::<MediumName>().unwrap().liquid().put(&mut settings);
            settings
        };
        assert_eq!(of("ocean"), Settings::default());
        let honey = of("honey");
        // f0 = ((n - 1)/(n + 1))^2 for n = 1.49.
        let Fresnel::Schlick { f0 } = honey.water.fresnel else { panic!("{honey:?}") };
        assert!((f0 - 0.0387).abs() < 1.0e-4, "{f0}");
        let mut bare = honey.clone();
        take_back(&mut bare, &Settings::default());
        assert_eq!(bare, Settings::default());
        // Viscous liquids have no small waves.
        let mut rough = Settings::default();
        rough.water.wavelets.slope = 0.1;
        (rough.noise.weight, rough.noise.airborne) = (0.3, 1.0);
        let small = |name: &str| {
            let mut settings = rough.clone();
            name.parse::<MediumName>().unwrap().liquid().put(&mut settings);
            (settings.water.wavelets.slope, settings.noise.weight)
        };
        let found = ["lake", "beer", "honey", "lava"].map(small);
        assert_eq!(found, [(0.1, 0.3), (0.1, 0.3), (0.0, 0.0), (0.0, 0.0)]);
        // Foam of beer is cream, of blood pink, of lava dark.
        let [r, g, b] = of("beer").surface_foam.front_color;
        assert!(r > g && g > b && b > 0.5);
        let [r, g, b] = of("blood").surface_foam.front_color;
        assert!(r > 3.0 * g && g == b);
        assert!(of("lava").surface_foam.front_color.iter().all(|c| *c < 0.05));
        for (name, _) in WORDS {
            let settings = of(name);
            let pairs =
                settings.surface_foam.front_color.iter().zip(settings.surface_foam.back_color);
            assert!(pairs.into_iter().all(|(much, little)| *much >= little), "{name}");
            assert_eq!(
                settings.spray.color == Settings::default().spray.color,
                of(name).surface_foam == Settings::default().surface_foam
            );
        }
    }
}
