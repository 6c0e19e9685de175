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
    /// d_c, the centre's depth.
    depth: f64,
    /// r, the sphere's radius.
    radius: f64,
    /// c, the centre in pixels.
    at: DVec2,
    /// R', the half-axes in pixels.
    half: DVec2,
    /// Signs of eye space's x and y in the picture: (1, -1) unless it is mirrored.
    facing: DVec2,
    /// h, the search radius relative to half the picture's height.
    pub(super) h: f64,
    /// Fraction of the thickness left at its age.
    lifetime: f64,
    /// Fraction of the thickness that has the kind's shape.
    told: f64,
    /// The remaining thickness, divided by the sum of `1 - rho^2` over all pixels.
    even: f64,
}

/// A sphere in a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fragment {
    pub(super) depth: f64,
    /// (u, v, w), the sphere's normal in eye space.
    pub(super) normal: DVec3,
    /// Contribution to the thickness.
    pub(super) amount: f64,
}

impl Sprite {
    /// The disc of a particle, if it is drawn.
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

    /// The pixels that the disc may cover.
    pub(super) fn pixels(&self, view: &View) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (columns, rows) = pixels(self.at, self.half, view);
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    /// The sphere in a pixel, without the scene.
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

/// Sum of `1 - rho^2` over all pixel centres in a disc, inside the picture and outside.
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

/// Columns and rows of the picture that a disc may cover.
pub(super) fn pixels(at: DVec2, half: DVec2, view: &View) -> (Range<usize>, Range<usize>) {
    let (low, high) = ((at - half).floor() - 1.0, (at + half).ceil() + 1.0);
    // The casts saturate.
    let range = |low: f64, high: f64, extent: usize| {
        let start = (low.max(0.0) as usize).min(extent);
        start..(high.max(0.0) as usize).clamp(start, extent)
    };
    (range(low.x, high.x, view.width), range(low.y, high.y, view.height))
}
