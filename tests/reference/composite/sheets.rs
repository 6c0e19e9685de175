//! Twin of the composite with two sheets: the front sheet over the back sheet over the scene,
//! according to the air between them (not in the source).

use glam::{DVec2, DVec3};

use super::super::surface::{Case, Surface, Surfaces};
use super::super::{Image, View, is_surface, smoothstep};

use super::{
    Inputs, Settings, Under, before, bent, cut_look_up, displacement, of_scene, over_scene,
    scene_at, under_water,
};

/// Inputs of a frame with two sheets besides [`Inputs`], whose thickness is that of all water.
#[derive(Clone, Copy, Debug)]
pub struct Behind<'a> {
    /// Depth of the boundary between the sheets, for each texel of the thickness.
    pub boundaries: &'a Image<f64>,
    /// Thickness of the front sheet, of the back sheet and of the window between them.
    pub thickness: &'a Image<[f64; 3]>,
    /// Smoothed depth of the back sheet, at its level.
    pub smoothed: &'a Image<f64>,
    /// Level of that image.
    pub level: u32,
}

/// The sheet behind a pixel's surface.
#[derive(Clone, Copy, Debug)]
pub struct Back {
    /// Its thickness is T2.
    pub surface: Surface,
    /// Fraction of the pixel in which the sheet was found completely, and fraction of air before
    /// it.
    pub covered: f64,
    pub apart: f64,
    /// Depth of the nearest texel around the pixel that is not before the boundary.
    pub nearest: f64,
}

impl Back {
    /// Strength of its reflection and highlight.
    pub fn part(&self) -> f64 {
        self.covered * self.apart
    }
}

/// The surfaces in a pixel.
#[derive(Clone, Debug)]
pub struct Shown {
    pub front: Surface,
    pub back: Option<Back>,
    /// The texels of its thickness, with weights.
    pub texels: Vec<(usize, usize, f64)>,
    /// Whether the thickness is split by sheets, and not that of all water.
    pub parted: bool,
    /// Whether the result depends on an amount of water in the window that is tiny.
    pub barely: bool,
}

/// Fraction of the window that is air.
pub fn air(window: f64, spacing: f64) -> f64 {
    1.0 - smoothstep(0.1 * spacing, 0.6 * spacing, window)
}

/// Fraction of the air that still separates two sheets at this distance.
pub fn open(gap: f64, spacing: f64) -> f64 {
    smoothstep(1.0, 4.0, gap / spacing)
}

/// Both images of surfaces of a frame with two sheets, prepared for queries per pixel.
pub struct Two<'a> {
    inputs: Inputs<'a>,
    behind: Behind<'a>,
    spacing: f64,
    fronts: Surfaces<'a>,
    backs: Surfaces<'a>,
}

impl<'a> Two<'a> {
    pub fn new(
        inputs: &Inputs<'a>,
        behind: &Behind<'a>,
        settings: &Settings,
        view: &'a View,
    ) -> Self {
        let Behind { smoothed, level, .. } = *behind;
        Self {
            inputs: *inputs,
            behind: *behind,
            spacing: settings.radius / 0.656,
            fronts: Surfaces::new(inputs, settings, view),
            backs: Surfaces::new(
                &Inputs { smoothed, level, noise: None, ..*inputs },
                settings,
                view,
            ),
        }
    }

    /// The surfaces in a pixel, if there is water.
    pub fn at(&self, x: usize, y: usize) -> Option<Shown> {
        let Behind { boundaries, thickness, .. } = self.behind;
        let Self { inputs, fronts, backs, .. } = self;
        let one = fronts.at(x, y)?;
        let (f, mut margin) = (inputs.depth.at(x, y), one.parts.margin);
        let mut smooth = fronts.smooth(x, y, f, &mut margin);
        let (texels, borrowed) = fronts.texels_of_thickness(x, y, smooth.z, &mut margin);
        let level = inputs.thickness_level;
        let mut boundary = boundaries.at(x >> level, y >> level);
        let parted = is_surface(boundary);
        let (mut t, mut apart, mut t2, mut barely) = (one.parts.full, 0.0, 0.0, false);
        if parted {
            t = 0.0;
            // The boundary of the texel with the largest weight, the first of equals.
            let mut most = 0.0;
            for (i, j, weight) in texels.iter().copied() {
                let [front, back, window] = thickness.at(i, j);
                let air = air(window, self.spacing);
                if weight > most + 1e-9 {
                    (most, boundary) = (weight, boundaries.at(i, j));
                }
                let before = f < boundaries.at(i, j);
                let (own, other) = if before { (front, back) } else { (back, front) };
                t += weight * (own + (1.0 - air) * other);
                apart += weight * air;
                t2 += weight * air * back;
                barely |= air > 0.0 && air < 1e-4;
            }
        }
        let mut back = None;
        let mut mixed = 0.0;
        if parted && f < boundary && t2 > 0.0 {
            let nearest = backs.nearest(x, y, boundary);
            let there = is_surface(nearest);
            let own = if there { nearest } else { f };
            let mut found = backs.smooth(x, y, own, &mut margin);
            if there && found.case == Case::Beside {
                found.found = if found.whole { 1.0 } else { 0.0 };
            }
            // As the air between them vanishes, the sheets become one.
            let open = if there { open(found.z - smooth.z - t, self.spacing) } else { 1.0 };
            t += (1.0 - open) * t2;
            (t2, apart) = (open * t2, open * apart);
            let mut surface = backs.made_of((x, y), &found, t2, None, f64::INFINITY);
            // Where the back sheet has no surface, the distance to the scene is unlimited.
            if !there {
                (surface.thickness, surface.room) = (t2, f64::INFINITY);
            }
            let hidden = found.z >= inputs.scene(x, y);
            let covered = if there && !hidden { found.found } else { 0.0 };
            back = Some(Back { surface, covered, apart, nearest });
        } else if fronts.is_covered(x, y, f, &mut margin) {
            let behind = backs.smooth(x, y, f, &mut margin);
            // Without air the texel has one sheet, which has no gaps between its spheres.
            let open = if is_surface(boundary) { apart } else { 1.0 };
            mixed = open * (1.0 - smooth.found) * behind.found;
            // Slopes per texel of the front image.
            let finer = 0.5_f64.powi(self.behind.level as i32 - inputs.level as i32);
            let slopes = behind.slope.map(|slope| slope * finer);
            smooth.found += mixed;
            smooth.z += mixed * (behind.z - smooth.z);
            let [slope, rises] = smooth.slope;
            let turned = slopes[0] - slope;
            smooth.slope = [slope + mixed * turned, rises.lerp(slopes[1], mixed) + turned.abs()];
            barely |= mixed > 0.0 && parted && t2 > 0.0 && t2 < 1e-6 * self.spacing;
        }
        let mut front = fronts.made_of((x, y), &smooth, t, Some(f), margin);
        (front.parts.borrowed, front.parts.mixed) = (borrowed, mixed);
        Some(Shown { front, back, texels, parted, barely })
    }
}

/// Position at which the scene is looked up through both sheets, before obstacles shorten it, and
/// the depth before which nothing may lie.
pub fn look_up_both(settings: &Settings, shown: &Shown, view: &View, pixel: DVec2) -> (DVec2, f64) {
    let (mut by, mut z) = (displacement(settings, &shown.front, view), -shown.front.position.z);
    // If something hides the back sheet in this pixel, the whole sheet is treated as hidden.
    if let Some(back) = shown.back.filter(|back| is_surface(back.nearest)) {
        by += back.covered * displacement(settings, &back.surface, view);
        z = z.max(z + (-back.surface.position.z - z) * back.apart);
    }
    (pixel + bent(by, view), z)
}

/// Colour of a pixel with water: front sheet over back sheet over the scene, which is looked up
/// once with the sum of both displacements. The back sheet is never a drop.
pub fn shade_shown(
    inputs: &Inputs<'_>,
    behind: &Behind<'_>,
    shown: &Shown,
    settings: &Settings,
    env: impl Fn(DVec3) -> DVec3,
    view: &View,
    pixel: DVec2,
) -> DVec3 {
    let (displaced, z) = look_up_both(settings, shown, view, pixel);
    let (q, _) = cut_look_up(inputs, z, pixel, displaced);
    let mut color = scene_at(inputs, q);
    color = under_water(settings, &Under::of(settings, &shown.front, view), color);
    let mut under = Under { wet: 0.0, down: 0.0, path: 0.0, film: 0.0 };
    if let Some(back) = &shown.back {
        under = Under::of(settings, &back.surface, view);
        color = under_water(settings, &Under { wet: under.wet * back.part(), ..under }, color);
    }
    if let Some(back) = &shown.back {
        // The back sheet does not mirror the scene.
        let none = (0.0, DVec3::ZERO);
        color = before(settings, &back.surface, back.part(), color, &env, none, under.path, view);
    }
    let mirrored = of_scene(inputs, Some(behind), settings, &shown.front, view, &env);
    let path = Under::of(settings, &shown.front, view).path;
    before(settings, &shown.front, 1.0, color, &env, mirrored, path, view)
}

/// The picture of two sheets.
pub fn shade_sheets(
    inputs: &Inputs<'_>,
    behind: &Behind<'_>,
    settings: &Settings,
    env: impl Fn(DVec3) -> DVec3 + Sync,
    view: &View,
) -> Image<[f64; 4]> {
    let two = Two::new(inputs, behind, settings, view);
    over_scene(inputs, view, |x, y, pixel| {
        Some(shade_shown(inputs, behind, &two.at(x, y)?, settings, &env, view, pixel))
    })
}
