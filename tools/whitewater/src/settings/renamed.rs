//! Tables and keys that were renamed. Their old names are refused, and the error gives the new ones.

/// Table, old key (empty for the table itself), and new name.
pub const RENAMED: &[(&str, &str, &str)] = &[
    ("foam", "", "[surface_foam]"),
    ("diffuse", "", "[whitewater]"),
    ("surface_foam", "veil", "min_thickness"),
    ("surface_foam", "relief", "normal_strength"),
    ("spray", "densities", "all_spray_density, full_water_density and no_spray_density"),
    ("spray", "spread", "scatter_radius"),
    ("spray", "shutter", "exposure"),
    ("spray", "mist_contrast", "clumps"),
    ("whitewater", "half", "half_intensity_thickness"),
    ("whitewater", "search", "search_radius and search_radius_step"),
    ("whitewater", "density", "sample_density"),
    ("whitewater", "samples", "min_samples and max_samples"),
    ("whitewater", "opacity", "fluid_opacity and scene_opacity"),
    ("whitewater", "shadow", "shadow_scale, shadow_exponent and shadow_offset"),
    ("bubbles", "core", "core_opaque_radius and core_outer_radius"),
    ("bubbles", "plug", "fill_holes"),
    ("bubbles", "merge", "min_pixels"),
    ("bubbles", "templates", "variants"),
    ("bubbles", "map", "map_size"),
    ("bubbles", "hand_over", "crossfade"),
    ("bubbles", "hand_over_size", "crossfade_size"),
    ("bubbles", "hand_over_blobs", "crossfade_blobs"),
    ("generate", "lifetime", "min_lifetime and max_lifetime"),
    ("shoreline", "reach", "sea_reach and land_reach"),
    ("shoreline", "swing_by", "swing_amplitude and swing_period"),
    ("shoreline", "wave_rise", "wave_slope and wave_offset"),
    ("shoreline", "web_rise", "texture_slope and texture_offset"),
    ("shoreline", "wave_ratio", "wave_weight"),
    ("shoreline", "web_ratio", "texture_weight"),
    ("shoreline", "web_warp", "texture_warp"),
    ("shoreline", "web_warp_speed", "texture_warp_velocity"),
    ("shore", "web_size", "texture_size"),
];

/// The message for the first renamed table or key in a text.
pub fn find(text: &str) -> Option<String> {
    let file: toml::Table = text.parse().ok()?;
    RENAMED.iter().find_map(|(table, key, new)| {
        let found = file.get(*table)?;
        if key.is_empty() {
            return Some(format!("table [{table}] was renamed: use {new}"));
        }
        found.get(*key)?;
        Some(format!("[{table}] {key} was renamed: use {new}"))
    })
}
