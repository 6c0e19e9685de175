#version 460
// Pass `caustics`, first part: smooths the front depth of the water in the light map along one axis, by a Gaussian that
// ends at 2.5 standard deviations or 64 texels. Only texels with a similar depth, which are on the same surface, count.
// Not in the paper. Reads: front, or the result of the first axis. Writes: smoothed.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D smoothed;

layout(push_constant, std430) uniform Push { int vertical; } push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int size = int(frame.light_map.x);
    if (any(greaterThanEqual(texel, ivec2(size)))) {
        return;
    }
    float here = texelFetch(source, texel, 0).x;
    float sigma = max(frame.light_map.z / frame.light_map.y, 1.0e-3);
    int reach = min(int(ceil(2.5 * sigma)), 64);
    ivec2 axis = push.vertical == 1 ? ivec2(0, 1) : ivec2(1, 0);
    float sum = 0.0;
    float weights = 0.0;
    for (int i = -reach; i <= reach; ++i) {
        ivec2 t = clamp(texel + i * axis, ivec2(0), ivec2(size - 1));
        float there = texelFetch(source, t, 0).x;
        float weight = exp(-0.5 * float(i * i) / (sigma * sigma));
        weight = abs(there - here) <= frame.smoothing.y ? weight : 0.0;
        sum += weight * (there - here);
        weights += weight;
    }
    imageStore(smoothed, texel, vec4(here < EMPTY ? here + sum / weights : EMPTY));
}
