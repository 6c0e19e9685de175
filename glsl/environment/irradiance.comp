#version 460
// Pass `environment`: computes for each normal the irradiance divided by 2 pi. A constant environment of 1 then gives
// one half, as do the samples of the environment that this look-up replaces (Akinci et al. 2013, Sec. 2.4.2).
// Reads: environment. Writes: irradiance (RGBA16F), octahedral with a border.

#include "cube.glsl"
#include "octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform writeonly image2D irradiance;
layout(set = 0, binding = 1) uniform samplerCube environment;
layout(push_constant, std430) uniform Push {
    uint size;   // size of the irradiance without its border
    uint coarse; // mip level of the environment that is read
    float mip;
} push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID);
    if (max(texel.x, texel.y) >= int(push.size) + 2) {
        return;
    }
    vec3 normal = octahedral_direction((vec2(texel) - 0.5) / float(push.size) * 2.0 - 1.0);
    vec4 sum = vec4(0.0);
    int n = int(push.coarse);
    for (int i = 0; i < 6 * n * n; ++i) {
        ivec3 from = ivec3(i % n, i / n % n, i / (n * n));
        vec3 direction = cube_direction(from, n);
        // Solid angle of a texel, up to a constant factor.
        vec2 place = (vec2(from.xy) + 0.5) / float(n) * 2.0 - 1.0;
        float angle = pow(1.0 + dot(place, place), -1.5);
        vec3 light = textureLod(environment, direction, push.mip).rgb;
        sum += angle * vec4(max(dot(direction, normal), 0.0) * light, 1.0);
    }
    // The sum of the weights stands for all directions (4 pi), so the factor 2 makes this the irradiance over 2 pi.
    imageStore(irradiance, texel, vec4(min(2.0 * sum.rgb / sum.w, 65000.0), 1.0));
}
