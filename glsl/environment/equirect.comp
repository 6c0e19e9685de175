#version 460
// Pass `environment`: converts an equirectangular image (row 0 is up; the middle column looks along -z) to the first
// mip of the environment's cube map, four samples per texel. (The thesis starts from a given cube map, Sec. 4.9.)
// Reads: the host's image. Writes: environment (RGBA16F), all faces.

#include "cube.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform writeonly image2DArray environment;
layout(set = 0, binding = 1) uniform sampler2D equirect;
layout(push_constant, std430) uniform Push {
    vec4 east; // world direction of the environment's x axis
    vec4 up;
    uint size;
    float scale;
    float turn; // rotation about the up axis in radians
} push;

const float PI = 3.14159265;

// The middle column of the image is -z, the middle of its right half is +x.
vec2 equirect_uv(vec3 d) {
    float longitude = atan(d.x, -d.z) + push.turn;
    return vec2(fract(longitude / (2.0 * PI) + 0.5), acos(clamp(d.y, -1.0, 1.0)) / PI);
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (max(texel.x, texel.y) >= int(push.size)) {
        return;
    }
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 d = cube_direction(ivec3(2 * texel.xy + ivec2(i & 1, i >> 1), texel.z), 2 * int(push.size));
        d = standing(d, push.east.xyz, push.up.xyz);
        sum += textureLod(equirect, equirect_uv(d), 0.0).rgb;
    }
    imageStore(environment, texel, vec4(min(0.25 * push.scale * sum, 65000.0), 1.0));
}
