#version 460
// Pass `caustics`, last part: sunlight that arrives at each texel, divided by the sunlight that would arrive without
// water. It is slightly blurred, because the sun is not a point. A texel without water also gets its own unrefracted
// light. (Source: see caustics.comp.)
// Reads: photons, front. Writes: caustics (R32F).

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform sampler2D front;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D caustics;
layout(set = 0, binding = 3, std430) readonly buffer Photons { uint photons[]; };

const float UNITS = 4096.0;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int size = int(frame.light_map.x);
    if (any(greaterThanEqual(texel, ivec2(size)))) {
        return;
    }
    float sum = 0.0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 t = clamp(texel + ivec2(x, y), ivec2(0), ivec2(size - 1));
            float weight = float((3 - abs(x)) * (3 - abs(y))) / 81.0;
            float straight = texelFetch(front, t, 0).x < EMPTY ? 0.0 : 1.0;
            sum += weight * (float(photons[t.y * size + t.x]) / UNITS + straight);
        }
    }
    imageStore(caustics, texel, vec4(sum));
}
