//! Creates the renderer that a frame needs, with its passes and with room for its particles.

use whitewater::ash::vk;
use whitewater::headless::{COLOR_FORMAT, Headless};
use whitewater::water::{Kernels, Rule, Shading};
use whitewater::{Config, DeviceSupport, WhitewaterConfig};

use super::{Session, noise_of};
use crate::args::{NoiseArg, ShadowArg};
use crate::environment::{Panorama, Source};
use crate::failure::{Failure, Kind, Outcome, bad_picture, too_large};
use crate::settings::SettingsFile;
use crate::whitewater_source::{self, WhitewaterSource};

/// Size of the maps of the light in the water, in texels along an edge, for a picture of this width.
pub fn light_texels(width: u32) -> u32 {
    (width / 2).next_multiple_of(16).clamp(256, 1024)
}

/// Sets the passes that the settings file asks for. `matte`: only the water is drawn.
pub fn passes_of(file: &SettingsFile, matte: bool, config: &mut Config) {
    let thesis = file.is_thesis();
    // The composite is a compute shader: GPUs made for computing have little hardware for rasterization
    // (docs/performance.md), and on others a render pass takes as long.
    config.composite = Some(Shading::Compute);
    config.mirror_steps = file.water.mirror_steps(thesis);
    // If only the water is drawn (`matte`), the background is unknown, so light is not refracted where it leaves the
    // water at the back.
    config.exit = file.water.exit(thesis || matte);
    config.kernels = file.water.kernels(thesis);
}

impl Session<'_> {
    /// Which objects cast shadows.
    pub(super) fn shadows(&self) -> ShadowArg {
        let scene = self.look.file.is_thesis();
        self.args.shadows.unwrap_or(if scene { ShadowArg::Scene } else { ShadowArg::All })
    }

    /// Creates a renderer with room for `count` particles and for `whitewater` particles of files, unless the present
    /// one has it. A new renderer starts without foam; returns whether foam or emitted whitewater was lost.
    pub fn make_room(&mut self, count: usize, whitewater: usize) -> Outcome<bool> {
        let supersample = self.supersample();
        let count = u32::try_from(count.max(self.look.fullest))
            .map_err(|_| Failure::input("expected fewer than 2^32 particles, found more"))?;
        // Room for the whitewater of the fullest probed frame, as for the water's particles. Otherwise a later frame
        // would need a new renderer, which loses the foam of earlier frames.
        let files = match &self.look.whitewater {
            Some(WhitewaterSource::Files(files)) => files.fullest(),
            _ => 0,
        };
        let whitewater = whitewater_source::counted(whitewater.max(files))?;
        let made = match &self.look.whitewater {
            Some(WhitewaterSource::Made(made)) => Some(made),
            _ => None,
        };
        // To find the limits of the emission, the probed frames of the whole sequence are uploaded before the first
        // frame is drawn, so there has to be room for them.
        let count = made.map_or(0, |made| made.probed() as u32).max(count);
        let there = self.headless.as_ref().map(|h| *h.renderer().config());
        let most =
            |config: &Config| config.whitewater.map_or(0, |whitewater| whitewater.max_particles);
        if there.is_some_and(|config| config.max_particles >= count && most(&config) >= whitewater)
        {
            return Ok(false);
        }
        let device = match self.headless.take() {
            Some(headless) => headless.finish()?,
            None => self.device.take().ok_or_else(|| {
                Failure::new(Kind::Device, "the device was lost earlier; run again")
            })?,
        };
        let (args, times) = (self.args, self.times.clone());
        let number = self.look.scene.frame;
        let [width, height] = [args.size.0, args.size.1].map(|n| n.saturating_mul(supersample));
        let extent = vk::Extent2D { width, height };
        // Frames between the probed ones may hold more particles; the margin is a quarter.
        let room = |count: u32| count.saturating_add(count / 4).max(1024);
        let before = there.as_ref();
        let whitewater = room(whitewater).max(before.map_or(0, most));
        let room = room(count).max(before.map_or(0, |config| config.max_particles));
        let mut config = Config::new(extent, COLOR_FORMAT, room);
        config.max_stride = 12;
        passes_of(&self.look.file, self.look.matte, &mut config);
        config.smoothing_level = args.smoothing_level;
        config.thickness_level = args.thickness_level;
        let thesis = self.look.file.is_thesis();
        config.sheets = args.sheets.unwrap_or(if thesis { 1 } else { 2 });
        config.surface_foam = self.look.foam.is_some();
        config.spray = self.look.spray;
        config.whitewater = self.look.whitewater.as_ref().map(|source| {
            let (most, max_stride) = match source {
                WhitewaterSource::Files(_) => (whitewater, 12),
                WhitewaterSource::Made(made) => (made.max_particles(), 16),
            };
            let table = &self.look.file.whitewater;
            let (occlusion, splat) = (table.occlusion(), table.splat());
            WhitewaterConfig::new(most).with(|it| {
                it.max_stride = max_stride;
                it.occlusion = occlusion;
                it.splat = splat;
            })
        });
        config.bubbles = self.look.bubbles.as_ref().map(|(blobs, bubbles)| {
            let max_splits = blobs.motion.as_ref().map_or(0, |motion| motion.max_splits);
            let own = (blobs.blobs.len() as u32).max(1) << max_splits;
            let max_blobs = if bubbles.crossfade { bubbles.max_blobs } else { own };
            bubbles.with(|it| it.max_blobs = max_blobs)
        });
        config.shore = self.look.shores.as_ref().map(|shores| shores.config);
        // Half the resolution of the picture, measured without supersampling.
        config.noise = (noise_of(args, &self.look.file) != NoiseArg::None).then_some(1);
        let shadows = self.shadows();
        config.shadow = (shadows != ShadowArg::None).then(|| self.look.file.shadows());
        config.light_map_size = (shadows == ShadowArg::All).then(|| light_texels(width));
        config.motion = self.motion;
        config.depth_splat = args.splat.map(Into::into);
        config.thickness_splat = args.splat.map(Into::into);
        let rule = if thesis { Rule::Source } else { Rule::ConstantWidth };
        config.rule = args.rule.unwrap_or(rule);
        if config.kernels == Kernels::Ellipsoids && !self.look.file.water.says_kernels() {
            // A device may not be able to bind a buffer of that size.
            let offer = DeviceSupport::of(&device.instance, device.physical, COLOR_FORMAT);
            let spheres = config.with(|it| it.kernels = Kernels::Spheres);
            if offer.check(&config).is_err() && offer.check(&spheres).is_ok() {
                times.say(&format!(
                    "{room} particles are drawn as spheres, because the device cannot bind the ellipsoids of so many"
                ));
                config = spheres;
            }
        }
        let mut headless = times
            .step("set up", number, || Headless::new(device, &config))
            .map_err(|error| too_large(error, supersample))?;
        times.step("environment", number, || match &self.look.environment.source {
            Source::Sky(sky) => Ok(headless.sky(sky)?),
            Source::Picture { shown, without_sun } => {
                let (width, height) = (shown.width as u32, shown.height as u32);
                let extent = vk::Extent2D { width, height };
                let [shown, without_sun] = [shown, without_sun].map(Panorama::texels);
                let made =
                    headless.equirectangular_with_sun(extent, &shown, &without_sun, (1.0, 0.0));
                made.map_err(|error| bad_picture(error, &args.environment))
            }
        })?;
        times.step("scene", number, || headless.scene(&self.look.scene, supersample == 1))?;
        if shadows == ShadowArg::All {
            headless.region(self.look.region);
        }
        if let Some((blobs, _)) = self.look.bubbles.as_ref().filter(|(_, own)| !own.crossfade) {
            times.step("upload", number, || match &blobs.motion {
                Some(own) => headless.heap(&blobs.blobs, own.field.as_ref(), own.max_splits),
                None => headless.bubbles(&blobs.blobs),
            })?;
        }
        if let Some(shores) = &self.look.shores {
            times.step("shore", number, || shores.set_up(&mut headless, &self.look.scene))?;
        }
        self.staged = self.look.scene.frame;
        self.headless = Some(headless);
        let memory = std::mem::take(&mut self.memory);
        Ok(self.look.fps.is_some() && memory.stepped.or(memory.made).is_some())
    }
}
