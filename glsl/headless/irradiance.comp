#version 460
// Pass `scene`: computes the irradiance of the environment without the sun, as nine spherical harmonics (Ramamoorthi
// and Hanrahan 2001), from the mip level with 8×8 texels per face.
// Reads: environment. Writes: nine coefficients, the cosine lobe already in them.

#include "cube.glsl"
#include "../headless/scene.glsl"

const int SIZE = 8;
const uint LANES = 64;

layout(local_size_x = 64) in;
layout(set = 0, binding = 2) uniform samplerCube environment;
layout(set = 0, binding = 3, std430) writeonly buffer Irradiance { vec4 irradiance[9]; };

shared vec4 part[9][LANES];

void main() {
    uint lane = gl_LocalInvocationIndex;
    vec4 sum[9];
    for (int k = 0; k < 9; ++k) {
        sum[k] = vec4(0.0);
    }
    float lod = log2(float(textureSize(environment, 0).x) / float(SIZE));
    for (int i = int(lane); i < 6 * SIZE * SIZE; i += int(LANES)) {
        ivec3 texel = ivec3(i % SIZE, (i / SIZE) % SIZE, i / (SIZE * SIZE));
        vec2 uv = (vec2(texel.xy) + 0.5) / float(SIZE) * 2.0 - 1.0;
        vec3 d = cube_direction(texel, SIZE);
        float weight = pow(1.0 + dot(uv, uv), -1.5);
        vec3 c = textureLod(environment, d, max(lod, 0.0)).rgb;
        // If the scene's ground or backdrop hide the lower half of the environment, that half is faded out: the
        // light of ground and backdrop is baked per vertex.
        c *= scene.sun_direction.w > 0.5 ? smoothstep(-0.1, 0.1, d.y) : 1.0;
        float y[9] = float[9](
            0.282095,
            0.488603 * d.y, 0.488603 * d.z, 0.488603 * d.x,
            1.092548 * d.x * d.y, 1.092548 * d.y * d.z, 0.315392 * (3.0 * d.z * d.z - 1.0),
            1.092548 * d.x * d.z, 0.546274 * (d.x * d.x - d.y * d.y));
        for (int k = 0; k < 9; ++k) {
            sum[k] += weight * vec4(c * y[k], 1.0);
        }
    }
    for (int k = 0; k < 9; ++k) {
        part[k][lane] = sum[k];
    }
    barrier();
    if (lane < 9u) {
        vec4 all = vec4(0.0);
        for (uint i = 0u; i < LANES; ++i) {
            all += part[lane][i];
        }
        float lobe = lane == 0u ? PI : lane < 4u ? 2.0 * PI / 3.0 : PI / 4.0;
        irradiance[lane] = vec4(all.rgb * (4.0 * PI / all.w) * lobe, 0.0);
    }
}
