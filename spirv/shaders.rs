/// `bubbles/begin.comp`
pub const BUBBLES_BEGIN_COMP: Shader = Shader {
    name: "bubbles/begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.begin.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [256, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("BlobRange", "nearest", 0), ("BlobRange", "farthest", 4), ("BlobRange", "seen", 8), ("BlobRange", "dropped", 12), ("BlobRange", "taken", 16), ("Range", "range", 0), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("Cells", "cells", 0), ("Spans", "spans", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `bubbles/blobs.comp`
pub const BUBBLES_BLOBS_COMP: Shader = Shader {
    name: "bubbles/blobs.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.blobs.comp.spv"))); &CODE.0 },
    push_size: 32,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("Push", "ball_word", 0), ("Push", "ball_stride", 4), ("Push", "turn_word", 8), ("Push", "turn_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "most", 24), ("Push", "from_gpu", 28), ("Turns", "turns", 0), ("Balls", "balls", 0), ("BlobRange", "nearest", 0), ("BlobRange", "farthest", 4), ("BlobRange", "seen", 8), ("BlobRange", "dropped", 12), ("BlobRange", "taken", 16), ("Range", "range", 0), ("Ids", "ids", 0), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("Count", "count", 0), ("Cells", "cells", 0), ("Spans", "spans", 0), ("List", "list", 0), ],
};
/// `bubbles/cast.comp`
pub const BUBBLES_CAST_COMP: Shader = Shader {
    name: "bubbles/cast.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.cast.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "most", 0), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ],
};
/// `bubbles/core.comp`
pub const BUBBLES_CORE_COMP: Shader = Shader {
    name: "bubbles/core.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.core.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "size", 0), ("Push", "seed", 4), ],
};
/// `bubbles/film.comp`
pub const BUBBLES_FILM_COMP: Shader = Shader {
    name: "bubbles/film.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.film.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "index", 0), ("Push", "most", 4), ],
};
/// `bubbles/heap_move.comp`
pub const BUBBLES_HEAP_MOVE_COMP: Shader = Shader {
    name: "bubbles/heap_move.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.heap_move.comp.spv"))); &CODE.0 },
    push_size: 128,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "gravity", 0), ("Push", "pair", 16), ("Push", "damping", 32), ("Push", "solid", 48), ("Push", "water", 64), ("Push", "field", 80), ("Push", "field_size", 96), ("Push", "blobs", 112), ("Push", "buckets", 116), ("Push", "cells", 120), ("Push", "halvings", 124), ("Field", "field", 0), ("Growth", "goal", 0), ("Growth", "parted", 4), ("Growth", "alone", 8), ("Growth", "halved", 12), ("Growths", "growths", 0), ("Balls", "balls", 0), ("Turns", "turns", 0), ("Ids", "ids", 0), ("Drifts", "drifts", 0), ("Spins", "spins", 0), ("Buckets", "buckets", 0), ("Heaped", "ball", 0), ("Heaped", "drift", 16), ("Heaped", "spin", 32), ("Heap", "heaped", 0), ("Solid", "place", 0), ("Solid", "size", 16), ("Solid", "turn", 32), ("Solids", "solids", 0), ],
};
/// `bubbles/heap_order.comp`
pub const BUBBLES_HEAP_ORDER_COMP: Shader = Shader {
    name: "bubbles/heap_order.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.heap_order.comp.spv"))); &CODE.0 },
    push_size: 128,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "gravity", 0), ("Push", "pair", 16), ("Push", "damping", 32), ("Push", "solid", 48), ("Push", "water", 64), ("Push", "field", 80), ("Push", "field_size", 96), ("Push", "blobs", 112), ("Push", "buckets", 116), ("Push", "cells", 120), ("Push", "halvings", 124), ("Buckets", "buckets", 0), ("Order", "order", 0), ("Ids", "ids", 0), ("Heaped", "ball", 0), ("Heaped", "drift", 16), ("Heaped", "spin", 32), ("Heap", "heaped", 0), ("Balls", "balls", 0), ("Drifts", "drifts", 0), ("Spins", "spins", 0), ],
};
/// `bubbles/heap_place.comp`
pub const BUBBLES_HEAP_PLACE_COMP: Shader = Shader {
    name: "bubbles/heap_place.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.heap_place.comp.spv"))); &CODE.0 },
    push_size: 128,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "gravity", 0), ("Push", "pair", 16), ("Push", "damping", 32), ("Push", "solid", 48), ("Push", "water", 64), ("Push", "field", 80), ("Push", "field_size", 96), ("Push", "blobs", 112), ("Push", "buckets", 116), ("Push", "cells", 120), ("Push", "halvings", 124), ("Balls", "balls", 0), ("Buckets", "buckets", 0), ("Order", "order", 0), ],
};
/// `bubbles/heap_set.comp`
pub const BUBBLES_HEAP_SET_COMP: Shader = Shader {
    name: "bubbles/heap_set.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.heap_set.comp.spv"))); &CODE.0 },
    push_size: 40,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "ball_word", 0), ("Push", "ball_stride", 4), ("Push", "turn_word", 8), ("Push", "turn_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "drift_word", 24), ("Push", "drift_stride", 28), ("Push", "blobs", 32), ("Push", "all", 36), ("Balls", "balls", 0), ("Turns", "turns", 0), ("Ids", "ids", 0), ("Drifts", "drifts", 0), ("Spins", "spins", 0), ("Growth", "goal", 0), ("Growth", "parted", 4), ("Growth", "alone", 8), ("Growth", "halved", 12), ("Growths", "growths", 0), ("HostBalls", "host_balls", 0), ("HostTurns", "host_turns", 0), ("HostDrifts", "host_drifts", 0), ("HostIds", "host_ids", 0), ],
};
/// `bubbles/impostor.comp`
pub const BUBBLES_IMPOSTOR_COMP: Shader = Shader {
    name: "bubbles/impostor.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.impostor.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "count", 0), ("Push", "size", 4), ("Bubbles", "bubbles", 0), ("Ids", "ids", 0), ],
};
/// `bubbles/near.comp`
pub const BUBBLES_NEAR_COMP: Shader = Shader {
    name: "bubbles/near.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.near.comp.spv"))); &CODE.0 },
    push_size: 52,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), (12, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("HandOver", "near", 0), ("HandOver", "far", 4), ("HandOver", "rings", 8), ("HandOver", "blobs", 12), ("Over", "hand_over", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "kind_word", 8), ("Push", "kind_stride", 12), ("Push", "radius_word", 16), ("Push", "radius_stride", 20), ("Push", "age_word", 24), ("Push", "age_stride", 28), ("Push", "id_word", 32), ("Push", "id_stride", 36), ("Push", "chunk_first", 40), ("Push", "chunk", 44), ("Push", "room", 48), ("Positions", "positions", 0), ("Ages", "ages", 0), ("Ids", "ids", 0), ("Kinds", "kinds", 0), ("Radii", "radii", 0), ("Arguments", "arguments", 0), ("Numbers", "numbers", 0), ("Count", "count", 0), ("Balls", "balls", 0), ("Turns", "turns", 0), ("BlobIds", "blob_ids", 0), ],
};
/// `bubbles/near_range.comp`
pub const BUBBLES_NEAR_RANGE_COMP: Shader = Shader {
    name: "bubbles/near_range.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.near_range.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [128, 1, 1],
    shared: 512,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Numbers", "numbers", 0), ("Push", "room", 0), ("HandOver", "near", 0), ("HandOver", "far", 4), ("HandOver", "rings", 8), ("HandOver", "blobs", 12), ("Over", "hand_over", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `bubbles/peel.comp`
pub const BUBBLES_PEEL_COMP: Shader = Shader {
    name: "bubbles/peel.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.peel.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_IMAGE), (12, vk::DescriptorType::STORAGE_BUFFER), (13, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("BlobIds", "blob_ids", 0), ("Bubbles", "bubbles", 0), ("Neighbours", "neighbours", 0), ("Spans", "spans", 0), ("Cells", "cells", 0), ("List", "list", 0), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("BlobRange", "nearest", 0), ("BlobRange", "farthest", 4), ("BlobRange", "seen", 8), ("BlobRange", "dropped", 12), ("BlobRange", "taken", 16), ("Range", "range", 0), ("Layers", "layers", 0), ],
};
/// `bubbles/peel.frag`
pub const BUBBLES_PEEL_FRAG: Shader = Shader {
    name: "bubbles/peel.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.peel.frag.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (10, vk::DescriptorType::STORAGE_BUFFER), (13, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("BlobIds", "blob_ids", 0), ("Bubbles", "bubbles", 0), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("Push", "layer", 0), ("Neighbours", "neighbours", 0), ],
};
/// `bubbles/peel.vert`
pub const BUBBLES_PEEL_VERT: Shader = Shader {
    name: "bubbles/peel.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.peel.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ],
};
/// `bubbles/peel_keep.comp`
pub const BUBBLES_PEEL_KEEP_COMP: Shader = Shader {
    name: "bubbles/peel_keep.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.peel_keep.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_IMAGE), (13, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Bubbles", "bubbles", 0), ("Neighbours", "neighbours", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "layer", 0), ("Layers", "layers", 0), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("BlobIds", "blob_ids", 0), ],
};
/// `bubbles/peel_opacity.frag`
pub const BUBBLES_PEEL_OPACITY_FRAG: Shader = Shader {
    name: "bubbles/peel_opacity.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.peel_opacity.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (10, vk::DescriptorType::STORAGE_BUFFER), (13, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("BlobIds", "blob_ids", 0), ("Bubbles", "bubbles", 0), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ("Neighbours", "neighbours", 0), ],
};
/// `bubbles/soap.comp`
pub const BUBBLES_SOAP_COMP: Shader = Shader {
    name: "bubbles/soap.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/bubbles.soap.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (12, vk::DescriptorType::STORAGE_IMAGE), (13, vk::DescriptorType::STORAGE_BUFFER), (14, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ("BlobIds", "blob_ids", 0), ("Bubbles", "bubbles", 0), ("Neighbours", "neighbours", 0), ("BubbleFrame", "film", 0), ("BubbleFrame", "core", 16), ("BubbleFrame", "albedo", 32), ("BubbleFrame", "mirror", 48), ("BubbleFrame", "sun", 64), ("BubbleFrame", "sun_mirror", 80), ("BubbleFrame", "tiles", 96), ("BubbleFrame", "kinds", 112), ("Layers", "layers", 0), ("Blob", "ball", 0), ("Blob", "turn", 16), ("Blob", "template_", 32), ("Blob", "id", 36), ("Blob", "nearest", 40), ("Blob", "unused", 44), ("Blobs", "blobs", 0), ],
};
/// `composite.comp`
pub const COMPOSITE_COMP: Shader = Shader {
    name: "composite.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/composite.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), (12, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (14, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (20, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (21, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (22, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (23, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (25, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (26, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (31, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (33, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Boundaries", "boundaries", 0), ("Span", "span", 0), ("Drift", "drift", 0), ("Arguments", "arguments", 0), ("List", "list", 0), ("Push", "first", 0), ],
};
/// `composite.frag`
pub const COMPOSITE_FRAG: Shader = Shader {
    name: "composite.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/composite.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), (12, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (14, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (20, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (21, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (22, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (23, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (25, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (26, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (31, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (33, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Boundaries", "boundaries", 0), ("Span", "span", 0), ("Drift", "drift", 0), ],
};
/// `composite.vert`
pub const COMPOSITE_VERT: Shader = Shader {
    name: "composite.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/composite.vert.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("List", "list", 0), ("Push", "first", 0), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `environment/equirect.comp`
pub const ENVIRONMENT_EQUIRECT_COMP: Shader = Shader {
    name: "environment/equirect.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/environment.equirect.comp.spv"))); &CODE.0 },
    push_size: 44,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Push", "east", 0), ("Push", "up", 16), ("Push", "size", 32), ("Push", "scale", 36), ("Push", "turn", 40), ],
};
/// `environment/irradiance.comp`
pub const ENVIRONMENT_IRRADIANCE_COMP: Shader = Shader {
    name: "environment/irradiance.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/environment.irradiance.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Push", "size", 0), ("Push", "coarse", 4), ("Push", "mip", 8), ],
};
/// `environment/sky.comp`
pub const ENVIRONMENT_SKY_COMP: Shader = Shader {
    name: "environment/sky.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/environment.sky.comp.spv"))); &CODE.0 },
    push_size: 52,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "sun", 0), ("Push", "east", 16), ("Push", "up", 32), ("Push", "size", 48), ],
};
/// `foam/begin.comp`
pub const FOAM_BEGIN_COMP: Shader = Shader {
    name: "foam/begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.begin.comp.spv"))); &CODE.0 },
    push_size: 44,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "fluid_at", 0), ("Push", "fluid_end", 16), ("Push", "count", 24), ("Push", "from_gpu", 28), ("Push", "chunks", 32), ("Push", "chunk_size", 36), ("Push", "group_size", 40), ("Count", "count", 0), ("Arguments", "arguments", 0), ("Words", "words", 0), ],
};
/// `foam/blur.comp`
pub const FOAM_BLUR_COMP: Shader = Shader {
    name: "foam/blur.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.blur.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Tiles", "tiles", 0), ("Push", "step", 0), ],
};
/// `foam/radiance.comp`
pub const FOAM_RADIANCE_COMP: Shader = Shader {
    name: "foam/radiance.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.radiance.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::STORAGE_BUFFER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ("Tiles", "tiles", 0), ("Points", "points", 0), ],
};
/// `foam/resolve.comp`
pub const FOAM_RESOLVE_COMP: Shader = Shader {
    name: "foam/resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.resolve.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `foam/resolve_quads.comp`
pub const FOAM_RESOLVE_QUADS_COMP: Shader = Shader {
    name: "foam/resolve_quads.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.resolve_quads.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `foam/splat.comp`
pub const FOAM_SPLAT_COMP: Shader = Shader {
    name: "foam/splat.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.splat.comp.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("HandOver", "near", 0), ("HandOver", "far", 4), ("HandOver", "rings", 8), ("HandOver", "blobs", 12), ("Over", "hand_over", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "kind_word", 8), ("Push", "kind_stride", 12), ("Push", "radius_word", 16), ("Push", "radius_stride", 20), ("Push", "age_word", 24), ("Push", "age_stride", 28), ("Push", "id_word", 32), ("Push", "id_stride", 36), ("Push", "chunk_first", 40), ("Push", "chunk", 44), ("Positions", "positions", 0), ("Ages", "ages", 0), ("Ids", "ids", 0), ("Kinds", "kinds", 0), ("Radii", "radii", 0), ("Words", "words", 0), ("HostPackets", "packets", 0), ("List", "list", 0), ("Arguments", "arguments", 0), ],
};
/// `foam/splat.vert`
pub const FOAM_SPLAT_VERT: Shader = Shader {
    name: "foam/splat.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.splat.vert.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 3,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("HandOver", "near", 0), ("HandOver", "far", 4), ("HandOver", "rings", 8), ("HandOver", "blobs", 12), ("Over", "hand_over", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "kind_word", 8), ("Push", "kind_stride", 12), ("Push", "radius_word", 16), ("Push", "radius_stride", 20), ("Push", "age_word", 24), ("Push", "age_stride", 28), ("Push", "id_word", 32), ("Push", "id_stride", 36), ("Push", "chunk_first", 40), ("Push", "chunk", 44), ("Positions", "positions", 0), ("Ages", "ages", 0), ("Ids", "ids", 0), ("Kinds", "kinds", 0), ("Radii", "radii", 0), ],
};
/// `foam/splat64.comp`
pub const FOAM_SPLAT64_COMP: Shader = Shader {
    name: "foam/splat64.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.splat64.comp.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("HandOver", "near", 0), ("HandOver", "far", 4), ("HandOver", "rings", 8), ("HandOver", "blobs", 12), ("Over", "hand_over", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "kind_word", 8), ("Push", "kind_stride", 12), ("Push", "radius_word", 16), ("Push", "radius_stride", 20), ("Push", "age_word", 24), ("Push", "age_stride", 28), ("Push", "id_word", 32), ("Push", "id_stride", 36), ("Push", "chunk_first", 40), ("Push", "chunk", 44), ("Positions", "positions", 0), ("Ages", "ages", 0), ("Ids", "ids", 0), ("Kinds", "kinds", 0), ("Radii", "radii", 0), ("Pixel", "front", 0), ("Pixel", "scene", 8), ("Pixel", "fluid", 12), ("Pixel", "sums", 16), ("Words", "pixels", 0), ("HostPackets", "packets", 0), ("List", "list", 0), ("Arguments", "arguments", 0), ],
};
/// `foam/splat_front.frag`
pub const FOAM_SPLAT_FRONT_FRAG: Shader = Shader {
    name: "foam/splat_front.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.splat_front.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `foam/splat_thickness.frag`
pub const FOAM_SPLAT_THICKNESS_FRAG: Shader = Shader {
    name: "foam/splat_thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.splat_thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `foam/surface.comp`
pub const FOAM_SURFACE_COMP: Shader = Shader {
    name: "foam/surface.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.surface.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `foam/tiles.comp`
pub const FOAM_TILES_COMP: Shader = Shader {
    name: "foam/tiles.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/foam.tiles.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Tiles", "tiles", 0), ],
};
/// `generate/advance.comp`
pub const GENERATE_ADVANCE_COMP: Shader = Shader {
    name: "generate/advance.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.advance.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ("Ends", "ends", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Motion", "velocity", 0), ("Motion", "number", 12), ("Motions", "motions", 0), ("Diffuse", "position", 0), ("Diffuse", "age", 12), ("Particles", "particles", 0), ("Gone", "gone", 0), ("Drift", "velocity", 0), ("Drift", "id", 12), ("Drifts", "drifts", 0), ("Kinds", "kinds", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ],
};
/// `generate/begin.comp`
pub const GENERATE_BEGIN_COMP: Shader = Shader {
    name: "generate/begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.begin.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ("HostCount", "host_count", 0), ],
};
/// `generate/count.comp`
pub const GENERATE_COUNT_COMP: Shader = Shader {
    name: "generate/count.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.count.comp.spv"))); &CODE.0 },
    push_size: 44,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "velocity_word", 8), ("Push", "velocity_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "chunk_first", 24), ("Push", "chunk", 28), ("Push", "spacing", 32), ("Push", "cells", 36), ("Push", "buckets", 40), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Wanted", "wanted", 0), ("Potentials", "potentials", 0), ("Buckets", "buckets", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ("Ids", "ids", 0), ],
};
/// `generate/crest.comp`
pub const GENERATE_CREST_COMP: Shader = Shader {
    name: "generate/crest.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.crest.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ("Ends", "ends", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Normals", "normals", 0), ("Motion", "velocity", 0), ("Motion", "number", 12), ("Motions", "motions", 0), ("Potentials", "potentials", 0), ("Rates", "rates", 0), ("Wanted", "wanted", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ],
};
/// `generate/emit.comp`
pub const GENERATE_EMIT_COMP: Shader = Shader {
    name: "generate/emit.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.emit.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ("Motion", "velocity", 0), ("Motion", "number", 12), ("Motions", "motions", 0), ("Wanted", "wanted", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Normals", "normals", 0), ("Free", "free_slots", 0), ("Diffuse", "position", 0), ("Diffuse", "age", 12), ("Particles", "particles", 0), ("Drift", "velocity", 0), ("Drift", "id", 12), ("Drifts", "drifts", 0), ("Kinds", "kinds", 0), ],
};
/// `generate/end.comp`
pub const GENERATE_END_COMP: Shader = Shader {
    name: "generate/end.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.end.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ],
};
/// `generate/fill.comp`
pub const GENERATE_FILL_COMP: Shader = Shader {
    name: "generate/fill.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.fill.comp.spv"))); &CODE.0 },
    push_size: 44,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "velocity_word", 8), ("Push", "velocity_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "chunk_first", 24), ("Push", "chunk", 28), ("Push", "spacing", 32), ("Push", "cells", 36), ("Push", "buckets", 40), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Ids", "ids", 0), ("Buckets", "buckets", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Motion", "velocity", 0), ("Motion", "number", 12), ("Motions", "motions", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ],
};
/// `generate/free.comp`
pub const GENERATE_FREE_COMP: Shader = Shader {
    name: "generate/free.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.free.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Diffuse", "position", 0), ("Diffuse", "age", 12), ("Particles", "particles", 0), ("Free", "free_slots", 0), ("Gone", "gone", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ],
};
/// `generate/potentials.comp`
pub const GENERATE_POTENTIALS_COMP: Shader = Shader {
    name: "generate/potentials.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.potentials.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ("Ends", "ends", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Motion", "velocity", 0), ("Motion", "number", 12), ("Motions", "motions", 0), ("Normals", "normals", 0), ("Potentials", "potentials", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ],
};
/// `generate/trace.comp`
pub const GENERATE_TRACE_COMP: Shader = Shader {
    name: "generate/trace.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/generate.trace.comp.spv"))); &CODE.0 },
    push_size: 116,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "spacing", 0), ("Push", "dt", 4), ("Push", "seed", 8), ("Push", "number", 12), ("Push", "gravity_x", 16), ("Push", "gravity_y", 20), ("Push", "gravity_z", 24), ("Push", "buoyancy", 28), ("Push", "drag", 32), ("Push", "trapped_least", 36), ("Push", "trapped_scale", 40), ("Push", "crest_least", 44), ("Push", "crest_scale", 48), ("Push", "energy_least", 52), ("Push", "energy_scale", 56), ("Push", "trapped_rate", 60), ("Push", "crest_rate", 64), ("Push", "life_least", 68), ("Push", "life_most", 72), ("Push", "low_x", 76), ("Push", "low_y", 80), ("Push", "low_z", 84), ("Push", "high_x", 88), ("Push", "high_y", 92), ("Push", "high_z", 96), ("Push", "buckets", 100), ("Push", "most", 104), ("Push", "capacity", 108), ("Push", "cells", 112), ("Ends", "ends", 0), ("Rates", "rates", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Motion", "velocity", 0), ("Motion", "number", 12), ("Motions", "motions", 0), ("Stages", "stages", 0), ("Wanted", "wanted", 0), ("GenerateCounts", "high", 0), ("GenerateCounts", "fluid", 4), ("GenerateCounts", "sorted", 8), ("GenerateCounts", "free", 12), ("GenerateCounts", "made", 16), ("GenerateCounts", "lost", 20), ("CountBuffer", "counts", 0), ],
};
/// `gpu/scan_apply.comp`
pub const GPU_SCAN_APPLY_COMP: Shader = Shader {
    name: "gpu/scan_apply.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/gpu.scan_apply.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [256, 1, 1],
    shared: 2048,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "most", 0), ("Push", "count", 4), ("Push", "total", 8), ("Counts", "counts", 0), ("Values", "values", 0), ("Blocks", "blocks", 0), ],
};
/// `gpu/scan_blocks.comp`
pub const GPU_SCAN_BLOCKS_COMP: Shader = Shader {
    name: "gpu/scan_blocks.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/gpu.scan_blocks.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [256, 1, 1],
    shared: 2048,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "most", 0), ("Push", "count", 4), ("Push", "total", 8), ("Counts", "counts", 0), ("Blocks", "blocks", 0), ],
};
/// `gpu/scan_sum.comp`
pub const GPU_SCAN_SUM_COMP: Shader = Shader {
    name: "gpu/scan_sum.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/gpu.scan_sum.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [256, 1, 1],
    shared: 2048,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "most", 0), ("Push", "count", 4), ("Push", "total", 8), ("Counts", "counts", 0), ("Values", "values", 0), ("Blocks", "blocks", 0), ],
};
/// `headless/depth.vert`
pub const HEADLESS_DEPTH_VERT: Shader = Shader {
    name: "headless/depth.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.depth.vert.spv"))); &CODE.0 },
    push_size: 64,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[],
    members: &[("Push", "clip", 0), ],
};
/// `headless/irradiance.comp`
pub const HEADLESS_IRRADIANCE_COMP: Shader = Shader {
    name: "headless/irradiance.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.irradiance.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [64, 1, 1],
    shared: 9216,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Scene", "air", 256), ("Scene", "sea", 272), ("Scene", "absorption", 288), ("Scene", "scattering", 304), ("Scene", "lava", 320), ("Scene", "flow", 336), ("Scene", "waves", 352), ("Irradiance", "irradiance", 0), ],
};
/// `headless/scene.frag`
pub const HEADLESS_SCENE_FRAG: Shader = Shader {
    name: "headless/scene.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.scene.frag.spv"))); &CODE.0 },
    push_size: 64,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Irradiance", "irradiance", 0), ("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Scene", "air", 256), ("Scene", "sea", 272), ("Scene", "absorption", 288), ("Scene", "scattering", 304), ("Scene", "lava", 320), ("Scene", "flow", 336), ("Scene", "waves", 352), ("Push", "turn", 0), ("Push", "origin", 16), ("Push", "color", 32), ("Push", "pattern", 48), ],
};
/// `headless/scene.vert`
pub const HEADLESS_SCENE_VERT: Shader = Shader {
    name: "headless/scene.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.scene.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 5,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Scene", "air", 256), ("Scene", "sea", 272), ("Scene", "absorption", 288), ("Scene", "scattering", 304), ("Scene", "lava", 320), ("Scene", "flow", 336), ("Scene", "waves", 352), ],
};
/// `headless/sky.frag`
pub const HEADLESS_SKY_FRAG: Shader = Shader {
    name: "headless/sky.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.sky.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Irradiance", "irradiance", 0), ("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Scene", "air", 256), ("Scene", "sea", 272), ("Scene", "absorption", 288), ("Scene", "scattering", 304), ("Scene", "lava", 320), ("Scene", "flow", 336), ("Scene", "waves", 352), ],
};
/// `headless/sky.vert`
pub const HEADLESS_SKY_VERT: Shader = Shader {
    name: "headless/sky.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/headless.sky.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Scene", "clip", 0), ("Scene", "shadow", 64), ("Scene", "eye", 128), ("Scene", "ray_x", 144), ("Scene", "ray_y", 160), ("Scene", "ray_z", 176), ("Scene", "sun_direction", 192), ("Scene", "sun_color", 208), ("Scene", "shadow_texel", 224), ("Scene", "ground", 240), ("Scene", "air", 256), ("Scene", "sea", 272), ("Scene", "absorption", 288), ("Scene", "scattering", 304), ("Scene", "lava", 320), ("Scene", "flow", 336), ("Scene", "waves", 352), ],
};
/// `light/caustics.comp`
pub const LIGHT_CAUSTICS_COMP: Shader = Shader {
    name: "light/caustics.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.caustics.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_BUFFER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ("Photons", "photons", 0), ],
};
/// `light/caustics_resolve.comp`
pub const LIGHT_CAUSTICS_RESOLVE_COMP: Shader = Shader {
    name: "light/caustics_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.caustics_resolve.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Photons", "photons", 0), ],
};
/// `light/convolution.comp`
pub const LIGHT_CONVOLUTION_COMP: Shader = Shader {
    name: "light/convolution.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.convolution.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::UNIFORM_BUFFER), (3, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "page", 0), ("Span", "span", 0), ],
};
/// `light/convolution_across.comp`
pub const LIGHT_CONVOLUTION_ACROSS_COMP: Shader = Shader {
    name: "light/convolution_across.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.convolution_across.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `light/convolution_down.comp`
pub const LIGHT_CONVOLUTION_DOWN_COMP: Shader = Shader {
    name: "light/convolution_down.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.convolution_down.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "page", 0), ],
};
/// `light/convolution_span.comp`
pub const LIGHT_CONVOLUTION_SPAN_COMP: Shader = Shader {
    name: "light/convolution_span.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.convolution_span.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ],
};
/// `light/cover.vert`
pub const LIGHT_COVER_VERT: Shader = Shader {
    name: "light/cover.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.cover.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[],
    members: &[],
};
/// `light/diffuse.comp`
pub const LIGHT_DIFFUSE_COMP: Shader = Shader {
    name: "light/diffuse.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.diffuse.comp.spv"))); &CODE.0 },
    push_size: 56,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("HandOver", "near", 0), ("HandOver", "far", 4), ("HandOver", "rings", 8), ("HandOver", "blobs", 12), ("Over", "hand_over", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "kind_word", 8), ("Push", "kind_stride", 12), ("Push", "radius_word", 16), ("Push", "radius_stride", 20), ("Push", "age_word", 24), ("Push", "age_stride", 28), ("Push", "id_word", 32), ("Push", "id_stride", 36), ("Push", "chunk_first", 40), ("Push", "chunk", 44), ("Push", "first", 48), ("Push", "last", 52), ("Positions", "positions", 0), ("Ages", "ages", 0), ("Ids", "ids", 0), ("Kinds", "kinds", 0), ("Radii", "radii", 0), ("Words", "words", 0), ("HostPackets", "packets", 0), ("List", "list", 0), ("Arguments", "arguments", 0), ],
};
/// `light/diffuse_begin.comp`
pub const LIGHT_DIFFUSE_BEGIN_COMP: Shader = Shader {
    name: "light/diffuse_begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.diffuse_begin.comp.spv"))); &CODE.0 },
    push_size: 20,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "count", 0), ("Push", "from_gpu", 4), ("Push", "chunks", 8), ("Push", "chunk_size", 12), ("Push", "group_size", 16), ("Count", "count", 0), ("Arguments", "arguments", 0), ],
};
/// `light/diffuse_resolve.comp`
pub const LIGHT_DIFFUSE_RESOLVE_COMP: Shader = Shader {
    name: "light/diffuse_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.diffuse_resolve.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "first", 0), ("Push", "last", 4), ("Push", "bound", 8), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `light/front.frag`
pub const LIGHT_FRONT_FRAG: Shader = Shader {
    name: "light/front.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.front.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `light/lit.frag`
pub const LIGHT_LIT_FRAG: Shader = Shader {
    name: "light/lit.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.lit.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ],
};
/// `light/lit_out.comp`
pub const LIGHT_LIT_OUT_COMP: Shader = Shader {
    name: "light/lit_out.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.lit_out.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (8, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `light/lit_out.frag`
pub const LIGHT_LIT_OUT_FRAG: Shader = Shader {
    name: "light/lit_out.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.lit_out.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `light/smooth.comp`
pub const LIGHT_SMOOTH_COMP: Shader = Shader {
    name: "light/smooth.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.smooth.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "vertical", 0), ],
};
/// `light/sprites.vert`
pub const LIGHT_SPRITES_VERT: Shader = Shader {
    name: "light/sprites.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.sprites.vert.spv"))); &CODE.0 },
    push_size: 32,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 5,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "foam_word", 16), ("Push", "foam_stride", 20), ("Push", "front", 24), ("Push", "packets", 28), ("Members", "members", 0), ("Positions", "positions", 0), ("Densities", "densities", 0), ("Amounts", "amounts", 0), ],
};
/// `light/thickness.frag`
pub const LIGHT_THICKNESS_FRAG: Shader = Shader {
    name: "light/thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/light.thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `shore/coat.comp`
pub const SHORE_COAT_COMP: Shader = Shader {
    name: "shore/coat.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.coat.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (8, vk::DescriptorType::STORAGE_IMAGE), (31, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (32, vk::DescriptorType::STORAGE_BUFFER), (33, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Arguments", "arguments", 0), ("List", "list", 0), ("Push", "across", 0), ("Push", "first", 4), ],
};
/// `shore/coat.frag`
pub const SHORE_COAT_FRAG: Shader = Shader {
    name: "shore/coat.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.coat.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (31, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `shore/coat.vert`
pub const SHORE_COAT_VERT: Shader = Shader {
    name: "shore/coat.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.coat.vert.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 2,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (32, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("List", "list", 0), ("Push", "across", 0), ("Push", "first", 4), ],
};
/// `shore/contact.comp`
pub const SHORE_CONTACT_COMP: Shader = Shader {
    name: "shore/contact.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.contact.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [256, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (28, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (29, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (30, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("ShoreFrame", "east", 0), ("ShoreFrame", "north", 16), ("ShoreFrame", "height", 32), ("ShoreFrame", "surface", 48), ("ShoreFrame", "surface_part", 64), ("ShoreFrame", "map", 80), ("ShoreFrame", "reach", 96), ("ShoreFrame", "waves", 112), ("ShoreFrame", "mixed", 128), ("ShoreFrame", "web", 144), ("ShoreFrame", "counts", 160), ("ShoreFrame", "look", 176), ("ShoreFrame", "look_moved", 272), ("ShoreFrame", "noise", 368), ("ShoreFrame", "layer", 464), ("ShoreFrame", "layer_weight", 528), ("ShoreFrame", "contact", 544), ("ShoreFrame", "contact_mask", 560), ("ShoreFrame", "mask", 576), ("ShoreFrame", "mask_part", 592), ("Arguments", "arguments", 0), ("Lists", "list", 0), ("Push", "across", 0), ("Push", "most", 4), ],
};
/// `shore/contact_tiles.comp`
pub const SHORE_CONTACT_TILES_COMP: Shader = Shader {
    name: "shore/contact_tiles.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.contact_tiles.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Lists", "list", 0), ("Push", "across", 0), ("Push", "most", 4), ("Arguments", "arguments", 0), ("ShoreFrame", "east", 0), ("ShoreFrame", "north", 16), ("ShoreFrame", "height", 32), ("ShoreFrame", "surface", 48), ("ShoreFrame", "surface_part", 64), ("ShoreFrame", "map", 80), ("ShoreFrame", "reach", 96), ("ShoreFrame", "waves", 112), ("ShoreFrame", "mixed", 128), ("ShoreFrame", "web", 144), ("ShoreFrame", "counts", 160), ("ShoreFrame", "look", 176), ("ShoreFrame", "look_moved", 272), ("ShoreFrame", "noise", 368), ("ShoreFrame", "layer", 464), ("ShoreFrame", "layer_weight", 528), ("ShoreFrame", "contact", 544), ("ShoreFrame", "contact_mask", 560), ("ShoreFrame", "mask", 576), ("ShoreFrame", "mask_part", 592), ],
};
/// `shore/map_distance.comp`
pub const SHORE_MAP_DISTANCE_COMP: Shader = Shader {
    name: "shore/map_distance.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.map_distance.comp.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Push", "window", 0), ("Push", "size", 16), ("Push", "jump", 20), ("Push", "texel", 24), ("Push", "level", 28), ("Push", "part", 32), ("Seeds", "seeds", 0), ],
};
/// `shore/map_height.frag`
pub const SHORE_MAP_HEIGHT_FRAG: Shader = Shader {
    name: "shore/map_height.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.map_height.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[],
    members: &[],
};
/// `shore/map_height.vert`
pub const SHORE_MAP_HEIGHT_VERT: Shader = Shader {
    name: "shore/map_height.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.map_height.vert.spv"))); &CODE.0 },
    push_size: 68,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "east", 0), ("Push", "north", 16), ("Push", "height", 32), ("Push", "position_word", 48), ("Push", "position_stride", 52), ("Push", "index_word", 56), ("Push", "index_stride", 60), ("Push", "vertices", 64), ("Indices", "indices", 0), ("Positions", "positions", 0), ],
};
/// `shore/map_jump.comp`
pub const SHORE_MAP_JUMP_COMP: Shader = Shader {
    name: "shore/map_jump.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.map_jump.comp.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "window", 0), ("Push", "size", 16), ("Push", "jump", 20), ("Push", "texel", 24), ("Push", "level", 28), ("Push", "part", 32), ("Before", "before", 0), ("After", "after", 0), ],
};
/// `shore/map_seed.comp`
pub const SHORE_MAP_SEED_COMP: Shader = Shader {
    name: "shore/map_seed.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.map_seed.comp.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "window", 0), ("Push", "size", 16), ("Push", "jump", 20), ("Push", "texel", 24), ("Push", "level", 28), ("Push", "part", 32), ("Seeds", "seeds", 0), ],
};
/// `shore/runs.comp`
pub const SHORE_RUNS_COMP: Shader = Shader {
    name: "shore/runs.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.runs.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Lists", "list", 0), ("Push", "across", 0), ("Push", "most", 4), ("Arguments", "arguments", 0), ("Marks", "marks", 0), ],
};
/// `shore/shoreline.comp`
pub const SHORE_SHORELINE_COMP: Shader = Shader {
    name: "shore/shoreline.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.shoreline.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (8, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (28, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (29, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (30, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("ShoreFrame", "east", 0), ("ShoreFrame", "north", 16), ("ShoreFrame", "height", 32), ("ShoreFrame", "surface", 48), ("ShoreFrame", "surface_part", 64), ("ShoreFrame", "map", 80), ("ShoreFrame", "reach", 96), ("ShoreFrame", "waves", 112), ("ShoreFrame", "mixed", 128), ("ShoreFrame", "web", 144), ("ShoreFrame", "counts", 160), ("ShoreFrame", "look", 176), ("ShoreFrame", "look_moved", 272), ("ShoreFrame", "noise", 368), ("ShoreFrame", "layer", 464), ("ShoreFrame", "layer_weight", 528), ("ShoreFrame", "contact", 544), ("ShoreFrame", "contact_mask", 560), ("ShoreFrame", "mask", 576), ("ShoreFrame", "mask_part", 592), ("Span", "span", 0), ("Arguments", "arguments", 0), ("Lists", "list", 0), ("Push", "across", 0), ("Push", "most", 4), ("Marks", "marks", 0), ],
};
/// `shore/strip.frag`
pub const SHORE_STRIP_FRAG: Shader = Shader {
    name: "shore/strip.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.strip.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (28, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (29, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("ShoreFrame", "east", 0), ("ShoreFrame", "north", 16), ("ShoreFrame", "height", 32), ("ShoreFrame", "surface", 48), ("ShoreFrame", "surface_part", 64), ("ShoreFrame", "map", 80), ("ShoreFrame", "reach", 96), ("ShoreFrame", "waves", 112), ("ShoreFrame", "mixed", 128), ("ShoreFrame", "web", 144), ("ShoreFrame", "counts", 160), ("ShoreFrame", "look", 176), ("ShoreFrame", "look_moved", 272), ("ShoreFrame", "noise", 368), ("ShoreFrame", "layer", 464), ("ShoreFrame", "layer_weight", 528), ("ShoreFrame", "contact", 544), ("ShoreFrame", "contact_mask", 560), ("ShoreFrame", "mask", 576), ("ShoreFrame", "mask_part", 592), ("Span", "span", 0), ],
};
/// `shore/strip.vert`
pub const SHORE_STRIP_VERT: Shader = Shader {
    name: "shore/strip.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.strip.vert.spv"))); &CODE.0 },
    push_size: 28,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 2,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "v_word", 8), ("Push", "v_stride", 12), ("Push", "index_word", 16), ("Push", "index_stride", 20), ("Push", "vertices", 24), ("Indices", "indices", 0), ("Positions", "positions", 0), ("Across", "across", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `shore/strip_tiles.comp`
pub const SHORE_STRIP_TILES_COMP: Shader = Shader {
    name: "shore/strip_tiles.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.strip_tiles.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(8, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Marks", "marks", 0), ("Push", "across", 0), ("Push", "most", 4), ],
};
/// `shore/texture.comp`
pub const SHORE_TEXTURE_COMP: Shader = Shader {
    name: "shore/texture.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.texture.comp.spv"))); &CODE.0 },
    push_size: 28,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::STORAGE_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Push", "part", 0), ("Push", "size", 16), ("Push", "first", 20), ("Push", "before", 24), ("Halves", "halves", 0), ("Floats", "floats", 0), ],
};
/// `shore/tiles.comp`
pub const SHORE_TILES_COMP: Shader = Shader {
    name: "shore/tiles.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/shore.tiles.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (9, vk::DescriptorType::STORAGE_BUFFER), (10, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("ShoreFrame", "east", 0), ("ShoreFrame", "north", 16), ("ShoreFrame", "height", 32), ("ShoreFrame", "surface", 48), ("ShoreFrame", "surface_part", 64), ("ShoreFrame", "map", 80), ("ShoreFrame", "reach", 96), ("ShoreFrame", "waves", 112), ("ShoreFrame", "mixed", 128), ("ShoreFrame", "web", 144), ("ShoreFrame", "counts", 160), ("ShoreFrame", "look", 176), ("ShoreFrame", "look_moved", 272), ("ShoreFrame", "noise", 368), ("ShoreFrame", "layer", 464), ("ShoreFrame", "layer_weight", 528), ("ShoreFrame", "contact", 544), ("ShoreFrame", "contact_mask", 560), ("ShoreFrame", "mask", 576), ("ShoreFrame", "mask_part", 592), ("Lists", "list", 0), ("Push", "across", 0), ("Push", "most", 4), ("Arguments", "arguments", 0), ],
};
/// `water/back.comp`
pub const WATER_BACK_COMP: Shader = Shader {
    name: "water/back.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.back.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Blocks", "blocks", 0), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Push", "capacity", 0), ],
};
/// `water/back_begin.comp`
pub const WATER_BACK_BEGIN_COMP: Shader = Shader {
    name: "water/back_begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.back_begin.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 4,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_IMAGE), (7, vk::DescriptorType::UNIFORM_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ],
};
/// `water/back_plan.comp`
pub const WATER_BACK_PLAN_COMP: Shader = Shader {
    name: "water/back_plan.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.back_plan.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 4,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Marked", "groups", 0), ("Marked", "count", 12), ("Marked", "needed", 16), ("Counts", "marked", 0), ("Tiles", "tile_work", 0), ],
};
/// `water/classify.comp`
pub const WATER_CLASSIFY_COMP: Shader = Shader {
    name: "water/classify.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.classify.comp.spv"))); &CODE.0 },
    push_size: 88,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "velocity_word", 0), ("Push", "velocity_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "first", 24), ("Push", "count", 28), ("Push", "from_gpu", 32), ("Push", "chunk_end", 36), ("Push", "rows", 40), ("Push", "part_first", 44), ("Push", "part_rows", 48), ("Push", "seed", 52), ("Push", "scale", 56), ("Push", "threshold", 60), ("Push", "foam_lifetime", 64), ("Push", "dt", 68), ("Push", "air_x", 72), ("Push", "air_y", 76), ("Push", "air_z", 80), ("Push", "rest_density", 84), ("Velocities", "velocities", 0), ("Densities", "densities", 0), ("Row", "key", 0), ("Row", "phase", 4), ("Row", "timer", 8), ("Row", "lifetime", 12), ("Row", "age", 16), ("Old", "old_rows", 0), ("New", "new_rows", 0), ("HostCount", "host_count", 0), ("Foam", "foam", 0), ("Ids", "ids", 0), ],
};
/// `water/cull.comp`
pub const WATER_CULL_COMP: Shader = Shader {
    name: "water/cull.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.cull.comp.spv"))); &CODE.0 },
    push_size: 40,
    local_size: [64, 1, 1],
    shared: 16,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("HostPackets", "packets", 0), ("Positions", "positions", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "chunk_first", 16), ("Push", "capacity", 20), ("Push", "small_limit", 24), ("Push", "small_inside", 28), ("Push", "foam_word", 32), ("Push", "foam_stride", 36), ("Amounts", "amounts", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("Densities", "densities", 0), ("Visible", "visible", 0), ("Shares", "shares", 0), ("Members", "members", 0), ],
};
/// `water/cull_begin.comp`
pub const WATER_CULL_BEGIN_COMP: Shader = Shader {
    name: "water/cull_begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.cull_begin.comp.spv"))); &CODE.0 },
    push_size: 24,
    local_size: [32, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "count", 0), ("Push", "from_gpu", 4), ("Push", "chunks", 8), ("Push", "chunk_size", 12), ("Push", "packets", 16), ("Push", "group_size", 20), ("HostCount", "host_count", 0), ("AllCounts", "words", 0), ],
};
/// `water/cull_end.comp`
pub const WATER_CULL_END_COMP: Shader = Shader {
    name: "water/cull_end.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.cull_end.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [32, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "chunks", 0), ("Push", "group_size", 4), ("Push", "most_groups", 8), ("AllCounts", "words", 0), ],
};
/// `water/depth.comp`
pub const WATER_DEPTH_COMP: Shader = Shader {
    name: "water/depth.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.depth.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Push", "capacity", 0), ],
};
/// `water/depth.frag`
pub const WATER_DEPTH_FRAG: Shader = Shader {
    name: "water/depth.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.depth.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/depth.vert`
pub const WATER_DEPTH_VERT: Shader = Shader {
    name: "water/depth.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.depth.vert.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 3,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "capacity", 0), ("Visible", "visible", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/foam.comp`
pub const WATER_FOAM_COMP: Shader = Shader {
    name: "water/foam.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [64, 1, 1],
    shared: 608,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("FoamSprite", "centre", 0), ("FoamSprite", "velocity", 16), ("FoamSprite", "rest", 32), ("FoamSprite", "pattern", 48), ("Sprites", "sprites", 0), ("Words", "words", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ],
};
/// `water/foam.vert`
pub const WATER_FOAM_VERT: Shader = Shader {
    name: "water/foam.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 6,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("FoamSprite", "centre", 0), ("FoamSprite", "velocity", 16), ("FoamSprite", "rest", 32), ("FoamSprite", "pattern", 48), ("Sprites", "sprites", 0), ],
};
/// `water/foam_begin.comp`
pub const WATER_FOAM_BEGIN_COMP: Shader = Shader {
    name: "water/foam_begin.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_begin.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `water/foam_depth.frag`
pub const WATER_FOAM_DEPTH_FRAG: Shader = Shader {
    name: "water/foam_depth.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_depth.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/foam_drift.comp`
pub const WATER_FOAM_DRIFT_COMP: Shader = Shader {
    name: "water/foam_drift.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_drift.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("FoamSprite", "centre", 0), ("FoamSprite", "velocity", 16), ("FoamSprite", "rest", 32), ("FoamSprite", "pattern", 48), ("Sprites", "sprites", 0), ("Drift", "drift", 0), ],
};
/// `water/foam_list.comp`
pub const WATER_FOAM_LIST_COMP: Shader = Shader {
    name: "water/foam_list.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_list.comp.spv"))); &CODE.0 },
    push_size: 48,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "amount_word", 8), ("Push", "amount_stride", 12), ("Push", "velocity_word", 16), ("Push", "velocity_stride", 20), ("Push", "id_word", 24), ("Push", "id_stride", 28), ("Push", "density_word", 32), ("Push", "density_stride", 36), ("Push", "chunk_first", 40), ("Push", "packets", 44), ("Members", "members", 0), ("Amounts", "amounts", 0), ("Densities", "densities", 0), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Ids", "ids", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("FoamSprite", "centre", 0), ("FoamSprite", "velocity", 16), ("FoamSprite", "rest", 32), ("FoamSprite", "pattern", 48), ("Sprites", "sprites", 0), ],
};
/// `water/foam_resolve.comp`
pub const WATER_FOAM_RESOLVE_COMP: Shader = Shader {
    name: "water/foam_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_resolve.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Words", "words", 0), ],
};
/// `water/foam_thickness.frag`
pub const WATER_FOAM_THICKNESS_FRAG: Shader = Shader {
    name: "water/foam_thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.foam_thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/front.comp`
pub const WATER_FRONT_COMP: Shader = Shader {
    name: "water/front.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.front.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [64, 1, 1],
    shared: 8,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Cells", "cells", 0), ("Push", "capacity", 0), ("Push", "columns", 4), ("Push", "rows", 8), ("Front", "front", 0), ("Visible", "visible", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("FrontCounts", "front_counts", 0), ],
};
/// `water/front_cover.comp`
pub const WATER_FRONT_COVER_COMP: Shader = Shader {
    name: "water/front_cover.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.front_cover.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "capacity", 0), ("Push", "columns", 4), ("Push", "rows", 8), ("Cells", "cells", 0), ],
};
/// `water/gaps.comp`
pub const WATER_GAPS_COMP: Shader = Shader {
    name: "water/gaps.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Cells", "cells", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("Visible", "visible", 0), ("Push", "capacity", 0), ],
};
/// `water/gaps_blocks.comp`
pub const WATER_GAPS_BLOCKS_COMP: Shader = Shader {
    name: "water/gaps_blocks.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_blocks.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Blocks", "blocks", 0), ],
};
/// `water/gaps_find.comp`
pub const WATER_GAPS_FIND_COMP: Shader = Shader {
    name: "water/gaps_find.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_find.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Cells", "cells", 0), ("Push", "columns", 0), ("Push", "rows", 4), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Found", "found", 0), ],
};
/// `water/gaps_spread.comp`
pub const WATER_GAPS_SPREAD_COMP: Shader = Shader {
    name: "water/gaps_spread.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_spread.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "columns", 0), ("Push", "rows", 4), ("Found", "found", 0), ("Spread", "spread", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/gaps_texels.comp`
pub const WATER_GAPS_TEXELS_COMP: Shader = Shader {
    name: "water/gaps_texels.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.gaps_texels.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "columns", 0), ("Push", "rows", 4), ("Spread", "spread", 0), ("Boundaries", "boundaries", 0), ],
};
/// `water/level.comp`
pub const WATER_LEVEL_COMP: Shader = Shader {
    name: "water/level.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.level.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 4,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Marked", "groups", 0), ("Marked", "count", 12), ("Marked", "needed", 16), ("Counts", "marked", 0), ("List", "list", 0), ("Tiles", "tile_work", 0), ],
};
/// `water/level_mark.comp`
pub const WATER_LEVEL_MARK_COMP: Shader = Shader {
    name: "water/level_mark.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.level_mark.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [8, 8, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (9, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Tiles", "tile_work", 0), ("Marked", "groups", 0), ("Marked", "count", 12), ("Marked", "needed", 16), ("Counts", "marked", 0), ("List", "list", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/motion.comp`
pub const WATER_MOTION_COMP: Shader = Shader {
    name: "water/motion.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.motion.comp.spv"))); &CODE.0 },
    push_size: 40,
    local_size: [64, 1, 1],
    shared: 1028,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "velocity_word", 8), ("Push", "velocity_stride", 12), ("Push", "density_word", 16), ("Push", "density_stride", 20), ("Push", "foam_word", 24), ("Push", "foam_stride", 28), ("Push", "level", 32), ("Push", "packets", 36), ("Members", "members", 0), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Amounts", "amounts", 0), ("Densities", "densities", 0), ("Sums", "sums", 0), ("Fronts", "fronts", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ],
};
/// `water/motion_front.comp`
pub const WATER_MOTION_FRONT_COMP: Shader = Shader {
    name: "water/motion_front.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.motion_front.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "level", 0), ("Fronts", "fronts", 0), ("Sums", "sums", 0), ],
};
/// `water/motion_resolve.comp`
pub const WATER_MOTION_RESOLVE_COMP: Shader = Shader {
    name: "water/motion_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.motion_resolve.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_IMAGE), (9, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Push", "level", 0), ("Sums", "sums", 0), ("Fronts", "fronts", 0), ],
};
/// `water/noise.frag`
pub const WATER_NOISE_FRAG: Shader = Shader {
    name: "water/noise.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.noise.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/noise.vert`
pub const WATER_NOISE_VERT: Shader = Shader {
    name: "water/noise.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.noise.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 2,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Sprites", "sprites", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/noise_list.comp`
pub const WATER_NOISE_LIST_COMP: Shader = Shader {
    name: "water/noise_list.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.noise_list.comp.spv"))); &CODE.0 },
    push_size: 32,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "id_word", 16), ("Push", "id_stride", 20), ("Push", "chunk_first", 24), ("Push", "packets", 28), ("Members", "members", 0), ("Densities", "densities", 0), ("Positions", "positions", 0), ("Ids", "ids", 0), ("Sprites", "sprites", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ],
};
/// `water/reduce.comp`
pub const WATER_REDUCE_COMP: Shader = Shader {
    name: "water/reduce.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.reduce.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 8,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_IMAGE), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::STORAGE_IMAGE), (4, vk::DescriptorType::STORAGE_IMAGE), (5, vk::DescriptorType::STORAGE_IMAGE), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), (13, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (15, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (21, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (25, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Tiles", "tile_work", 0), ],
};
/// `water/shape.comp`
pub const WATER_SHAPE_COMP: Shader = Shader {
    name: "water/shape.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.shape.comp.spv"))); &CODE.0 },
    push_size: 20,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "cells", 0), ("Push", "buckets", 4), ("Push", "ratio", 8), ("Push", "fewest", 12), ("Push", "lone", 16), ("Ends", "ends", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Shaped", "shaped", 0), ("Shifts", "shifts", 0), ("CountBuffer", "sorted", 0), ],
};
/// `water/shape_centre.comp`
pub const WATER_SHAPE_CENTRE_COMP: Shader = Shader {
    name: "water/shape_centre.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.shape_centre.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "cells", 0), ("Push", "buckets", 4), ("Push", "centred", 8), ("Ends", "ends", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Shifts", "shifts", 0), ("Shaped", "shaped", 0), ("CountBuffer", "sorted", 0), ],
};
/// `water/shape_count.comp`
pub const WATER_SHAPE_COUNT_COMP: Shader = Shader {
    name: "water/shape_count.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.shape_count.comp.spv"))); &CODE.0 },
    push_size: 32,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "chunk_first", 8), ("Push", "chunk", 12), ("Push", "count", 16), ("Push", "from_gpu", 20), ("Push", "buckets", 24), ("Push", "cells", 28), ("HostCount", "host_count", 0), ("Positions", "positions", 0), ("Buckets", "buckets", 0), ("Shaped", "shaped", 0), ],
};
/// `water/shape_fill.comp`
pub const WATER_SHAPE_FILL_COMP: Shader = Shader {
    name: "water/shape_fill.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.shape_fill.comp.spv"))); &CODE.0 },
    push_size: 32,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "chunk_first", 8), ("Push", "chunk", 12), ("Push", "count", 16), ("Push", "from_gpu", 20), ("Push", "buckets", 24), ("Push", "cells", 28), ("HostCount", "host_count", 0), ("Positions", "positions", 0), ("Place", "position", 0), ("Place", "id", 12), ("Places", "places", 0), ("Buckets", "buckets", 0), ],
};
/// `water/smooth.comp`
pub const WATER_SMOOTH_COMP: Shader = Shader {
    name: "water/smooth.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [8, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "iteration", 0), ("Push", "columns", 4), ("Arguments", "arguments", 0), ("List", "list", 0), ],
};
/// `water/smooth.frag`
pub const WATER_SMOOTH_FRAG: Shader = Shader {
    name: "water/smooth.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth.frag.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "iteration", 0), ("Push", "columns", 4), ("Push", "block", 8), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ],
};
/// `water/smooth.vert`
pub const WATER_SMOOTH_VERT: Shader = Shader {
    name: "water/smooth.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth.vert.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("List", "list", 0), ("Push", "iteration", 0), ("Push", "columns", 4), ("Push", "block", 8), ("Predicates", "predicates", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/smooth_fused.comp`
pub const WATER_SMOOTH_FUSED_COMP: Shader = Shader {
    name: "water/smooth_fused.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth_fused.comp.spv"))); &CODE.0 },
    push_size: 12,
    local_size: [32, 8, 1],
    shared: 8192,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (2, vk::DescriptorType::STORAGE_IMAGE), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "iteration", 0), ("Push", "columns", 4), ("Push", "arguments_index", 8), ("Arguments", "arguments", 0), ("List", "list", 0), ],
};
/// `water/smooth_gate.comp`
pub const WATER_SMOOTH_GATE_COMP: Shader = Shader {
    name: "water/smooth_gate.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.smooth_gate.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Predicates", "predicates", 0), ("Push", "block", 0), ("Results", "results", 0), ],
};
/// `water/split.comp`
pub const WATER_SPLIT_COMP: Shader = Shader {
    name: "water/split.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.split.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [8, 8, 1],
    shared: 4,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (6, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::UNIFORM_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Boundaries", "boundaries", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Tiles", "tile_work", 0), ("Lists", "lists", 0), ("Push", "tiles", 0), ("Lengths", "lengths", 0), ("Arguments", "arguments", 0), ("List", "list", 0), ],
};
/// `water/split_end.comp`
pub const WATER_SPLIT_END_COMP: Shader = Shader {
    name: "water/split_end.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.split_end.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Lengths", "lengths", 0), ("Arguments", "arguments", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/spray.frag`
pub const WATER_SPRAY_FRAG: Shader = Shader {
    name: "water/spray.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.spray.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/spray.vert`
pub const WATER_SPRAY_VERT: Shader = Shader {
    name: "water/spray.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.spray.vert.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 7,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (16, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (17, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (18, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (19, vk::DescriptorType::UNIFORM_BUFFER), (24, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (27, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Span", "span", 0), ("SpraySprite", "centre", 0), ("SpraySprite", "velocity", 16), ("Sprites", "sprites", 0), ],
};
/// `water/spray_list.comp`
pub const WATER_SPRAY_LIST_COMP: Shader = Shader {
    name: "water/spray_list.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.spray_list.comp.spv"))); &CODE.0 },
    push_size: 40,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Push", "position_word", 0), ("Push", "position_stride", 4), ("Push", "density_word", 8), ("Push", "density_stride", 12), ("Push", "velocity_word", 16), ("Push", "velocity_stride", 20), ("Push", "id_word", 24), ("Push", "id_stride", 28), ("Push", "chunk_first", 32), ("Push", "packets", 36), ("Members", "members", 0), ("Densities", "densities", 0), ("Positions", "positions", 0), ("Velocities", "velocities", 0), ("Ids", "ids", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("SpraySprite", "centre", 0), ("SpraySprite", "velocity", 16), ("Sprites", "sprites", 0), ],
};
/// `water/thickness.comp`
pub const WATER_THICKNESS_COMP: Shader = Shader {
    name: "water/thickness.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness.comp.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [64, 1, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (4, vk::DescriptorType::STORAGE_BUFFER), (5, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), (8, vk::DescriptorType::STORAGE_BUFFER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Visible", "visible", 0), ("Shares", "shares", 0), ("Sums", "sums", 0), ("FoamWords", "foam_words", 0), ("Boundaries", "boundaries", 0), ("Blocks", "blocks", 0), ("Counts", "small", 0), ("Counts", "points_instances", 4), ("Counts", "points_vertex", 8), ("Counts", "points_instance", 12), ("Counts", "quads_vertices", 16), ("Counts", "large", 20), ("Counts", "quads_vertex", 24), ("Counts", "quads_instance", 28), ("Counts", "small_groups", 32), ("Counts", "large_groups", 44), ("Counts", "cull_groups", 56), ("Counts", "particles", 68), ("Counts", "dropped", 72), ("Counts", "spray", 76), ("Counts", "foam_vertices", 80), ("Counts", "foam", 84), ("Counts", "foam_vertex", 88), ("Counts", "foam_instance", 92), ("Counts", "spray_vertices", 96), ("Counts", "droplets", 100), ("Counts", "spray_vertex", 104), ("Counts", "spray_instance", 108), ("Counts", "cast_vertices", 112), ("Counts", "cast_particles", 116), ("Counts", "cast_vertex", 120), ("Counts", "cast_instance", 124), ("Counts", "noise_vertices", 128), ("Counts", "noise", 132), ("Counts", "noise_vertex", 136), ("Counts", "noise_instance", 140), ("Counts", "foam_groups", 144), ("CountBuffer", "counts", 0), ("Push", "capacity", 0), ],
};
/// `water/thickness.frag`
pub const WATER_THICKNESS_FRAG: Shader = Shader {
    name: "water/thickness.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 1,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/thickness.vert`
pub const WATER_THICKNESS_VERT: Shader = Shader {
    name: "water/thickness.vert",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness.vert.spv"))); &CODE.0 },
    push_size: 4,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 3,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (6, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Push", "capacity", 0), ("Visible", "visible", 0), ("Shares", "shares", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// `water/thickness_apart.comp`
pub const WATER_THICKNESS_APART_COMP: Shader = Shader {
    name: "water/thickness_apart.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_apart.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Sums", "sums", 0), ("Boundaries", "boundaries", 0), ],
};
/// `water/thickness_apart.frag`
pub const WATER_THICKNESS_APART_FRAG: Shader = Shader {
    name: "water/thickness_apart.frag",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_apart.frag.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [1, 1, 1],
    shared: 0,
    outputs: 2,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (2, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), (11, vk::DescriptorType::STORAGE_BUFFER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Boundaries", "boundaries", 0), ],
};
/// `water/thickness_before.comp`
pub const WATER_THICKNESS_BEFORE_COMP: Shader = Shader {
    name: "water/thickness_before.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_before.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), (7, vk::DescriptorType::COMBINED_IMAGE_SAMPLER), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Sums", "sums", 0), ],
};
/// `water/thickness_resolve.comp`
pub const WATER_THICKNESS_RESOLVE_COMP: Shader = Shader {
    name: "water/thickness_resolve.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.thickness_resolve.comp.spv"))); &CODE.0 },
    push_size: 0,
    local_size: [16, 16, 1],
    shared: 0,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_IMAGE), ],
    members: &[("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ("Sums", "sums", 0), ],
};
/// `water/tiles.comp`
pub const WATER_TILES_COMP: Shader = Shader {
    name: "water/tiles.comp",
    code: { const CODE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/water.tiles.comp.spv"))); &CODE.0 },
    push_size: 8,
    local_size: [256, 1, 1],
    shared: 4096,
    outputs: 0,
    bindings: &[(0, vk::DescriptorType::UNIFORM_BUFFER), (1, vk::DescriptorType::STORAGE_BUFFER), (2, vk::DescriptorType::STORAGE_BUFFER), (3, vk::DescriptorType::STORAGE_BUFFER), (7, vk::DescriptorType::UNIFORM_BUFFER), ],
    members: &[("Level", "rect", 0), ("Level", "slope", 16), ("Level", "texel", 32), ("Levels", "level", 0), ("Levels", "atlas", 336), ("Levels", "near", 352), ("Tiles", "tile_work", 0), ("Push", "tiles", 0), ("Push", "most_groups", 4), ("Arguments", "arguments", 0), ("List", "list", 0), ("Frame", "view", 0), ("Frame", "world", 64), ("Frame", "projection", 128), ("Frame", "depth", 144), ("Frame", "planes", 160), ("Frame", "extent", 256), ("Frame", "thick_extent", 272), ("Frame", "slope", 288), ("Frame", "thick_slope", 304), ("Frame", "texel", 320), ("Frame", "scene_depth", 336), ("Frame", "scene_color", 352), ("Frame", "scene_origin", 368), ("Frame", "target", 384), ("Frame", "particle", 400), ("Frame", "density", 416), ("Frame", "smoothing", 432), ("Frame", "medium_a", 448), ("Frame", "medium_b", 464), ("Frame", "fresnel", 480), ("Frame", "surface", 496), ("Frame", "sun_direction", 512), ("Frame", "sun_color", 528), ("Frame", "ambient", 544), ("Frame", "foam", 560), ("Frame", "foam_noise", 576), ("Frame", "foam_pattern", 592), ("Frame", "foam_octaves", 608), ("Frame", "foam_phases", 624), ("Frame", "foam_back", 640), ("Frame", "foam_front", 656), ("Frame", "spray", 672), ("Frame", "spray_color", 688), ("Frame", "spray_cloud", 704), ("Frame", "shadow", 720), ("Frame", "to_light", 784), ("Frame", "shadow_map", 848), ("Frame", "shadow_rect", 864), ("Frame", "light_map", 880), ("Frame", "shade", 896), ("Frame", "lit_color", 912), ("Frame", "lit_origin", 928), ("Frame", "shadow_linear", 944), ("Frame", "shadow_basis", 960), ("Frame", "shadow_filter", 976), ("Frame", "shadow_weight", 992), ("Frame", "before", 1056), ("Frame", "before_lens", 1120), ("Frame", "lens_change", 1136), ("Frame", "motion", 1152), ("Frame", "noise", 1168), ("Frame", "noise_image", 1184), ("Frame", "noise_color", 1200), ("Frame", "diffuse", 1216), ("Frame", "diffuse_below", 1232), ("Frame", "diffuse_light", 1248), ("Frame", "diffuse_search", 1264), ("Frame", "diffuse_samples", 1280), ("Frame", "diffuse_opacity", 1296), ("Frame", "diffuse_shadow", 1312), ("Frame", "diffuse_color", 1328), ("Frame", "diffuse_shapes", 1344), ("Frame", "diffuse_life", 1392), ("Frame", "diffuse_sun", 1408), ("Frame", "shore_color", 1424), ("Frame", "contact_color", 1440), ("Frame", "up", 1456), ("Frame", "bed", 1472), ("Frame", "bed_light", 1488), ],
};
/// All there are.
pub const ALL: &[Shader] = &[
    BUBBLES_BEGIN_COMP,
    BUBBLES_BLOBS_COMP,
    BUBBLES_CAST_COMP,
    BUBBLES_CORE_COMP,
    BUBBLES_FILM_COMP,
    BUBBLES_HEAP_MOVE_COMP,
    BUBBLES_HEAP_ORDER_COMP,
    BUBBLES_HEAP_PLACE_COMP,
    BUBBLES_HEAP_SET_COMP,
    BUBBLES_IMPOSTOR_COMP,
    BUBBLES_NEAR_COMP,
    BUBBLES_NEAR_RANGE_COMP,
    BUBBLES_PEEL_COMP,
    BUBBLES_PEEL_FRAG,
    BUBBLES_PEEL_VERT,
    BUBBLES_PEEL_KEEP_COMP,
    BUBBLES_PEEL_OPACITY_FRAG,
    BUBBLES_SOAP_COMP,
    COMPOSITE_COMP,
    COMPOSITE_FRAG,
    COMPOSITE_VERT,
    ENVIRONMENT_EQUIRECT_COMP,
    ENVIRONMENT_IRRADIANCE_COMP,
    ENVIRONMENT_SKY_COMP,
    FOAM_BEGIN_COMP,
    FOAM_BLUR_COMP,
    FOAM_RADIANCE_COMP,
    FOAM_RESOLVE_COMP,
    FOAM_RESOLVE_QUADS_COMP,
    FOAM_SPLAT_COMP,
    FOAM_SPLAT_VERT,
    FOAM_SPLAT64_COMP,
    FOAM_SPLAT_FRONT_FRAG,
    FOAM_SPLAT_THICKNESS_FRAG,
    FOAM_SURFACE_COMP,
    FOAM_TILES_COMP,
    GENERATE_ADVANCE_COMP,
    GENERATE_BEGIN_COMP,
    GENERATE_COUNT_COMP,
    GENERATE_CREST_COMP,
    GENERATE_EMIT_COMP,
    GENERATE_END_COMP,
    GENERATE_FILL_COMP,
    GENERATE_FREE_COMP,
    GENERATE_POTENTIALS_COMP,
    GENERATE_TRACE_COMP,
    GPU_SCAN_APPLY_COMP,
    GPU_SCAN_BLOCKS_COMP,
    GPU_SCAN_SUM_COMP,
    HEADLESS_DEPTH_VERT,
    HEADLESS_IRRADIANCE_COMP,
    HEADLESS_SCENE_FRAG,
    HEADLESS_SCENE_VERT,
    HEADLESS_SKY_FRAG,
    HEADLESS_SKY_VERT,
    LIGHT_CAUSTICS_COMP,
    LIGHT_CAUSTICS_RESOLVE_COMP,
    LIGHT_CONVOLUTION_COMP,
    LIGHT_CONVOLUTION_ACROSS_COMP,
    LIGHT_CONVOLUTION_DOWN_COMP,
    LIGHT_CONVOLUTION_SPAN_COMP,
    LIGHT_COVER_VERT,
    LIGHT_DIFFUSE_COMP,
    LIGHT_DIFFUSE_BEGIN_COMP,
    LIGHT_DIFFUSE_RESOLVE_COMP,
    LIGHT_FRONT_FRAG,
    LIGHT_LIT_FRAG,
    LIGHT_LIT_OUT_COMP,
    LIGHT_LIT_OUT_FRAG,
    LIGHT_SMOOTH_COMP,
    LIGHT_SPRITES_VERT,
    LIGHT_THICKNESS_FRAG,
    SHORE_COAT_COMP,
    SHORE_COAT_FRAG,
    SHORE_COAT_VERT,
    SHORE_CONTACT_COMP,
    SHORE_CONTACT_TILES_COMP,
    SHORE_MAP_DISTANCE_COMP,
    SHORE_MAP_HEIGHT_FRAG,
    SHORE_MAP_HEIGHT_VERT,
    SHORE_MAP_JUMP_COMP,
    SHORE_MAP_SEED_COMP,
    SHORE_RUNS_COMP,
    SHORE_SHORELINE_COMP,
    SHORE_STRIP_FRAG,
    SHORE_STRIP_VERT,
    SHORE_STRIP_TILES_COMP,
    SHORE_TEXTURE_COMP,
    SHORE_TILES_COMP,
    WATER_BACK_COMP,
    WATER_BACK_BEGIN_COMP,
    WATER_BACK_PLAN_COMP,
    WATER_CLASSIFY_COMP,
    WATER_CULL_COMP,
    WATER_CULL_BEGIN_COMP,
    WATER_CULL_END_COMP,
    WATER_DEPTH_COMP,
    WATER_DEPTH_FRAG,
    WATER_DEPTH_VERT,
    WATER_FOAM_COMP,
    WATER_FOAM_VERT,
    WATER_FOAM_BEGIN_COMP,
    WATER_FOAM_DEPTH_FRAG,
    WATER_FOAM_DRIFT_COMP,
    WATER_FOAM_LIST_COMP,
    WATER_FOAM_RESOLVE_COMP,
    WATER_FOAM_THICKNESS_FRAG,
    WATER_FRONT_COMP,
    WATER_FRONT_COVER_COMP,
    WATER_GAPS_COMP,
    WATER_GAPS_BLOCKS_COMP,
    WATER_GAPS_FIND_COMP,
    WATER_GAPS_SPREAD_COMP,
    WATER_GAPS_TEXELS_COMP,
    WATER_LEVEL_COMP,
    WATER_LEVEL_MARK_COMP,
    WATER_MOTION_COMP,
    WATER_MOTION_FRONT_COMP,
    WATER_MOTION_RESOLVE_COMP,
    WATER_NOISE_FRAG,
    WATER_NOISE_VERT,
    WATER_NOISE_LIST_COMP,
    WATER_REDUCE_COMP,
    WATER_SHAPE_COMP,
    WATER_SHAPE_CENTRE_COMP,
    WATER_SHAPE_COUNT_COMP,
    WATER_SHAPE_FILL_COMP,
    WATER_SMOOTH_COMP,
    WATER_SMOOTH_FRAG,
    WATER_SMOOTH_VERT,
    WATER_SMOOTH_FUSED_COMP,
    WATER_SMOOTH_GATE_COMP,
    WATER_SPLIT_COMP,
    WATER_SPLIT_END_COMP,
    WATER_SPRAY_FRAG,
    WATER_SPRAY_VERT,
    WATER_SPRAY_LIST_COMP,
    WATER_THICKNESS_COMP,
    WATER_THICKNESS_FRAG,
    WATER_THICKNESS_VERT,
    WATER_THICKNESS_APART_COMP,
    WATER_THICKNESS_APART_FRAG,
    WATER_THICKNESS_BEFORE_COMP,
    WATER_THICKNESS_RESOLVE_COMP,
    WATER_TILES_COMP,
];
