// Shared by the passes that list tiles, one invocation per tile. Needs frame.glsl, shore.glsl, shore_lists.glsl.
// Reads: scene depth. Writes: lists, arguments.

layout(set = 0, binding = 2) uniform sampler2D scene_depth;

// Adds the invocation's tile to a list.
void adds(uint kind) {
    uint slot = atomicAdd(arguments[4u * kind + 3u], 1u);
    lists(kind, slot, gl_GlobalInvocationID.y * push.across + gl_GlobalInvocationID.x);
    dispatches(kind, slot, TILES);
}

const int HALF = int(TILE) / 2;
const int FOURS = HALF * HALF; // of pixels in a tile

// The first of four pixels in a tile.
vec2 four_of(vec2 first, int i) {
    return first + 2.0 * vec2(i % HALF, i / HALF);
}

// A pixel of four, in the order of a gather.
vec2 pixel_of(vec2 first, int i) {
    return first + vec2(i == 1 || i == 2 ? 1.5 : 0.5, i < 2 ? 1.5 : 0.5);
}

// Scene depths, as stored, at the 2x2 pixels whose first corner is `first`, in the order of textureGather; `texel` is
// 1 / size of the depth image. Some pixels may lie outside the picture.
vec4 scene_at_four(vec2 first, vec2 texel) {
    if (GENERAL == 0u) {
        return textureGather(scene_depth, (first + 1.0 + frame.scene_origin.xy) * texel);
    }
    // The image has another resolution than the picture.
    vec4 four;
    for (int i = 0; i < 4; ++i) {
        four[i] = texelFetch(scene_depth, scene_texel(min(pixel_of(first, i), frame.extent.xy - 0.5)), 0).x;
    }
    return four;
}

// Factor from a distance along the view axis to the distance that contact foam measures: with the vertical measure
// the height that the ray falls per unit of eye depth, otherwise 1.
float counted(vec3 ray) {
    return shore.contact.w == 2.0 ? max(-dot(shore.height.xyz, ray), 0.0) : 1.0;
}
