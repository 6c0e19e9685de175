#version 460
// Pass `surface_foam`, compute path, first part: clears all texels and stores the scene's depth at their centres.
// Sprites read this depth many times, and reading a word beside the sums is faster than reading a texel of an image.
// Reads: scene depth. Writes: words.

#include "frame.glsl"
#include "surface_foam_sums.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) writeonly buffer Words { uint words[]; };
layout(set = 0, binding = 2) uniform sampler2D scene_depth;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, ivec2(frame.thick_extent.xy)))) {
        vec2 pixel = (vec2(texel) + 0.5) * frame.thick_extent.z;
        float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
        uint at = words_of(texel);
        // With a reversed infinite depth, infinity is 1/0, or negative by rounding.
        uint bits = floatBitsToUint(scene > 0.0 ? min(scene, EMPTY) : EMPTY);
        words[at + FRONT] = bits;
        words[at + SCENE] = bits;
        for (uint word = ALL; word < WORDS; ++word) {
            words[at + word] = 0u;
        }
    }
}
