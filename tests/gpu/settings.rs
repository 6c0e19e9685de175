//! Each setting has an effect: a change of any one changes the picture of a configuration that uses
//! it. Settings that only apply in one mode are changed in that mode; shore settings are tested in
//! [`super::shore::settings`]. Each test names the settings that it leaves to others.

use std::f32::consts::PI;

use ash::vk;
use glam::{Mat4, Vec3};
use whitewater::bubbles::{BubbleConfig, Crossfade};
use whitewater::headless::{Bubble, Whitewater};
use whitewater::water::{
    Amplitude, Bed, Compositing, Convolution, DebugView, Fresnel, Kernels, Medium, Rule, Shadows,
    SpraySettings, SurfaceNoiseSettings,
};
use whitewater::{LightVolume, Settings, Shadow};
use whitewater::{Occlusion, OcclusionReach, ShadowMixing, Submerged, WhitewaterConfig};

use crate::light::shadows;
use crate::reference::Image;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens, Random};
use crate::surface_foam::Foamy;

const SIZE: vk::Extent2D = vk::Extent2D { width: 97, height: 61 };

pub type Change = (&'static str, fn(&mut Settings));

/// Checks that each of the changes changes the picture.
pub fn all_show(
    mode: &str,
    base: &Settings,
    changes: &[Change],
    mut draw: impl FnMut(&Settings) -> Drawn,
) {
    let expected = draw(base).output;
    let idle = changes.iter().filter(|(name, change)| {
        let mut settings = base.clone();
        change(&mut settings);
        assert_ne!(settings, *base, "{mode}: {name} is as it was");
        draw(&settings).output.data == expected.data
    });
    let idle: Vec<_> = idle.map(|(name, _)| *name).collect();
    assert!(idle.is_empty(), "{mode}: these do nothing: {idle:?}");
}

/// Checks that none of the changes changes the picture, as their documentation says.
fn none_show(
    mode: &str,
    base: &Settings,
    changes: &[Change],
    mut draw: impl FnMut(&Settings) -> Drawn,
) {
    let expected = draw(base).output;
    for (name, change) in changes {
        let mut settings = base.clone();
        change(&mut settings);
        assert!(draw(&settings).output.data == expected.data, "{mode}: {name} shows");
    }
}

/// Checks that the changes, or those of other tests, contain each field of a part of the settings.
fn all_listed(part: &str, of: &impl std::fmt::Debug, changes: &[Change], elsewhere: &[&str]) {
    let text = format!("{of:#?}");
    let own = text.lines().filter_map(|line| line.strip_prefix("    ")?.split_once(": "));
    let fields = own.map(|(name, _)| name).filter(|name| !name.starts_with(' '));
    let named = |change: &str, field: &str| {
        let rest =
            change.strip_prefix(part).and_then(|it| it.strip_prefix('.')?.strip_prefix(field));
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', '.']))
    };
    let missing: Vec<_> = fields
        .filter(|field| !elsewhere.contains(field))
        .filter(|field| !changes.iter().any(|(change, _)| named(change, field)))
        .collect();
    assert!(missing.is_empty(), "{part}: nothing changes {missing:?}");
}

/// Water, foam and spray of all kinds before and behind each other, in the sun.
fn layered() -> Foamy {
    let mut case = Foamy::new(SIZE, Lens::Standard, 20.0);
    let n = case.shot.positions.len();
    let mut random = Random(12);
    case.shot.densities = Some((0..n).map(|_| random.between(300.0, 1000.0)).collect());
    let center = scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0];
    case.shot.light_volume = Some(LightVolume { center, radius: 6.0 });
    let settings = &mut case.shot.settings;
    // The sun is behind the eye, and the highlight is wide enough to be visible.
    settings.light.direction = Vec3::new(-0.5, 0.7, 0.6).normalize().to_array();
    settings.water.shininess = 4.0;
    // The front layer ends inside the foam.
    settings.surface_foam.front_depth = 2.0 * settings.water.spacing;
    settings.noise = SurfaceNoiseSettings::default().with(|it| it.foam = 0.5);
    settings.spray = SpraySettings::default().with(|it| it.size = 1.5);
    case
}

fn drawer<'r>(case: Foamy, rig: &'r mut Rig<'_>) -> impl FnMut(&Settings) -> Drawn + 'r {
    let mut case = case;
    move |settings| {
        case.shot.settings = settings.clone();
        case.draw(rig)
    }
}

#[test]
fn every_setting_of_water_foam_spray_noise_and_light_shows() {
    let gpu = Gpu::shared();
    let both = config(SIZE).with(|it| {
        it.surface_foam = true;
        it.spray = true;
        it.noise = Some(0);
    });
    let config = both.with(|it| {
        it.light_map_size = Some(64);
        it.sheets = 2;
        it.thickness_level = 0;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let case = layered();
    let base = case.shot.settings.clone();
    let changes: [Change; 70] = [
        ("water.spacing", |s| s.water.spacing *= 1.1),
        ("water.rest_density", |s| s.water.rest_density *= 1.1),
        ("water.smoothing_width", |s| s.water.smoothing_width *= 1.5),
        ("water.depth_falloff", |s| s.water.depth_falloff = 0.5),
        ("water.amplitude", |s| s.water.amplitude = Amplitude::Source),
        ("water.medium.absorption", |s| {
            s.water.medium =
                Medium::Physical { absorption: [2.0; 3], scattering: [0.014, 0.03, 0.04] };
        }),
        ("water.medium.scattering", |s| {
            s.water.medium =
                Medium::Physical { absorption: [1.1, 0.24, 0.11], scattering: [0.5; 3] };
        }),
        ("water.medium", |s| s.water.medium = Medium::source(s.water.spacing)),
        ("water.medium turbid", |s| s.water.medium = Medium::RIVER),
        ("water.fresnel.f0", |s| s.water.fresnel = Fresnel::Schlick { f0: 0.2 }),
        ("water.refraction", |s| s.water.refraction = 0.05),
        ("water.specular", |s| s.water.specular = 0.5),
        ("water.shininess", |s| s.water.shininess = 6.0),
        ("water.compositing", |s| s.water.compositing = Compositing::Source),
        ("surface_foam.extinction", |s| s.surface_foam.extinction *= 2.0),
        ("surface_foam.front_extinction", |s| s.surface_foam.front_extinction *= 2.0),
        ("surface_foam.front_power", |s| s.surface_foam.front_power = 2.0),
        ("surface_foam.front_depth", |s| s.surface_foam.front_depth *= 2.0),
        ("surface_foam.motion_threshold", |s| s.surface_foam.motion_threshold = 4.0),
        ("surface_foam.pattern", |s| s.surface_foam.pattern = 0.5),
        ("water.wavelets.slope", |s| s.water.wavelets.slope = 0.1),
        ("water.wavelets.length", |s| {
            (s.water.wavelets.slope, s.water.wavelets.length) = (0.05, 1.0);
        }),
        ("water.wavelets.time", |s| {
            (s.water.wavelets.slope, s.water.wavelets.time) = (0.05, 2.0);
        }),
        ("surface_foam.pattern_size", |s| s.surface_foam.pattern_size = 6.0),
        ("surface_foam.pattern_period", |s| s.surface_foam.pattern_period = 0.7),
        ("surface_foam.time", |s| s.surface_foam.time += 0.2),
        ("surface_foam.min_thickness", |s| s.surface_foam.min_thickness *= 2.0),
        ("surface_foam.normal_strength", |s| s.surface_foam.normal_strength = 0.7),
        ("surface_foam.shadow", |s| s.surface_foam.shadow *= 3.0),
        ("surface_foam.lace", |s| s.surface_foam.lace = 1.0),
        ("surface_foam.shape", |s| s.surface_foam.shape = 1.0),
        ("surface_foam.aeration", |s| s.surface_foam.aeration = 0.7),
        ("surface_foam.aerated_color", |s| {
            (s.surface_foam.aeration, s.surface_foam.aerated_color) = (0.5, [0.9; 3]);
        }),
        ("surface_foam.back_color", |s| s.surface_foam.back_color = [0.3; 3]),
        ("surface_foam.front_color", |s| s.surface_foam.front_color = [0.5; 3]),
        ("spray.opacity", |s| s.spray.opacity = 0.8),
        ("spray.size", |s| s.spray.size = 1.0),
        ("spray.max_angle", |s| s.spray.max_angle = 1.0e-3),
        ("spray.droplets", |s| s.spray.droplets = 9),
        ("spray.all_spray_density", |s| s.spray.all_spray_density = 0.5),
        ("spray.full_water_density", |s| s.spray.full_water_density = 0.8),
        ("spray.no_spray_density", |s| s.spray.no_spray_density = 0.95),
        ("spray.scatter_radius", |s| s.spray.scatter_radius = 1.0),
        ("spray.stretch", |s| s.spray.stretch = 0.05),
        ("spray.mist", |s| s.spray.mist = 0.3),
        ("spray.mist_size", |s| s.spray.mist_size = 1.0),
        ("spray.clumps", |s| s.spray.clumps = 1.5),
        ("spray.shade", |s| s.spray.shade = 4.0),
        ("spray.scattering", |s| s.spray.scattering = 0.5),
        ("spray.relief", |s| s.spray.relief = 1.0),
        ("spray.glints", |s| s.spray.glints = 8.0),
        ("spray.exposure", |s| s.spray.exposure = 0.1),
        ("spray.color", |s| s.spray.color = [0.5; 3]),
        ("spray.additive", |s| s.spray.additive = true),
        ("noise.weight", |s| s.noise.weight = 0.6),
        ("noise.falloff", |s| s.noise.falloff = 0.5),
        ("noise.size", |s| s.noise.size = 1.5),
        ("noise.cells", |s| s.noise.cells = 2.0),
        ("noise.foam", |s| s.noise.foam = 1.0),
        ("noise.color", |s| s.noise.color = [0.9; 3]),
        ("light.direction", |s| s.light.direction = [0.0, 1.0, 0.0]),
        ("light.color", |s| s.light.color = [2.0; 3]),
        ("light.ambient", |s| s.light.ambient = [1.0; 3]),
        ("light.irradiance", |s| s.light.irradiance = [PI; 3]),
        ("light.shade", |s| s.light.shade = [0.1; 3]),
        ("debug view 0", |s| s.debug_view = DebugView::Background),
        ("debug view 1", |s| s.debug_view = DebugView::BackWater),
        ("debug view 2", |s| s.debug_view = DebugView::SurfaceFoam),
        ("debug view 3", |s| s.debug_view = DebugView::FrontWater),
        ("fresnel", |s| {
            s.water.fresnel = Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 };
        }),
    ];
    // Other tests here change the densities, the bed, ellipsoids and the foam's own noise; gravity
    // shows in waves that run.
    all_listed(
        "water",
        &base.water,
        &changes,
        &["density_threshold", "density_full", "bed", "ellipsoids"],
    );
    all_listed("water.wavelets", &base.water.wavelets, &changes, &["gravity"]);
    let others = ["noise", "noise_rate", "lace_size", "lace_shade", "few_neighbours"];
    all_listed("surface_foam", &base.surface_foam, &changes, &others);
    all_listed("spray", &base.spray, &changes, &["strand_ratio", "few_neighbours"]);
    // Noise in the air needs water on the scene.
    all_listed("noise", &base.noise, &changes, &["airborne"]);
    all_listed("light", &base.light, &changes, &[]);
    let mut draw = drawer(case, &mut rig);
    all_show("layered", &base, &changes, &mut draw);
    let lace: [Change; 2] = [
        ("surface_foam.lace_size", |s| s.surface_foam.lace_size = 8.0),
        ("surface_foam.lace_shade", |s| s.surface_foam.lace_shade = 1.0),
    ];
    let mut laced = base;
    laced.surface_foam.lace = 0.5;
    all_show("lace", &laced, &lace, draw);
}

/// These settings show with ellipsoids, and not with spheres.
#[test]
fn every_setting_of_ellipsoids_shows() {
    let gpu = Gpu::shared();
    let changes: [Change; 8] = [
        ("spray.strand_ratio", |s| s.spray.strand_ratio = 4.0),
        ("spray.few_neighbours", |s| s.spray.few_neighbours = [1.0, 40.0]),
        ("surface_foam.few_neighbours", |s| s.surface_foam.few_neighbours = [1.0, 40.0]),
        ("water.ellipsoids.reach", |s| s.water.ellipsoids.reach = 4.0),
        ("water.ellipsoids.ratio", |s| s.water.ellipsoids.ratio = 1.5),
        ("water.ellipsoids.fewest", |s| s.water.ellipsoids.fewest = 4.0),
        ("water.ellipsoids.lone", |s| s.water.ellipsoids.lone = 0.5),
        ("water.ellipsoids.centred", |s| s.water.ellipsoids.centred = 0.2),
    ];
    let ellipsoids = Settings::default().water.ellipsoids;
    all_listed("water.ellipsoids", &ellipsoids, &changes, &[]);
    for kernels in [Kernels::Ellipsoids, Kernels::Spheres] {
        let config = config(SIZE).with(|it| {
            it.spray = true;
            it.surface_foam = true;
            it.kernels = kernels;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = layered();
        case.shot.light_volume = None;
        // The particles are far apart.
        case.shot.settings.water.ellipsoids.fewest = 0.5;
        let base = case.shot.settings.clone();
        let draw = drawer(case, &mut rig);
        match kernels {
            Kernels::Ellipsoids => all_show("ellipsoids", &base, &changes, draw),
            _ => none_show("spheres", &base, &changes, draw),
        }
    }
}

/// Settings of the alternatives that the layered scene does not use.
#[test]
fn every_setting_of_the_other_modes_shows() {
    let gpu = Gpu::shared();
    let plain = config(SIZE).with(|it| {
        it.surface_foam = true;
        it.thickness_level = 0;
    });
    let mut rig = Rig::lit(&gpu, &plain, 1);
    let mut case = layered();
    case.shot.light_volume = None;
    let look = &mut case.shot.settings.surface_foam;
    (look.pattern, look.noise) = (0.0, 0.5);
    let source = Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 };
    case.shot.settings.water.fresnel = source;
    case.shot.settings.water.medium = Medium::source(case.shot.settings.water.spacing);
    let base = case.shot.settings.clone();
    let changes: [Change; 10] = [
        // Without spray, these settings select which particles are water.
        ("water.density_threshold", |s| s.water.density_threshold = 0.42),
        ("water.density_full", |s| s.water.density_full = 0.9),
        ("water.fresnel.bias", |s| {
            s.water.fresnel = Fresnel::Source { bias: 0.2, scale: 0.4, power: 2.0 };
        }),
        ("water.fresnel.scale", |s| {
            s.water.fresnel = Fresnel::Source { bias: 0.1, scale: 0.6, power: 2.0 };
        }),
        ("water.fresnel.power", |s| {
            s.water.fresnel = Fresnel::Source { bias: 0.1, scale: 0.4, power: 4.0 };
        }),
        ("water.medium.base", |s| change_source(s, |base, _| base[0] = 0.9)),
        ("water.medium.falloff", |s| change_source(s, |_, falloff| falloff[1] *= 2.0)),
        ("water.medium.falloff of what is behind", |s| {
            change_source(s, |_, falloff| falloff[3] *= 2.0)
        }),
        ("surface_foam.noise", |s| s.surface_foam.noise = 1.0),
        ("surface_foam.noise_rate", |s| s.surface_foam.noise_rate = 50.0),
    ];
    all_show("other modes", &base, &changes, drawer(case, &mut rig));
    // Some of this water touches the wall.
    let mut case = layered();
    case.shot.light_volume = None;
    case.shot.scene_depth(|_, _| Some(5.0));
    let base = case.shot.settings.clone();
    let bed: [Change; 1] = [("water.bed", |s| s.water.bed = Bed::Source)];
    all_show("bed", &base, &bed, drawer(case, &mut rig));
    // The source's rule of the smoothing has its own width, so this setting has no effect.
    let ruled = plain.with(|it| it.rule = Rule::Source);
    let mut rig = Rig::lit(&gpu, &ruled, 1);
    let mut case = layered();
    case.shot.light_volume = None;
    let base = case.shot.settings.clone();
    let width: [Change; 1] = [("water.smoothing_width", |s| s.water.smoothing_width *= 2.0)];
    none_show("the source's rule", &base, &width, drawer(case, &mut rig));
}

fn change_source(settings: &mut Settings, change: fn(&mut [f32; 3], &mut [f32; 4])) {
    if let Medium::Source { base, falloff } = &mut settings.water.medium {
        change(base, falloff);
    }
}

/// Settings of a filtered shadow map.
#[test]
fn every_setting_of_the_shadow_filter_shows() {
    let gpu = Gpu::shared();
    let convolution = Convolution { texels: 64, ..Convolution::default() };
    let shadow = Some(Shadows::Convolution(convolution));
    let config = config(SIZE).with(|it| {
        it.surface_foam = true;
        it.shadow = shadow;
        it.thickness_level = 0;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = layered();
    case.shot.light_volume = None;
    let middle = Vec3::from(scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0]);
    let sun = Vec3::from(case.shot.settings.light.direction);
    let light = Mat4::look_at_rh(middle + 20.0 * sun, middle, Vec3::Y);
    let view_projection = Mat4::orthographic_rh(-9.0, 9.0, -9.0, 9.0, 1.0, 40.0) * light;
    let map = Image::from_fn(64, 64, |x, y| if (x / 9 + y / 7) % 2 == 0 { 0.3 } else { 0.9 });
    let image = shadows(&rig, Shadows::Convolution(convolution), &map);
    case.shot.shadow = Some(
        Shadow::new(image.host_image(), view_projection.to_cols_array_2d())
            .with(|it| it.bias = 0.05),
    );
    let base = case.shot.settings.clone();
    let changes: [Change; 4] = [
        ("shadow.width", |s| s.shadow.width = 6.0),
        ("shadow.damping", |s| s.shadow.damping = 0.3),
        ("shadow.offset", |s| s.shadow.offset = 0.2),
        ("shadow.scale", |s| s.shadow.scale = 1.0),
    ];
    all_listed("shadow", &base.shadow, &changes, &[]);
    all_show("shadow filter", &base, &changes, drawer(case, &mut rig));
}

/// Whitewater particles around some water.
fn heap(size: vk::Extent2D) -> (Shot, Vec<[f32; 3]>, Vec<u32>, Vec<f32>) {
    let mut shot = Shot::new(size, Lens::Standard, 0.2, &scenes::cloud(31, 60, 3.0, 6.0));
    let positions = scenes::world(&shot.camera, &scenes::cloud(7, 600, 2.5, 6.5));
    shot.settings.whitewater.radius = 0.3;
    // The right half of the scene is a wall, close behind some particles.
    shot.scene_depth(|x, _| Some(if x < size.width / 2 { 8.5 } else { 5.0 }));
    let n = positions.len();
    let mut random = Random(3);
    let kinds = (0..n).map(|i| i as u32 % 3).collect();
    let ages = (0..n).map(|_| random.between(0.0, 1.0)).collect();
    (shot, positions, kinds, ages)
}

fn heap_drawer<'r>(rig: &'r mut Rig<'_>) -> (Settings, impl FnMut(&Settings) -> Drawn + 'r) {
    let (mut shot, positions, kinds, ages) = heap(rig.config.extent);
    let base = shot.settings.clone();
    let draw = move |settings: &Settings| {
        shot.settings = settings.clone();
        let water = rig.particles(&shot);
        let input = Whitewater {
            positions: &positions,
            kinds: Some(&kinds),
            radii: None,
            ages: Some(&ages),
            ids: None,
        };
        let cloud = rig.whitewater(&input);
        rig.draw_whitewater(&shot, &water.particles(), Some(cloud.particles()))
    };
    (base, draw)
}

#[test]
fn every_setting_of_whitewater_particles_shows() {
    let gpu = Gpu::shared();
    let changes: [Change; 26] = [
        ("whitewater.radius", |s| s.whitewater.radius *= 1.2),
        ("whitewater.submerged", |s| s.whitewater.submerged = FALLOFF),
        ("whitewater.half_intensity_thickness", |s| s.whitewater.half_intensity_thickness = 1.0),
        ("whitewater.exponent", |s| s.whitewater.exponent = 2.0),
        ("whitewater.passes", |s| s.whitewater.passes = 1),
        ("whitewater.search_radius", |s| s.whitewater.search_radius = 3.0),
        ("whitewater.search_radius_step", |s| s.whitewater.search_radius_step = 2.0),
        ("whitewater.max_samples", |s| s.whitewater.max_samples = 40),
        ("whitewater.reach", |s| s.whitewater.reach = OcclusionReach::Radii(0.3)),
        ("whitewater.reach in metres", |s| s.whitewater.reach = OcclusionReach::Metres(0.2)),
        ("whitewater.fluid_opacity", |s| s.whitewater.fluid_opacity = 1.0),
        ("whitewater.scene_opacity", |s| s.whitewater.scene_opacity = 0.2),
        ("whitewater.shadow_scale", |s| s.whitewater.shadow_scale = 2.0),
        ("whitewater.shadow_exponent", |s| s.whitewater.shadow_exponent = 0.8),
        ("whitewater.shadow_offset", |s| s.whitewater.shadow_offset = 0.1),
        ("whitewater.shadow_color", |s| s.whitewater.shadow_color = [0.5; 3]),
        ("whitewater.albedo", |s| s.whitewater.albedo = [0.5; 3]),
        ("whitewater.mixing", |s| s.whitewater.mixing = ShadowMixing::Source),
        ("whitewater.scale", |s| s.whitewater.scale = 2.0),
        ("whitewater.foam_shape", |s| s.whitewater.foam_shape = [1.5, 1.0]),
        ("whitewater.spray_shape", |s| s.whitewater.spray_shape = [2.25, 1.0]),
        ("whitewater.bubble_shape", |s| s.whitewater.bubble_shape = [2.0, 2.0]),
        ("whitewater.life", |s| s.whitewater.life = [1.0, 0.4]),
        ("whitewater.sizes", |s| s.whitewater.sizes = 2),
        ("whitewater.bubble_size", |s| s.whitewater.bubble_size = 1.0),
        ("whitewater.blur", |s| s.whitewater.blur = 6.0),
    ];
    let look = Settings::default().whitewater;
    all_listed("whitewater", &look, &changes, &["sample_density", "min_samples"]);
    let falloff: [Change; 3] = [
        ("whitewater.submerged.most", |s| {
            s.whitewater.submerged = Submerged::Falloff { depth: 0.8, n: 2.0, m: 4.0 };
        }),
        ("whitewater.submerged.n", |s| {
            s.whitewater.submerged = Submerged::Falloff { depth: 2.0, n: 1.0, m: 4.0 };
        }),
        ("whitewater.submerged.m", |s| {
            s.whitewater.submerged = Submerged::Falloff { depth: 2.0, n: 2.0, m: 1.0 };
        }),
    ];
    // The number of samples depends on a sphere's size in pixels only in the reference, as
    // `WhitewaterSettings` documents.
    let points: [Change; 2] = [
        ("whitewater.sample_density", |s| s.whitewater.sample_density = 0.01),
        ("whitewater.min_samples", |s| s.whitewater.min_samples = 300),
    ];
    for occlusion in [Occlusion::Fast, Occlusion::Reference] {
        let whitewater = WhitewaterConfig::new(4096).with(|it| it.occlusion = occlusion);
        let mut rig = Rig::lit(&gpu, &config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
        let (mut base, mut draw) = heap_drawer(&mut rig);
        all_show(&format!("{occlusion:?}"), &base, &changes, &mut draw);
        match occlusion {
            Occlusion::Fast => none_show("Fast", &base, &points, &mut draw),
            Occlusion::Reference => all_show("Reference", &base, &points, &mut draw),
        }
        base.whitewater.submerged = FALLOFF;
        all_show("falloff", &base, &falloff, &mut draw);
    }
}

const FALLOFF: Submerged = Submerged::Falloff { depth: 2.0, n: 2.0, m: 4.0 };

#[test]
fn every_setting_of_bubble_foam_shows() {
    let gpu = Gpu::shared();
    let size = extent(112, 96);
    let bubbles = BubbleConfig::new(64).with(|it| {
        it.variants = 3;
        it.bubbles = 28;
    });
    let mut rig = Rig::lit(&gpu, &config(size).with(|it| it.bubbles = Some(bubbles)), 1);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let mut random = Random(11);
    let mut blob = |place: [f32; 3], radius: f32, id| {
        let [x, y, z] = scenes::world(&shot.camera, &[place])[0];
        let turn = glam::Vec4::from([0; 4].map(|_| random.between(-1.0, 1.0))).normalize();
        Bubble { ball: [x, y, z, radius], turn: turn.to_array(), id }
    };
    let mut blobs: Vec<_> = (0..24_u8)
        .map(|i| {
            let [x, y, z] = [i % 6, i / 6, i % 5].map(f32::from);
            blob([0.5 * (x - 3.0), 0.5 * (y - 2.0), 3.0 + 0.1 * z], 0.5, u32::from(i))
        })
        .collect();
    // Blobs of about three pixels.
    let small = |i: u8| ([0.1 * f32::from(i) - 0.4, -1.3, 3.0], 0.1, 100 + u32::from(i));
    blobs.extend((0..8).map(small).map(|(place, radius, id)| blob(place, radius, id)));
    shot.blobs = blobs;
    // The sun is in the direction of the eye.
    let eye = shot.camera.view_matrix().inverse().transform_point3(Vec3::ZERO);
    let [x, y, z] = scenes::world(&shot.camera, &[[0.0, 0.0, 3.0]])[0];
    shot.settings.light.direction = (eye - Vec3::new(x, y, z)).normalize().to_array();
    let base = shot.settings.clone();
    let changes: [Change; 14] = [
        ("bubbles.film", |s| s.bubbles.film = 500.0),
        ("bubbles.variation", |s| s.bubbles.variation = 0.1),
        ("bubbles.drainage", |s| s.bubbles.drainage = 0.1),
        ("bubbles.core_opaque_radius", |s| s.bubbles.core_opaque_radius = 0.4),
        ("bubbles.core_outer_radius", |s| s.bubbles.core_outer_radius = 1.2),
        ("bubbles.albedo", |s| s.bubbles.albedo = [0.5; 3]),
        ("bubbles.pattern", |s| s.bubbles.pattern = 0.2),
        ("bubbles.distortion", |s| s.bubbles.distortion = 0.5),
        ("bubbles.roundness", |s| s.bubbles.roundness = 0.9),
        ("bubbles.reflection", |s| s.bubbles.reflection = 0.5),
        ("bubbles.shininess", |s| s.bubbles.shininess = 100.0),
        ("bubbles.walls", |s| s.bubbles.walls = false),
        ("bubbles.fill_holes", |s| s.bubbles.fill_holes = false),
        ("bubbles.min_pixels", |s| s.bubbles.min_pixels = 8.0),
    ];
    all_listed("bubbles", &base.bubbles, &changes, &["crossfade"]);
    all_show("bubbles", &base, &changes, |settings| {
        shot.settings = settings.clone();
        rig.draw(&shot)
    });
}

#[test]
fn every_setting_of_the_crossfade_shows() {
    let gpu = Gpu::shared();
    let bubbles = BubbleConfig::new(600).with(|it| {
        it.variants = 3;
        it.bubbles = 28;
        it.crossfade = true;
    });
    let whitewater = Some(WhitewaterConfig::new(4096));
    let mut rig = Rig::lit(
        &gpu,
        &config(SIZE).with(|it| {
            it.bubbles = Some(bubbles);
            it.whitewater = whitewater;
        }),
        1,
    );
    let (mut base, draw) = heap_drawer(&mut rig);
    base.bubbles.crossfade = Crossfade { near: 4.0, far: 5.0, size: 1.0 };
    let changes: [Change; 3] = [
        ("bubbles.crossfade.near", |s| s.bubbles.crossfade.near = 3.0),
        ("bubbles.crossfade.far", |s| s.bubbles.crossfade.far = 6.0),
        ("bubbles.crossfade.size", |s| s.bubbles.crossfade.size = 1.5),
    ];
    all_listed("bubbles.crossfade", &base.bubbles.crossfade, &changes, &[]);
    all_show("hand-over", &base, &changes, draw);
}
