// The resolutions of the smoothing (pass `level` writes them). Two of the front sheet share the
// smoothing images and the plan, one above the other; mostly only the first is in use. The third,
// of the back sheet, lies to the right of the second. Needs nothing. Reads: levels.

struct Level {
    ivec4 rect;  // in the images: first texel, size
    vec4 slope;  // texel of the level, from its own corner -> slope: scale xy, offset zw
    vec4 texel;  // C_x C_y: world size of a texel per depth; its edge in full pixels; weight
};

layout(set = 0, binding = 7, std140) uniform Levels {
    Level level[3];
    ivec4 atlas; // size of the images; tiles a row; first row of the second level
} levels;

// The level that a texel of the images belongs to.
uint level_of(ivec2 texel) {
    return texel.y < levels.atlas.w ? 0u : texel.x < levels.level[2].rect.x ? 1u : 2u;
}

// The finer one of the front sheet's in use.
uint finer_level() {
    vec2 weight = vec2(levels.level[0].texel.w, levels.level[1].texel.w);
    vec2 edge = vec2(levels.level[0].texel.z, levels.level[1].texel.z);
    return weight.y > 0.0 && (weight.x == 0.0 || edge.y < edge.x) ? 1u : 0u;
}
