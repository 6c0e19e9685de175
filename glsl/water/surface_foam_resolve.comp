#version 460
// Pass `surface_foam`, compute path, last part: converts the sums of thickness from fixed point to scene
// units, and copies the depth of the frontmost foam.
// Reads: words. Writes: foam depth, foam thickness.

#include "frame.glsl"
#include "surface_foam_sums.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Words { uint words[]; };
// A format qualifier would need a feature (shaderStorageImageExtendedFormats), so there is none.
layout(set = 0, binding = 2) uniform writeonly image2D thickness;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D depth;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, ivec2(frame.thick_extent.xy)))) {
        uint at = words_of(texel);
        uint all = min(words[at + ALL], FULL);
        uint front = all - min(words[at + LATE], all);
        uint far = min(words[at + FAR], all);
        uint lit = LIT == 1u ? front - min(words[at + UNLIT], front) : front;
        imageStore(thickness, texel, vec4(all, front, lit, far) * frame.foam_back.w);
        bool none = words[at + FRONT] == words[at + SCENE];
        imageStore(depth, texel, vec4(none ? EMPTY : uintBitsToFloat(words[at + FRONT])));
    }
}
