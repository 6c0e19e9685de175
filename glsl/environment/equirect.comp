#version 460
// Pass `environment`: converts an equirectangular image (row 0 is up; the middle column looks along -z) to the first
// mip of the environment's cube map, four samples per texel. In the image NaN and negative numbers count as 0, and
// infinite ones as 65000, so that no texel of the cube's mips and of the irradiance is NaN or infinite. (The thesis
// starts from a given cube map, Sec. 4.9.)
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
// Max radiance in the cube map, a little below that of half precision.
const float MOST = 65000.0;
const float FINITE = 3.402823466e38;

// The middle column of the image is -z, the middle of its right half is +x.
vec2 equirect_uv(vec3 d) {
    float longitude = atan(d.x, -d.z) + push.turn;
    return vec2(fract(longitude / (2.0 * PI) + 0.5), acos(clamp(d.y, -1.0, 1.0)) / PI);
}

// Comparisons with NaN are false.
bool is_light(vec3 v) {
    return all(greaterThanEqual(v, vec3(0.0))) && all(lessThanEqual(v, vec3(FINITE)));
}

vec3 light_of(vec3 v) {
    v = mix(vec3(0.0), v, greaterThan(v, vec3(0.0)));
    return mix(v, vec3(MOST), greaterThan(v, vec3(FINITE)));
}

// The filtered image. One bad texel spoils all samples between it and its neighbours, so there the filter is computed
// here, from mended texels.
vec3 sample_at(vec2 uv) {
    vec3 filtered = textureLod(equirect, uv, 0.0).rgb;
    ivec2 size = textureSize(equirect, 0);
    vec2 at = uv * vec2(size) - 0.5;
    ivec2 corner = ivec2(floor(at));
    bool good = is_light(filtered);
    vec3 lights[4];
    for (int i = 0; i < 4; ++i) {
        // Columns wrap around.
        ivec2 from = corner + ivec2(i & 1, i >> 1);
        from = ivec2((from.x + size.x) % size.x, clamp(from.y, 0, size.y - 1));
        vec3 light = texelFetch(equirect, from, 0).rgb;
        good = good && is_light(light);
        lights[i] = light_of(light);
    }
    vec2 f = at - vec2(corner);
    vec3 mended = mix(mix(lights[0], lights[1], f.x), mix(lights[2], lights[3], f.x), f.y);
    return good ? filtered : mended;
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
        sum += sample_at(equirect_uv(d));
    }
    vec3 light = 0.25 * push.scale * sum;
    // A scale of 0 times an infinite sum is NaN.
    light = mix(vec3(0.0), min(light, MOST), greaterThan(light, vec3(0.0)));
    imageStore(environment, texel, vec4(light, 1.0));
}
