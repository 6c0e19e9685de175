//! Table `[bubbles]`.

use whitewater::bubbles::{
    BubbleConfig, BubbleLook, BubbleSort, Film, FilmFresnel, HandOver, Impostor, Spectrum,
};

use super::table::{table, words};

/// Of what diffuse foam near the eye becomes: blobs at most, different ones, bubbles of each. A particle is a small
/// cluster, whose bubbles are seen one by one.
const HANDED_OVER: (u32, u32, u32) = (65_536, 32, 9);
/// Its core: little of it is opaque.
const CLUSTER: [f32; 2] = [0.25, 0.9];

table! {
    /// Table `[bubbles]`.
    BubbleTable of BubbleLook
    keys {
        film: f32,
        variation: f32,
        drainage: f32,
        core: [f32; 2],
        albedo: [f32; 3],
        pattern: f32,
        distortion: f32,
        roundness: f32,
        reflection: f32,
        shininess: f32,
        walls: bool,
        plug: bool,
        merge: f32,
    }
    optional {}
    not { hand_over }
    beside {
        /// Near and far; that it is there hands foam over.
        hand_over: [f32; 2],
        hand_over_size: f32,
        hand_over_blobs: u32,
        /// Not of the look, as all below: they choose passes.
        templates: u32,
        bubbles: u32,
        seed: u32,
        impostor: ImpostorWord,
        map: u32,
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
    /// What of the foam chooses passes, for any number of blobs; or for those that diffuse foam becomes.
    pub fn config(&self) -> BubbleConfig {
        let mut standard = BubbleConfig::new(1);
        if self.hand_over.is_some() {
            (standard.max_blobs, standard.templates, standard.bubbles) = HANDED_OVER;
        }
        let impostor = self.impostor.map_or(standard.impostor, Into::into);
        standard.with(|it| {
            it.templates = self.templates.unwrap_or(standard.templates);
            it.bubbles = self.bubbles.unwrap_or(standard.bubbles);
            it.seed = self.seed.unwrap_or(standard.seed);
            it.impostor = impostor;
            it.map = self.map.unwrap_or(impostor.map());
            it.steps = self.steps.unwrap_or(impostor.steps());
            it.layers = self.layers.unwrap_or(standard.layers);
            it.sort = self.sort.map_or(standard.sort, Into::into);
            it.film = Film {
                index: self.index.unwrap_or(standard.film.index),
                fresnel: self.fresnel.map_or(standard.film.fresnel, Into::into),
                spectrum: self.spectrum.map_or(standard.film.spectrum, Into::into),
            };
            it.hand_over = self.hand_over.is_some();
            it.max_blobs = self.hand_over_blobs.unwrap_or(standard.max_blobs);
        })
    }

    /// Puts what the table says over a look.
    pub fn apply(&self, look: &mut BubbleLook) {
        if let Some([near, far]) = self.hand_over {
            look.core = CLUSTER;
            (look.hand_over.near, look.hand_over.far) = (near, far);
        }
        look.hand_over.size = self.hand_over_size.unwrap_or(look.hand_over.size);
        self.put(look);
    }

    /// The table that says all of a look, and of the passes as this table does.
    pub fn all(&self, look: &BubbleLook) -> Self {
        let HandOver { near, far, size } = look.hand_over;
        let BubbleConfig {
            max_blobs,
            templates,
            bubbles,
            seed,
            impostor,
            map,
            steps,
            layers,
            sort,
            film: Film { index, fresnel, spectrum },
            hand_over,
            ..
        } = self.config();
        Self {
            hand_over: hand_over.then_some([near, far]),
            hand_over_size: Some(size),
            // How many blobs there are is of the input where none are handed over.
            hand_over_blobs: hand_over.then_some(max_blobs),
            templates: Some(templates),
            bubbles: Some(bubbles),
            seed: Some(seed),
            impostor: Some(impostor.into()),
            map: Some(map),
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
