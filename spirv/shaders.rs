/// `composite.comp`
pub const COMPOSITE_COMP: Shader = Shader {
    name: "composite.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/composite.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), (12, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (14, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (20, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Boundaries", "boundaries", 0), ("Arguments", "arguments", 0), ("List", "list", 0), ("Push", "first", 0), ],
};
/// `composite.frag`
pub const COMPOSITE_FRAG: Shader = Shader {
    name: "composite.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/composite.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), (12, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (14, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (20, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Boundaries", "boundaries", 0), ],
};
/// `composite.vert`
pub const COMPOSITE_VERT: Shader = Shader {
    name: "composite.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/composite.vert.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("List", "list", 0), ("Push", "first", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `environment/equirect.comp`
pub const ENVIRONMENT_EQUIRECT_COMP: Shader = Shader {
    name: "environment/equirect.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/environment.equirect.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Push", "size", 0), ("Push", "scale", 4), ("Push", "turn", 8), ],
};
/// `environment/sky.comp`
pub const ENVIRONMENT_SKY_COMP: Shader = Shader {
    name: "environment/sky.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/environment.sky.comp.spv"))); &CODE.0 },
    push_size: 20,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "sun", 0), ("Push", "size", 16), ],
};
/// `headless/depth.vert`
pub const HEADLESS_DEPTH_VERT: Shader = Shader {
    name: "headless/depth.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.depth.vert.spv"))); &CODE.0 },
    push_size: 64,
    local_size: [1, 1, 1],
    bindings: &[],
    members: &[("Push", "clip", 0), ],
};
/// `headless/irradiance.comp`
pub const HEADLESS_IRRADIANCE_COMP: Shader = Shader {
    name: "headless/irradiance.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.irradiance.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Irradiance", "irradiance", 0), ],
};
/// `headless/scene.frag`
pub const HEADLESS_SCENE_FRAG: Shader = Shader {
    name: "headless/scene.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.scene.frag.spv"))); &CODE.0 },
    push_size: 64,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Push", "turn", 0), ("Push", "origin", 16), ("Push", "color", 32), ("Push", "pattern", 48), ("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Irradiance", "irradiance", 0), ],
};
/// `headless/scene.vert`
pub const HEADLESS_SCENE_VERT: Shader = Shader {
    name: "headless/scene.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.scene.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ],
};
/// `headless/sky.frag`
pub const HEADLESS_SKY_FRAG: Shader = Shader {
    name: "headless/sky.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.sky.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ],
};
/// `headless/sky.vert`
pub const HEADLESS_SKY_VERT: Shader = Shader {
    name: "headless/sky.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.sky.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ],
};
/// `light/caustics.comp`
pub const LIGHT_CAUSTICS_COMP: Shader = Shader {
    name: "light/caustics.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.caustics.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Photons", "photons", 0), ],
};
/// `light/caustics_resolve.comp`
pub const LIGHT_CAUSTICS_RESOLVE_COMP: Shader = Shader {
    name: "light/caustics_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.caustics_resolve.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Photons", "photons", 0), ],
};
/// `light/cover.vert`
pub const LIGHT_COVER_VERT: Shader = Shader {
    name: "light/cover.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.cover.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[],
    members: &[],
};
/// `light/front.frag`
pub const LIGHT_FRONT_FRAG: Shader = Shader {
    name: "light/front.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.front.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `light/lit.frag`
pub const LIGHT_LIT_FRAG: Shader = Shader {
    name: "light/lit.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.lit.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `light/lit_out.comp`
pub const LIGHT_LIT_OUT_COMP: Shader = Shader {
    name: "light/lit_out.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.lit_out.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (8, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `light/lit_out.frag`
pub const LIGHT_LIT_OUT_FRAG: Shader = Shader {
    name: "light/lit_out.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.lit_out.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `light/smooth.comp`
pub const LIGHT_SMOOTH_COMP: Shader = Shader {
    name: "light/smooth.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.smooth.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "vertical", 0), ],
};
/// `light/sprites.vert`
pub const LIGHT_SPRITES_VERT: Shader = Shader {
    name: "light/sprites.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.sprites.vert.spv"))); &CODE.0 },
    push_size: 28,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "foam_word", 16), ("Push", "foam_stride", 20), ("Push", "front", 24), ("Positions", "positions", 0), ("Densities", "densities", 0), ("Amounts", "amounts", 0), ],
};
/// `light/thickness.frag`
pub const LIGHT_THICKNESS_FRAG: Shader = Shader {
    name: "light/thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/back.comp`
pub const WATER_BACK_COMP: Shader = Shader {
    name: "water/back.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.back.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Blocks", "blocks", 0), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Push", "capacity", 0), ],
};
/// `water/back_begin.comp`
pub const WATER_BACK_BEGIN_COMP: Shader = Shader {
    name: "water/back_begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.back_begin.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Tiles", "tile_work", 0), ],
};
/// `water/back_plan.comp`
pub const WATER_BACK_PLAN_COMP: Shader = Shader {
    name: "water/back_plan.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.back_plan.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Tiles", "tile_work", 0), ],
};
/// `water/classify.comp`
pub const WATER_CLASSIFY_COMP: Shader = Shader {
    name: "water/classify.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.classify.comp.spv"))); &CODE.0 },
    push_size: 80,
    local_size: [64, 1, 1],
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "velocity_word", 0), ("Push", "velocity_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "first", 24), ("Push", "count", 28), ("Push", "from_gpu", 32), ("Push", "chunk_end", 36), ("Push", "rows", 40), ("Push", "seed", 44), ("Push", "scale", 48), ("Push", "threshold", 52), ("Push", "foam_lifetime", 56), ("Push", "dt", 60), ("Push", "air_x", 64), ("Push", "air_y", 68), ("Push", "air_z", 72), ("Push", "rest_density", 76), ("Velocities", "velocities", 0), ("Densities", "densities", 0), ("Row", "key", 0), ("Row", "phase", 4), ("Row", "timer", 8), ("Row", "lifetime", 12), ("Row", "age", 16), ("Old", "old_rows", 0), ("New", "new_rows", 0), ("HostCount", "host_count", 0), ("Foam", "foam", 0), ("Ids", "ids", 0), ],
};
/// `water/cull.comp`
pub const WATER_CULL_COMP: Shader = Shader {
    name: "water/cull.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.cull.comp.spv"))); &CODE.0 },
    push_size: 40,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "chunk_first", 16), ("Push", "capacity", 20), ("Push", "small_limit", 24), ("Push", "small_inside", 28), ("Push", "foam_word", 32), ("Push", "foam_stride", 36), ("Amounts", "amounts", 0), ("Positions", "positions", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Densities", "densities", 0), ("Visible", "visible", 0), ("Shares", "shares", 0), ("HostPackets", "packets", 0), ],
};
/// `water/cull_begin.comp`
pub const WATER_CULL_BEGIN_COMP: Shader = Shader {
    name: "water/cull_begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.cull_begin.comp.spv"))); &CODE.0 },
    push_size: 24,
    local_size: [32, 1, 1],
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "count", 0), ("Push", "from_gpu", 4), ("Push", "chunks", 8), ("Push", "chunk_size", 12), ("Push", "packets", 16), ("Push", "group_size", 20), ("HostCount", "host_count", 0), ("AllCounts", "words", 0), ],
};
/// `water/cull_end.comp`
pub const WATER_CULL_END_COMP: Shader = Shader {
    name: "water/cull_end.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.cull_end.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [32, 1, 1],
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "chunks", 0), ("Push", "group_size", 4), ("Push", "most_groups", 8), ("AllCounts", "words", 0), ],
};
/// `water/depth.comp`
pub const WATER_DEPTH_COMP: Shader = Shader {
    name: "water/depth.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.depth.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Push", "capacity", 0), ],
};
/// `water/depth.frag`
pub const WATER_DEPTH_FRAG: Shader = Shader {
    name: "water/depth.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.depth.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/depth.vert`
pub const WATER_DEPTH_VERT: Shader = Shader {
    name: "water/depth.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.depth.vert.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "capacity", 0), ("Visible", "visible", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/foam.vert`
pub const WATER_FOAM_VERT: Shader = Shader {
    name: "water/foam.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("FoamSprite", "centre", 0), ("FoamSprite", "velocity", 16), ("FoamSprite", "rest", 32), ("Sprites", "sprites", 0), ],
};
/// `water/foam_depth.frag`
pub const WATER_FOAM_DEPTH_FRAG: Shader = Shader {
    name: "water/foam_depth.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_depth.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/foam_list.comp`
pub const WATER_FOAM_LIST_COMP: Shader = Shader {
    name: "water/foam_list.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_list.comp.spv"))); &CODE.0 },
    push_size: 44,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "amount_word", 8), ("Push", "amount_stride", 12), ("Push", "velocity_word", 16), ("Push", "velocity_stride", 20), ("Push", "id_word", 24), ("Push", "id_stride", 28), ("Push", "density_word", 32), ("Push", "density_stride", 36), ("Push", "chunk_first", 40), ("Amounts", "amounts", 0), ("Densities", "densities", 0), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Ids", "ids", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("FoamSprite", "centre", 0), ("FoamSprite", "velocity", 16), ("FoamSprite", "rest", 32), ("Sprites", "sprites", 0), ],
};
/// `water/foam_thickness.frag`
pub const WATER_FOAM_THICKNESS_FRAG: Shader = Shader {
    name: "water/foam_thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/front.comp`
pub const WATER_FRONT_COMP: Shader = Shader {
    name: "water/front.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.front.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Cells", "cells", 0), ("Push", "capacity", 0), ("Push", "columns", 4), ("Push", "rows", 8), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("FrontCounts", "front_counts", 0), ("Front", "front", 0), ],
};
/// `water/front_cover.comp`
pub const WATER_FRONT_COVER_COMP: Shader = Shader {
    name: "water/front_cover.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.front_cover.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "capacity", 0), ("Push", "columns", 4), ("Push", "rows", 8), ("Cells", "cells", 0), ],
};
/// `water/gaps.comp`
pub const WATER_GAPS_COMP: Shader = Shader {
    name: "water/gaps.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Cells", "cells", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Push", "capacity", 0), ],
};
/// `water/gaps_blocks.comp`
pub const WATER_GAPS_BLOCKS_COMP: Shader = Shader {
    name: "water/gaps_blocks.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_blocks.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Blocks", "blocks", 0), ],
};
/// `water/gaps_find.comp`
pub const WATER_GAPS_FIND_COMP: Shader = Shader {
    name: "water/gaps_find.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_find.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Cells", "cells", 0), ("Push", "columns", 0), ("Push", "rows", 4), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Found", "found", 0), ],
};
/// `water/gaps_spread.comp`
pub const WATER_GAPS_SPREAD_COMP: Shader = Shader {
    name: "water/gaps_spread.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_spread.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "columns", 0), ("Push", "rows", 4), ("Found", "found", 0), ("Spread", "spread", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/gaps_texels.comp`
pub const WATER_GAPS_TEXELS_COMP: Shader = Shader {
    name: "water/gaps_texels.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_texels.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "columns", 0), ("Push", "rows", 4), ("Spread", "spread", 0), ("Boundaries", "boundaries", 0), ],
};
/// `water/level.comp`
pub const WATER_LEVEL_COMP: Shader = Shader {
    name: "water/level.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.level.comp.spv"))); &CODE.0 },
    push_size: 24,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "atlas", 0), ("Push", "coarsening", 16), ("Push", "back", 20), ("Over", "over", 0), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Arguments", "arguments", 0), ],
};
/// `water/level_reduce.comp`
pub const WATER_LEVEL_REDUCE_COMP: Shader = Shader {
    name: "water/level_reduce.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.level_reduce.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Tiles", "tile_work", 0), ],
};
/// `water/noise.frag`
pub const WATER_NOISE_FRAG: Shader = Shader {
    name: "water/noise.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.noise.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/noise.vert`
pub const WATER_NOISE_VERT: Shader = Shader {
    name: "water/noise.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.noise.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Sprites", "sprites", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/noise_list.comp`
pub const WATER_NOISE_LIST_COMP: Shader = Shader {
    name: "water/noise_list.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.noise_list.comp.spv"))); &CODE.0 },
    push_size: 28,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "chunk_first", 24), ("Densities", "densities", 0), ("Positions", "positions", 0), ("Ids", "ids", 0), ("Sprites", "sprites", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ],
};
/// `water/reduce.comp`
pub const WATER_REDUCE_COMP: Shader = Shader {
    name: "water/reduce.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.reduce.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Tiles", "tile_work", 0), ("Push", "columns", 0), ("Over", "over", 0), ],
};
/// `water/smooth.comp`
pub const WATER_SMOOTH_COMP: Shader = Shader {
    name: "water/smooth.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "iteration", 0), ("Push", "columns", 4), ("Arguments", "arguments", 0), ("List", "list", 0), ],
};
/// `water/smooth.frag`
pub const WATER_SMOOTH_FRAG: Shader = Shader {
    name: "water/smooth.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth.frag.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "iteration", 0), ("Push", "columns", 4), ("Push", "block", 8), ],
};
/// `water/smooth.vert`
pub const WATER_SMOOTH_VERT: Shader = Shader {
    name: "water/smooth.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth.vert.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [1, 1, 1],
    bindings: &[(3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("List", "list", 0), ("Push", "iteration", 0), ("Push", "columns", 4), ("Push", "block", 8), ("Predicates", "predicates", 0), ],
};
/// `water/smooth_fused.comp`
pub const WATER_SMOOTH_FUSED_COMP: Shader = Shader {
    name: "water/smooth_fused.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth_fused.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [32, 8, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Push", "iteration", 0), ("Push", "columns", 4), ("Push", "arguments_index", 8), ("Arguments", "arguments", 0), ("List", "list", 0), ],
};
/// `water/smooth_gate.comp`
pub const WATER_SMOOTH_GATE_COMP: Shader = Shader {
    name: "water/smooth_gate.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth_gate.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Predicates", "predicates", 0), ("Push", "block", 0), ("Results", "results", 0), ],
};
/// `water/split.comp`
pub const WATER_SPLIT_COMP: Shader = Shader {
    name: "water/split.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.split.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [8, 8, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Lists", "lists", 0), ("Push", "tiles", 0), ("Lengths", "lengths", 0), ("Arguments", "arguments", 0), ("List", "list", 0), ],
};
/// `water/split_end.comp`
pub const WATER_SPLIT_END_COMP: Shader = Shader {
    name: "water/split_end.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.split_end.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Lengths", "lengths", 0), ("Arguments", "arguments", 0), ],
};
/// `water/spray.frag`
pub const WATER_SPRAY_FRAG: Shader = Shader {
    name: "water/spray.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.spray.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/spray.vert`
pub const WATER_SPRAY_VERT: Shader = Shader {
    name: "water/spray.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.spray.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("SpraySprite", "centre", 0), ("SpraySprite", "velocity", 16), ("Sprites", "sprites", 0), ],
};
/// `water/spray_list.comp`
pub const WATER_SPRAY_LIST_COMP: Shader = Shader {
    name: "water/spray_list.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.spray_list.comp.spv"))); &CODE.0 },
    push_size: 36,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Densities", "densities", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "velocity_word", 16), ("Push", "velocity_stride", 20), ("Push", "id_word", 24), ("Push", "id_stride", 28), ("Push", "chunk_first", 32), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Ids", "ids", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("SpraySprite", "centre", 0), ("SpraySprite", "velocity", 16), ("Sprites", "sprites", 0), ],
};
/// `water/thickness.comp`
pub const WATER_THICKNESS_COMP: Shader = Shader {
    name: "water/thickness.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Visible", "visible", 0), ("Shares", "shares", 0), ("Sums", "sums", 0), ("Boundaries", "boundaries", 0), ("Blocks", "blocks", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("CountBuffer", "counts", 0), ("Push", "capacity", 0), ],
};
/// `water/thickness.frag`
pub const WATER_THICKNESS_FRAG: Shader = Shader {
    name: "water/thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/thickness.vert`
pub const WATER_THICKNESS_VERT: Shader = Shader {
    name: "water/thickness.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness.vert.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "capacity", 0), ("Visible", "visible", 0), ("Shares", "shares", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
/// `water/thickness_apart.comp`
pub const WATER_THICKNESS_APART_COMP: Shader = Shader {
    name: "water/thickness_apart.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_apart.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Sums", "sums", 0), ("Boundaries", "boundaries", 0), ],
};
/// `water/thickness_apart.frag`
pub const WATER_THICKNESS_APART_FRAG: Shader = Shader {
    name: "water/thickness_apart.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_apart.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Boundaries", "boundaries", 0), ],
};
/// `water/thickness_before.comp`
pub const WATER_THICKNESS_BEFORE_COMP: Shader = Shader {
    name: "water/thickness_before.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_before.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Sums", "sums", 0), ],
};
/// `water/thickness_resolve.comp`
pub const WATER_THICKNESS_RESOLVE_COMP: Shader = Shader {
    name: "water/thickness_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_resolve.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ("Sums", "sums", 0), ],
};
/// `water/tiles.comp`
pub const WATER_TILES_COMP: Shader = Shader {
    name: "water/tiles.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.tiles.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [256, 1, 1],
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 144), ("Tiles", "tile_work", 0), ("Push", "tiles", 0), ("Push", "most_groups", 4), ("Arguments", "arguments", 0), ("List", "list", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "reduced_slope", 304), ("Frame", "thick_slope", 320), ("Frame", "texel", 336), ("Frame", "scene_depth", 352), ("Frame", "scene_color", 368), ("Frame", "scene_origin", 384), ("Frame", "target", 400), ("Frame", "particle", 416), ("Frame", "density", 432), ("Frame", "smoothing", 448), ("Frame", "medium_a", 464), ("Frame", "medium_b", 480), ("Frame", "fresnel", 496), ("Frame", "surface", 512), ("Frame", "sun_direction", 528), ("Frame", "sun_color", 544), ("Frame", "ambient", 560), ("Frame", "foam", 576), ("Frame", "foam_noise", 592), ("Frame", "foam_back", 608), ("Frame", "foam_front", 624), ("Frame", "spray", 640), ("Frame", "spray_color", 656), ("Frame", "shadow", 672), ("Frame", "to_light", 736), ("Frame", "shadow_map", 800), ("Frame", "shadow_rect", 816), ("Frame", "light_map", 832), ("Frame", "shade", 848), ("Frame", "lit_color", 864), ("Frame", "lit_origin", 880), ("Frame", "noise", 896), ("Frame", "noise_image", 912), ("Frame", "noise_color", 928), ],
};
