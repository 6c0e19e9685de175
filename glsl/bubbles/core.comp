#version 460
// Pass `core`: texture of small bubbles inside a blob, once per renderer (Huszar, Szecsi, Sec. 4.4, where an artist
// draws it): cellular noise on the sphere (Worley, A Cellular Texture Basis Function, 1996) of three sizes, brighter
// along the seams.
// Reads: nothing. Writes: core (RGBA16F), octahedral with a border: xyz tilt of the normal, w brightness with mean 1.

#include "octahedral.glsl"
#include "random.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform writeonly image2D core;
layout(push_constant, std430) uniform Push {
    uint size; // without its border
    uint seed;
} push;

// Vector from the nearest feature point (one per cell of size 1) to p, and the distance to the second nearest point
// minus that to the nearest.
vec4 nearest_point(vec3 p, uint seed) {
    ivec3 cell = ivec3(floor(p));
    vec3 best = vec3(0.0);
    float first = 1.0e10;
    float second = 1.0e10;
    for (int i = 0; i < 27; ++i) {
        ivec3 at = cell + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        uint id = pcg(uint(at.x) + pcg(uint(at.y) + pcg(uint(at.z) + seed)));
        vec3 off = vec3(pcg(id) >> 8, pcg(id + 1u) >> 8, pcg(id + 2u) >> 8) / 16777216.0;
        vec3 to = p - vec3(at) - off;
        float far = dot(to, to);
        bool nearer = far < first;
        second = nearer ? first : min(second, far);
        best = nearer ? to : best;
        first = nearer ? far : first;
    }
    return vec4(best, sqrt(second) - sqrt(first));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (max(texel.x, texel.y) >= int(push.size) + 2) {
        return;
    }
    vec3 direction = octahedral_direction((vec2(texel) - 0.5) / float(push.size) * 2.0 - 1.0);
    vec3 lean = vec3(0.0);
    float brightness = 1.0;
    float cells = 6.0;
    float part = 1.0;
    for (uint octave = 0u; octave < 3u; ++octave) {
        vec4 near = nearest_point(direction * cells, pcg(push.seed + octave));
        // Each cell is round like a bubble, with a bright seam between two bubbles and darkness beside the seam.
        float seam = 1.0 - smoothstep(0.0, 0.18, near.w);
        float round_ = clamp(1.0 - dot(near.xyz, near.xyz), 0.0, 1.0);
        lean += part * 0.6 * near.xyz;
        brightness += part * (0.35 * seam + 0.3 * (round_ - 0.72));
        cells *= 2.1;
        part *= 0.6;
    }
    // The mean of the values added above, a fifth, is subtracted.
    imageStore(core, texel, vec4(lean, clamp(brightness - 0.2, 0.2, 1.8)));
}
