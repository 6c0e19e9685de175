//! The bench's pool as `render` draws a cache by default, without ripples: with spray, surface foam, shadows, caustics and
//! a basin.

use glam::Vec3;
use whitewater::headless::Headless;
use whitewater::headless::scene::Scene;
use whitewater::io::particles::{self, Particles};
use whitewater::{Config, Error, Settings, Sky};

use super::pool::Pool;
use crate::args::SetArg;
use crate::bounds::Bounds;
use crate::environment::Environment;
use crate::failure::{Failure, Outcome};
use crate::looks;
use crate::session::room;
use crate::settings::SettingsFile;
use crate::spray;
use crate::stage;

/// Default of `--smoothing-level` and `--thickness-level` of `render`.
const LEVEL: u32 = 1;

/// Settings and scene for the renderer.
pub struct Rendered {
    file: SettingsFile,
    settings: Settings,
    scene: Scene,
    sky: Sky,
    densities: Vec<f32>,
}

impl Rendered {
    /// For a pool that is seen from `eye`.
    pub fn new(pool: &Pool, eye: Vec3) -> Outcome<Self> {
        let nowhere = || Failure::input("the pool has no particles");
        let bounds = Bounds::of_bulk(&pool.positions).ok_or_else(nowhere)?;
        let bounds = bounds.padded(0.5 * pool.spacing);
        let file = SettingsFile::default();
        let environment = Environment::sky(Some(stage::side_light(eye - bounds.center())))?;
        let mut settings = file.look(pool.spacing, environment.light());
        let particles = Particles::from_positions(pool.positions.clone());
        let speed = looks::impact_speed(std::slice::from_ref(&particles));
        looks::spray_of_caches(&mut settings.spray, pool.spacing, speed);
        looks::foam_of_caches(&mut settings.surface_foam, pool.spacing);
        looks::waves_of_caches(&mut settings.water, pool.spacing, &bounds);
        file.apply(&mut settings);
        let rest = settings.water.rest_density;
        let shares = particles::estimate_densities(&pool.positions, pool.spacing);
        let mut densities: Vec<f32> = shares.into_iter().map(|share| share * rest).collect();
        spray::adjust_densities(&pool.positions, &mut densities, &settings);
        let from = (eye, false);
        let basin =
            stage::basin_round(&[&pool.positions], &bounds, pool.spacing, from, SetArg::Pool, &[]);
        let mut scene = basin.unwrap_or_else(|| stage::ground_under(&bounds, eye, SetArg::Pool));
        environment.light_scene(&mut scene);
        let sky = Sky::default().with(|it| it.sun = environment.sun.to_array());
        Ok(Self { file, settings, scene, sky, densities })
    }

    /// Enables the same passes as `Session`.
    pub fn configure(&self, config: &mut Config) {
        room::passes_of(&self.file, false, config);
        config.smoothing_level = LEVEL;
        config.thickness_level = LEVEL;
        config.sheets = 2;
        config.surface_foam = true;
        config.spray = true;
        config.shadow = Some(self.file.shadows());
        config.light_map_size = Some(room::light_texels(config.extent.width));
    }

    /// Uploads scene, light and particles; returns the settings.
    pub fn stage(&self, headless: &mut Headless, pool: &Pool) -> Result<Settings, Error> {
        headless.sky(&self.sky)?;
        headless.scene(&self.scene, true)?;
        headless.particles(&pool.positions, Some(&self.densities))?;
        Ok(self.settings.clone())
    }
}
