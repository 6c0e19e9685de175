#version 460
// Pass `splat` by quads, last part: for each pixel, writes depth and normal of the frontmost whitewater particle to
// images, and converts the summed thickness to the foam's intensity (Akinci et al. 2013, Sec. 2.3; pass 5).
// Reads: words, the frontmost, foam thickness. Writes: depths of foam, fluid and scene with the foam's intensity, foam
// normal.

#include "frame.glsl"
#include "whitewater_words.glsl"
#include "intensity.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Words { uint words[]; };
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D occluders;
layout(set = 0, binding = 3) uniform sampler2D thickness;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D normal;
layout(set = 0, binding = 5) uniform usampler2D fronts;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, ivec2(frame.extent.xy)))) {
        uint at = words_of(pixel);
        uvec2 front = texelFetch(fronts, pixel, 0).xy;
        vec2 sums = texelFetch(thickness, pixel, 0).xy;
        bool some = front.x < words[at + SCENE];
        vec2 behind = uintBitsToFloat(uvec2(words[at + FLUID], words[at + SCENE]));
        float depth = some ? uintBitsToFloat(front.x) : EMPTY;
        imageStore(occluders, pixel, vec4(depth, intensity_of(sums.x + sums.y), behind));
        imageStore(normal, pixel, some ? unpack_with(front.y) : vec4(0.0));
    }
}
