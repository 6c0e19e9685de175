//! Table `[bubbles]`.

use whitewater::bubbles::{
    BubbleConfig, BubbleSettings, BubbleSort, Crossfade, Film, FilmFresnel, Impostor, Spectrum,
};

use super::table::{table, words};

/// Defaults if whitewater foam near the camera is drawn as blobs of soap bubbles: max number of blobs, number of
/// different blobs, number of bubbles in each. Each foam particle becomes a small cluster whose bubbles are seen one
/// by one.
const CROSSFADED: (u32, u32, u32) = (65_536, 32, 9);
/// Core of a blob that replaces a foam particle, in radii of the blob: the core is opaque up to the first radius and
/// ends at the second, so little of it is opaque.
const CLUSTER: [f32; 2] = [0.25, 0.9];

table! {
    /// Table `[bubbles]`.
    BubbleTable of BubbleSettings
    keys {
        film: f32,
        variation: f32,
        drainage: f32,
        core_opaque_radius: f32,
        core_outer_radius: f32,
        albedo: [f32; 3],
        pattern: f32,
        distortion: f32,
        roundness: f32,
        reflection: f32,
        shininess: f32,
        walls: bool,
        fill_holes: bool,
        min_pixels: f32,
    }
    optional {}
    not { crossfade }
    beside {
        /// Distances from the camera, `[near, far]`, between which whitewater foam is cross-faded to blobs of soap
        /// bubbles. If they are not set, there are no such blobs.
        crossfade: [f32; 2],
        crossfade_size: f32,
        crossfade_blobs: u32,
        /// This key and all below determine which passes are drawn and with which resources; they are not part of the
        /// look.
        variants: u32,
        bubbles: u32,
        seed: u32,
        impostor: ImpostorWord,
        map_size: u32,
        steps: u32,
        layers: u32,
        sort: SortWord,
        index: f32,
        fresnel: FresnelWord,
        spectrum: SpectrumWord,
    }
}

words!(ImpostorWord of Impostor { Distance, Ids });
words!(SortWord of BubbleSort { Tiles, Peel });
words!(FresnelWord of FilmFresnel { Exact, Schlick, Source });
words!(SpectrumWord of Spectrum { Three, Whole });

impl BubbleTable {
    /// Returns the configuration of the bubble passes. Its `max_blobs` is right only with `crossfade`, where blobs
    /// replace whitewater foam; otherwise the caller sets `max_blobs` to the number of its blobs.
    pub fn config(&self) -> BubbleConfig {
        let mut standard = BubbleConfig::new(1);
        if self.crossfade.is_some() {
            (standard.max_blobs, standard.variants, standard.bubbles) = CROSSFADED;
        }
        let impostor = self.impostor.map_or(standard.impostor, Into::into);
        standard.with(|it| {
            it.variants = self.variants.unwrap_or(standard.variants);
            it.bubbles = self.bubbles.unwrap_or(standard.bubbles);
            it.seed = self.seed.unwrap_or(standard.seed);
            it.impostor = impostor;
            it.map_size = self.map_size.unwrap_or(impostor.map_size());
            it.steps = self.steps.unwrap_or(impostor.steps());
            it.layers = self.layers.unwrap_or(standard.layers);
            it.sort = self.sort.map_or(standard.sort, Into::into);
            it.film = Film {
                index: self.index.unwrap_or(standard.film.index),
                fresnel: self.fresnel.map_or(standard.film.fresnel, Into::into),
                spectrum: self.spectrum.map_or(standard.film.spectrum, Into::into),
            };
            it.crossfade = self.crossfade.is_some();
            it.max_blobs = self.crossfade_blobs.unwrap_or(standard.max_blobs);
        })
    }

    /// Applies the table to a look.
    pub fn apply(&self, look: &mut BubbleSettings) {
        if let Some([near, far]) = self.crossfade {
            [look.core_opaque_radius, look.core_outer_radius] = CLUSTER;
            (look.crossfade.near, look.crossfade.far) = (near, far);
        }
        look.crossfade.size = self.crossfade_size.unwrap_or(look.crossfade.size);
        self.put(look);
    }

    /// The complete table of a look, with this table's configuration of passes.
    pub fn all(&self, look: &BubbleSettings) -> Self {
        let Crossfade { near, far, size } = look.crossfade;
        let BubbleConfig {
            max_blobs,
            variants,
            bubbles,
            seed,
            impostor,
            map_size,
            steps,
            layers,
            sort,
            film: Film { index, fresnel, spectrum },
            crossfade,
            ..
        } = self.config();
        Self {
            crossfade: crossfade.then_some([near, far]),
            crossfade_size: Some(size),
            // Without a cross-fade the number of blobs depends on the input.
            crossfade_blobs: crossfade.then_some(max_blobs),
            variants: Some(variants),
            bubbles: Some(bubbles),
            seed: Some(seed),
            impostor: Some(impostor.into()),
            map_size: Some(map_size),
            steps: Some(steps),
            layers: Some(layers),
            sort: Some(sort.into()),
            index: Some(index),
            fresnel: Some(fresnel.into()),
            spectrum: Some(spectrum.into()),
            ..Self::of(look)
        }
    }
}
