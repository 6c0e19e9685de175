#version 460
// Pass `splat`, last part: converts the words to images, and the thickness to intensity (Akinci et al. 2013, Sec. 2.3;
// pass 5).
// Reads: words. Writes: depths of foam, fluid and scene with the foam's intensity, foam thickness, foam normal.

#include "frame.glsl"
#include "whitewater_words.glsl"
#include "intensity.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
// Two entries per pixel.
layout(set = 0, binding = 1, std430) readonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D occluders;
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D thickness;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D normal;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, ivec2(frame.extent.xy)))) {
        uint at = words_of(pixel) / 4u;
        uvec4 head = words[at];
        vec3 sums = vec3(words[at + SUMS / 4u].xyz) / STEPS;
        bool some = head[FRONT] < head[SCENE];
        vec3 depths = uintBitsToFloat(uvec3(head[FRONT], head[FLUID], head[SCENE]));
        float all = intensity_of(sums.x + sums.y);
        imageStore(occluders, pixel, vec4(some ? depths.x : EMPTY, all, depths.yz));
        imageStore(thickness, pixel, vec4(sums, 0.0));
        imageStore(normal, pixel, some ? unpack_with(head[WITH]) : vec4(0.0));
    }
}
