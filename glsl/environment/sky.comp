#version 460
// Pass `environment`: writes the built-in sky (atmosphere.glsl) to the first mip of the environment's cube map.
// Reads: only the sun. Writes: environment (RGBA16F), all faces.

#include "cube.glsl"
#include "atmosphere.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform writeonly image2DArray environment;
layout(push_constant, std430) uniform Push {
    vec4 sun;   // direction to it (y up), its irradiance
    vec4 east;  // world direction of the environment's x axis
    vec4 up;
    uint size;
} push;

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (max(texel.x, texel.y) >= int(push.size)) {
        return;
    }
    vec3 d = standing(cube_direction(texel, int(push.size)), push.east.xyz, push.up.xyz);
    vec3 sky = push.sun.w * sky_radiance(d, push.sun.xyz);
    imageStore(environment, texel, vec4(min(sky, 65000.0), 1.0));
}
