//! The disc of a particle in the picture.

use super::super::{View, smoothstep};
use super::{Kind, LEAST, Look, Particle, Settings, TOLD};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::ops::Range;

/// A particle's disc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sprite {
    kind: Kind,
    look: Look,
    /// d_c, the depth of its centre.
    depth: f64,
    /// r, the radius of the sphere.
    radius: f64,
    /// c, its centre in pixels.
    at: DVec2,
    /// R', its half-axes in pixels.
    half: DVec2,
    /// Which way eye space grows in the picture: (1, -1) unless that is mirrored.
    facing: DVec2,
    /// h, its search radius over half the height of the picture.
    pub(super) h: f64,
    /// How much there is left of it.
    lifetime: f64,
    /// How much of its thickness goes by its shape.
    told: f64,
    /// What else there is of it, over the sum of `1 - rho^2` in all pixels.
    even: f64,
}

/// What of a sphere is seen in a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fragment {
    pub(super) depth: f64,
    /// (u, v, w), the sphere's normal in eye space.
    pub(super) normal: DVec3,
    /// What it adds to the thickness.
    pub(super) amount: f64,
}

impl Sprite {
    /// That of a particle, if it is drawn.
    pub(super) fn new(particle: &Particle, view: &View, settings: &Settings) -> Option<Self> {
        let radius = particle.drawn_radius(settings)?;
        let center = view.view.transform_point3(particle.position);
        let depth = -center.z;
        if depth <= view.near() {
            return None;
        }
        let kind = particle.kind;
        let at = view.project(center);
        let own = DVec2::new(radius / (depth * view.c_x()), radius / (depth * view.c_y()));
        let half = own * (LEAST / own.min_element()).max(1.0);
        let told = smoothstep(TOLD.0, TOLD.1, half.min_element());
        let even = match told < 1.0 {
            true => PI * own.x * own.y * settings.look.mean(kind) / weights(at, half),
            false => 0.0,
        };
        let h = radius * view.focal().y.abs() / depth;
        let (facing, lifetime) = (view.focal().signum(), particle.lifetime(&settings.look));
        Some(Self {
            kind,
            look: settings.look,
            depth,
            radius,
            at,
            half,
            facing,
            h,
            lifetime,
            told,
            even,
        })
    }

    /// The pixels of the picture that it may lie in.
    pub(super) fn pixels(&self, view: &View) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (columns, rows) = pixels(self.at, self.half, view);
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    /// What of it is in a pixel, before the scene.
    pub(super) fn meet(&self, x: usize, y: usize) -> Option<Fragment> {
        let q = (DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - self.at) / self.half;
        let square = q.length_squared();
        (square < 1.0).then(|| {
            let w = (1.0 - square).sqrt();
            let even = (1.0 - self.told) * self.even * (1.0 - square);
            let shape = self.told * self.look.shape(self.kind, square.sqrt());
            Fragment {
                depth: self.depth - w * self.radius,
                normal: (q * self.facing).extend(w),
                amount: self.lifetime * (even + shape),
            }
        })
    }
}

/// Sum of `1 - rho^2` over all pixel centres in a disc, in the picture or not.
fn weights(at: DVec2, half: DVec2) -> f64 {
    all_pixels(at, half)
        .map(|p| 1.0 - ((p - at) / half).length_squared())
        .filter(|q| *q > 0.0)
        .sum()
}

/// All pixel centres that may lie in a disc.
pub(super) fn all_pixels(at: DVec2, half: DVec2) -> impl Iterator<Item = DVec2> {
    let (low, high) = ((at - half).floor() - 1.0, (at + half).ceil() + 1.0);
    let (columns, rows) = (low.x as i64..high.x as i64, low.y as i64..high.y as i64);
    rows.flat_map(move |y| columns.clone().map(move |x| DVec2::new(x as f64 + 0.5, y as f64 + 0.5)))
}

/// The columns and rows of the picture that a disc may lie in.
pub(super) fn pixels(at: DVec2, half: DVec2, view: &View) -> (Range<usize>, Range<usize>) {
    let (low, high) = ((at - half).floor() - 1.0, (at + half).ceil() + 1.0);
    // The casts saturate.
    let range = |low: f64, high: f64, extent: usize| {
        let start = (low.max(0.0) as usize).min(extent);
        start..(high.max(0.0) as usize).clamp(start, extent)
    };
    (range(low.x, high.x, view.width), range(low.y, high.y, view.height))
}
