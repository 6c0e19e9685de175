#version 460
// Pass `whitewater_light`, last part: converts the sums of each texel to the thickness of the whitewater, and to the
// mean and standard deviation of its position along the light, in units of whitewater_unit() (sunlight.glsl). All are
// slightly blurred, because the sun is not a point. (Source: see whitewater.comp.)
// Reads: words. Writes: whitewater (RGBA16F).

#include "frame.glsl"
#include "light_whitewater.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1, std430) readonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D whitewater;

layout(push_constant, std430) uniform Push {
    int first; // row of the map
    int last;
    int bound; // row of the first word
} push;

// Sum of 64-bit integers.
uvec2 plus(uvec2 a, uvec2 b) {
    uint carry;
    uint low = uaddCarry(a.x, b.x, carry);
    return uvec2(low, a.y + b.y + carry);
}

uvec2 minus(uvec2 a, uvec2 b) {
    uint borrow;
    uint low = usubBorrow(a.x, b.x, borrow);
    return uvec2(low, a.y - b.y - borrow);
}

uvec2 times(uvec2 a, uint b) {
    uint high, low;
    umulExtended(a.x, b, high, low);
    return uvec2(low, a.y * b + high);
}

struct Moments {
    float sum;    // in steps
    int about;    // an integer number of texels along the light
    float mean;   // mean offset from `about`
    float square; // mean square of the offset from `about`
};

// Moments of a texel's whitewater from its sums w: mean and mean square of the position along the light, measured
// from an integer near the mean. Everything is exact except the quotients and the conversions to floats in them.
Moments moments_of(uvec4 w) {
    Moments m;
    m.sum = float(w.x);
    uvec2 first = uvec2(w.y, w.w / CARRY);
    uvec2 second = uvec2(w.z, w.w % CARRY);
    uint about = uint((float(first.y) * 4294967296.0 + float(first.x)) / m.sum + 0.5);
    uvec2 off = minus(first, times(uvec2(w.x, 0u), about));
    uvec2 square = minus(second, times(first, 2u * about));
    square = plus(square, times(uvec2(w.x, 0u), about * about));
    m.about = int(about);
    // The summed offsets `off` have a magnitude below the summed weights `w.x`, so the low word suffices.
    m.mean = float(int(off.x)) / m.sum;
    m.square = (float(square.y) * 4294967296.0 + float(square.x)) / m.sum;
    return m;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.first);
    int size = int(frame.light_map.x);
    if (texel.x >= size || texel.y > push.last) {
        return;
    }
    float sum = 0.0;
    float first = 0.0;
    float second = 0.0;
    int from = 0;
    for (int i = 0; i < 9; ++i) {
        ivec2 t = clamp(texel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(size - 1));
        uvec4 w = words[(t.y - push.bound) * size + t.x];
        if (w.x > 0u) {
            Moments m = moments_of(w);
            from = sum > 0.0 ? from : m.about;
            float away = float(m.about - from);
            float weight = m.sum * float((i % 3 == 1 ? 2 : 1) * (i / 3 == 1 ? 2 : 1));
            sum += weight;
            first += weight * (away + m.mean);
            second += weight * (m.square + away * (away + 2.0 * m.mean));
        }
    }
    vec3 result = vec3(0.0);
    if (sum > 0.0) {
        float mean = first / sum;
        float spread = sqrt(max(second / sum - mean * mean, 0.0));
        float middle = float(from - size / 2) + mean;
        // The edge of a texel in units of the power of two at or below it: 1 to 2. In these units positions fit in half
        // precision at every scale.
        float edge = uintBitsToFloat((floatBitsToUint(frame.light_map.y) & 0x007fffffu) | 0x3f800000u);
        result = vec3(sum / (16.0 * STEPS), vec2(middle, spread) * edge);
    }
    imageStore(whitewater, texel, vec4(result, 0.0));
}
