// The levels of the smoothing, which are resolutions of the smoothed depth. A pixel selects a level by its distance
// from the eye. The front layer of water has up to four levels, each with half the resolution of the one before. The
// back layer has up to three, with the resolutions of the front layer's second to fourth level. All levels lie next
// to each other in the smoothing images and in the image of the plan (iterations per texel), separated by whole
// tiles. Needs frame.glsl. Reads: levels.

struct Level {
    ivec4 rect;  // in the images: first texel, size; 0 if unused
    vec4 slope;  // texel of the level (from its corner) to slope: scale xy, offset zw
    vec4 texel;  // C_x C_y: world size of a texel per depth; width of a texel in full-resolution pixels; 0
};

const uint LEVELS = 7u;
const uint BACK = 4u; // the first level of the back sheet

layout(set = 0, binding = 7, std140) uniform Levels {
    Level level[7];
    ivec4 atlas; // size of the images; tiles per row; number of levels coarser than the first
    // For `nearness`. x: square of the smoothing width in texels of the first level at depth 1, divided by a quarter
    // of the iteration limit; y: square of a texel's width over its height in the world; z: depth falloff, scene
    // units; w: 0.
    vec4 near;
} levels;

const uint MOST_GROUPS = 65535u; // limit of a dispatch, on each axis

// The tiles of coarser levels that contain something near enough to need the level, and the tiles beside those.
struct Marked {
    uint groups[3]; // dispatch over them, one workgroup per tile
    uint count;
    uint needed;    // the coarsest level needed in the frame
};

// The level that a texel of the images belongs to; LEVELS if none.
uint level_of(ivec2 texel) {
    uint own = LEVELS;
    for (uint i = 0u; i < LEVELS; ++i) {
        ivec2 at = texel - levels.level[i].rect.xy;
        bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, levels.level[i].rect.zw));
        own = inside ? i : own;
    }
    return own;
}

// Factor on the number of iterations. Away from the optical axis the surface is foreshortened, and pixels that are
// wider than high lie closer to each other in y: there more and smaller steps keep the smoothing stable.
float foreshortened(vec2 slope) {
    return 1.0 + slope.x * slope.x + (1.0 + slope.y * slope.y) * levels.near.y;
}

// Iterations that the first level needs at a depth, divided by a quarter of the iteration limit. From 1 to 2 the
// second level fades in, from 2 to 4 only the second level shows, and from 4 on the third fades in, because each
// level needs a quarter of the iterations of the level before.
float nearness(float z, vec2 slope) {
    return levels.near.x * foreshortened(slope) / (z * z);
}

// The smoothing level that shows where `nearness` is `near`, and `fade`, how far the next level has faded in, 0 to 1.
// The fade depends on distance and not on time, so that a frame does not depend on previous frames.
uint shown_level(float near, out float fade) {
    float doubled = log2(max(near, 1.0));
    float level = floor(0.5 * doubled);
    float part = min(doubled - 2.0 * level, 1.0);
    fade = part * part * (3.0 - 2.0 * part);
    level += fade == 1.0 ? 1.0 : 0.0;
    fade = fade == 1.0 || level >= float(levels.atlas.w) ? 0.0 : fade;
    return min(uint(level), uint(levels.atlas.w));
}
