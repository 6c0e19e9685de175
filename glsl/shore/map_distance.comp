#version 460
// Pass `map`, distances: the distance in scene units from each texel of the map to the shore line. Each texel has a
// seed, the nearest known point of the line; at the seed the line is taken as a straight segment of one texel's
// length, and the distance to this segment is stored. Distances are negative in the water.
// Reads: seeds, heights. Writes: distances.

#include "shore_map.glsl"
#include "shore_height.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Seeds { uint seeds[]; };
layout(set = 0, binding = 2, r32f) uniform writeonly image2D distances;

// Gradient of the height at a point, from the four texels around it.
vec2 rise_at(vec2 place) {
    // Keep all four texels inside the map.
    ivec2 base = clamp(ivec2(floor(place - 0.5)), ivec2(0), ivec2(push.size - 2));
    vec2 f = place - 0.5 - vec2(base);
    vec4 h = vec4(height_at(base), height_at(base + ivec2(1, 0)), height_at(base + ivec2(0, 1)), height_at(base + 1));
    return vec2(mix(h.y - h.x, h.w - h.z, f.y), mix(h.z - h.x, h.w - h.y, f.x));
}

void main() {
    ivec2 texel;
    if (!texel_of(gl_GlobalInvocationID.xy, texel)) {
        return;
    }
    uint seed = seeds[texel.y * push.size + texel.x];
    bool land = height_at(texel) > 0.0;
    // Farther than any distance that is used.
    float distance = 2.0 * float(push.size);
    if (seed != NONE) {
        vec2 to = place_of(seed) - vec2(texel) - 0.5;
        vec2 rise = rise_at(place_of(seed));
        float steep = length(rise);
        vec2 across = steep > 0.0 ? rise / steep : vec2(0.0);
        float off = steep > 0.0 ? dot(to, across) : length(to);
        float along = steep > 0.0 ? max(abs(to.x * across.y - to.y * across.x) - 0.5, 0.0) : 0.0;
        distance = length(vec2(off, along));
    }
    imageStore(distances, texel, vec4((land ? distance : -distance) * push.texel));
}
