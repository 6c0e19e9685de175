// The resolutions of the smoothing. A pixel selects one by its distance: up to four of the front layer, each half of
// the one before, and up to three of the back layer, from the second on. All lie in the smoothing images and the plan,
// separated by whole tiles. Needs frame.glsl. Reads: levels.

struct Level {
    ivec4 rect;  // in the images: first texel, size; of what is not used 0
    vec4 slope;  // texel of the level, from its own corner -> slope: scale xy, offset zw
    vec4 texel;  // C_x C_y: world size of a texel per depth; its edge in full pixels; 0
};

const uint LEVELS = 7u;
const uint BACK = 4u; // the first of the back sheet

layout(set = 0, binding = 7, std140) uniform Levels {
    Level level[7];
    ivec4 atlas; // size of the images; tiles a row; levels coarser than the first
    // Iterations of the first level at depth 1 on the axis, over a quarter of the cap; (C_x / C_y)^2 ; falloff; 0.
    vec4 near;
} levels;

// The coarser levels' tiles that hold something near enough.
const uint MOST_GROUPS = 65535u; // of a dispatch, in each direction

struct Marked {
    uint groups[3]; // of a dispatch over them, a tile each
    uint count;
    uint needed;    // the coarsest level needed in the frame
};

// The level that a texel of the images belongs to; LEVELS: none.
uint level_of(ivec2 texel) {
    uint own = LEVELS;
    for (uint i = 0u; i < LEVELS; ++i) {
        ivec2 at = texel - levels.level[i].rect.xy;
        bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, levels.level[i].rect.zw));
        own = inside ? i : own;
    }
    return own;
}

// Off the axis a pixel sees the surface foreshortened, flat pixels are nearer to each other in y: more,
// smaller steps keep the smoothing stable.
float foreshortened(vec2 slope) {
    return 1.0 + slope.x * slope.x + (1.0 + slope.y * slope.y) * levels.near.y;
}

// The iterations of the first level at a depth, over a quarter of the cap. From 1 on the next level fades in, from
// 2 on it is alone, until at 4 the one after it begins: a level coarser needs a quarter of the iterations.
float nearness(float z, vec2 slope) {
    return levels.near.x * foreshortened(slope) / (z * z);
}

// The level that a point shows, and how far the next one has faded in. By the distance, not by time: a
// frame looks the same however it was come to.
uint shown_level(float near, out float fade) {
    float doubled = log2(max(near, 1.0));
    float level = floor(0.5 * doubled);
    float part = min(doubled - 2.0 * level, 1.0);
    fade = part * part * (3.0 - 2.0 * part);
    level += fade == 1.0 ? 1.0 : 0.0;
    fade = fade == 1.0 || level >= float(levels.atlas.w) ? 0.0 : fade;
    return min(uint(level), uint(levels.atlas.w));
}
