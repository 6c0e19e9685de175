//! Table `[bubbles]`.

use serde::Deserialize;
use whitewater::bubbles::{
    BubbleConfig, BubbleLook, BubbleSort, Film, FilmFresnel, Impostor, Spectrum,
};

/// Of what diffuse foam near the eye becomes: blobs at most, different ones, bubbles of each. A particle is a small
/// cluster, whose bubbles are seen one by one.
const HANDED_OVER: (u32, u32, u32) = (65_536, 32, 9);
/// Its core: little of it is opaque.
const CLUSTER: [f32; 2] = [0.25, 0.9];

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BubbleTable {
    film: Option<f32>,
    variation: Option<f32>,
    drainage: Option<f32>,
    core: Option<[f32; 2]>,
    albedo: Option<[f32; 3]>,
    pattern: Option<f32>,
    distortion: Option<f32>,
    roundness: Option<f32>,
    reflection: Option<f32>,
    shininess: Option<f32>,
    walls: Option<bool>,
    plug: Option<bool>,
    merge: Option<f32>,
    /// Near and far.
    hand_over: Option<[f32; 2]>,
    hand_over_size: Option<f32>,
    hand_over_blobs: Option<u32>,
    /// Not of the look, as all below: they choose passes.
    templates: Option<u32>,
    bubbles: Option<u32>,
    seed: Option<u32>,
    impostor: Option<ImpostorTable>,
    map: Option<u32>,
    steps: Option<u32>,
    layers: Option<u32>,
    sort: Option<SortTable>,
    index: Option<f32>,
    fresnel: Option<FresnelTable>,
    spectrum: Option<SpectrumTable>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ImpostorTable {
    Distance,
    Ids,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SortTable {
    Tiles,
    Peel,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FresnelTable {
    Exact,
    Schlick,
    Source,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SpectrumTable {
    Three,
    Whole,
}

impl BubbleTable {
    /// What of the foam chooses passes, for any number of blobs; or for those that diffuse foam becomes.
    pub fn config(&self) -> BubbleConfig {
        let mut standard = BubbleConfig::new(1);
        if self.hand_over.is_some() {
            (standard.max_blobs, standard.templates, standard.bubbles) = HANDED_OVER;
        }
        let impostor = match self.impostor {
            Some(ImpostorTable::Distance) => Impostor::Distance,
            Some(ImpostorTable::Ids) | None => Impostor::Ids,
        };
        BubbleConfig {
            templates: self.templates.unwrap_or(standard.templates),
            bubbles: self.bubbles.unwrap_or(standard.bubbles),
            seed: self.seed.unwrap_or(standard.seed),
            impostor,
            map: self.map.unwrap_or(impostor.map()),
            steps: self.steps.unwrap_or(impostor.steps()),
            layers: self.layers.unwrap_or(standard.layers),
            sort: match self.sort {
                Some(SortTable::Peel) => BubbleSort::Peel,
                Some(SortTable::Tiles) | None => BubbleSort::Tiles,
            },
            film: Film {
                index: self.index.unwrap_or(standard.film.index),
                fresnel: match self.fresnel {
                    Some(FresnelTable::Schlick) => FilmFresnel::Schlick,
                    Some(FresnelTable::Source) => FilmFresnel::Source,
                    Some(FresnelTable::Exact) | None => FilmFresnel::Exact,
                },
                spectrum: match self.spectrum {
                    Some(SpectrumTable::Three) => Spectrum::Three,
                    Some(SpectrumTable::Whole) | None => Spectrum::Whole,
                },
            },
            hand_over: self.hand_over.is_some(),
            max_blobs: self.hand_over_blobs.unwrap_or(standard.max_blobs),
        }
    }

    /// Puts what the table says over a look.
    pub fn apply(&self, look: &mut BubbleLook) {
        let set = |to: &mut f32, from: Option<f32>| *to = from.unwrap_or(*to);
        set(&mut look.film, self.film);
        set(&mut look.variation, self.variation);
        set(&mut look.drainage, self.drainage);
        look.core = self.core.unwrap_or(look.core);
        look.albedo = self.albedo.unwrap_or(look.albedo);
        set(&mut look.pattern, self.pattern);
        set(&mut look.distortion, self.distortion);
        set(&mut look.roundness, self.roundness);
        set(&mut look.reflection, self.reflection);
        set(&mut look.shininess, self.shininess);
        look.walls = self.walls.unwrap_or(look.walls);
        look.plug = self.plug.unwrap_or(look.plug);
        set(&mut look.merge, self.merge);
        if let Some([near, far]) = self.hand_over {
            look.core = self.core.unwrap_or(CLUSTER);
            (look.hand_over.near, look.hand_over.far) = (near, far);
        }
        set(&mut look.hand_over.size, self.hand_over_size);
    }
}
