//! Orientation of a sprite's ellipse, and its intersection with a ray.

use super::super::thickness::J;
use super::super::{View, smoothstep};
use super::texels::texel;
use super::{
    AXIS, CELLS, EDGE_ON, HEAD_ON, LEAST_AXIS, LEAST_FACING, PARALLEL, STILL, Settings, Sprite,
    TOLD_APART, depth_part,
};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Axes of an ellipse: perpendicular unit vectors along its half-axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Along the long half-axis.
    pub e1: DVec3,
    /// Along the short half-axis.
    pub e2: DVec3,
    /// t, in 0..1: the long half-axis is 1 + t times the short one.
    pub stretch: f64,
}

impl Axes {
    /// The normal of their plane.
    pub fn normal(&self) -> DVec3 {
        self.e1.cross(self.e2)
    }
}

/// The axes of a sprite: across the view at rest, along the velocity when fast. A sprite that moves
/// straight at the eye would be seen edge-on, so it stays round.
pub fn axes(sprite: &Sprite, settings: &Settings) -> Axes {
    let v = sprite.center.normalize();
    let speed = sprite.velocity.length() / settings.spacing;
    if speed > STILL {
        let dir = sprite.velocity.normalize();
        let across = dir.cross(v);
        if across.length() >= PARALLEL {
            let e2 = across.normalize();
            let p = e2.cross(v);
            let p = if p.dot(dir) < 0.0 { -p } else { p };
            let head_on = smoothstep(HEAD_ON.0, HEAD_ON.1, v.dot(dir).abs());
            let stretch = smoothstep(0.0, settings.motion_threshold, speed) * (1.0 - head_on);
            return Axes { e1: p.lerp(dir, stretch).normalize(), e2, stretch };
        }
    }
    let up = v.cross(DVec3::Y);
    let side = if up.length() < PARALLEL { v.cross(DVec3::X) } else { up };
    let e2 = side.normalize();
    Axes { e1: e2.cross(v), e2, stretch: 0.0 }
}

/// The ellipse of a sprite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    pub(super) center: DVec3,
    pub(super) axes: Axes,
    /// a and b in world units.
    pub(super) half: DVec2,
}

/// Where a ray meets an ellipse.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Depth.
    pub(super) k: f64,
    /// Position in half-axes.
    pub(super) at: DVec2,
}

impl Ellipse {
    /// The ellipse of a sprite with this half-axis at rest, in world units.
    pub(super) fn new(sprite: &Sprite, settings: &Settings, half: f64) -> Self {
        let axes = axes(sprite, settings);
        let half = DVec2::new(half * (1.0 + axes.stretch), half);
        Self { center: sprite.center, axes, half }
    }

    /// Where a ray meets the ellipse, not before the near plane.
    pub(super) fn meet(&self, ray: DVec3, near: f64) -> Option<Hit> {
        let n = self.axes.normal();
        let q = n.dot(ray);
        if q.abs() < EDGE_ON {
            return None;
        }
        let k = n.dot(self.center) / q;
        let p = ray * k - self.center;
        let at = DVec2::new(p.dot(self.axes.e1), p.dot(self.axes.e2)) / self.half;
        (k >= near && at.length_squared() <= 1.0).then_some(Hit { k, at })
    }

    /// The thickness' ellipse, for the texels of a view, and the noise's strength.
    pub(super) fn thick(sprite: &Sprite, view: &View, settings: &Settings) -> (Self, f64) {
        let half = AXIS * settings.radius();
        Self::new(sprite, settings, half).wide(texel(sprite.center, view), settings)
    }

    /// The depth's ellipse, for this amount of foam.
    pub(super) fn deep(sprite: &Sprite, foam: f64, view: &View, settings: &Settings) -> Self {
        let (thick, _) = Self::thick(sprite, view, settings);
        Self { half: thick.half * depth_part(foam), ..thick }
    }

    /// The ellipse, at least as wide as texels of this width can represent, and the strength of its
    /// noise.
    fn wide(self, texel: f64, settings: &Settings) -> (Self, f64) {
        let cell = self.half.y / (CELLS * texel);
        let torn = settings.noise * smoothstep(TOLD_APART.0, TOLD_APART.1, cell);
        (Self { half: self.half.max(DVec2::splat(LEAST_AXIS * texel)), ..self }, torn)
    }

    /// Height along z at the middle of the thickness sprite, in world units: its integral is the
    /// particle's volume of foam. Without the min of facing, edge-on ellipses would be infinitely
    /// high.
    pub(super) fn amplitude(&self, foam: f64, settings: &Settings) -> f64 {
        let facing = self.axes.normal().dot(self.center / self.center.z).abs().max(LEAST_FACING);
        foam * settings.spacing.powi(3) / (PI * J * self.half.x * self.half.y * facing)
    }
}
