#version 460
// Pass `web`: computes one mip level of the texture of shoreline foam (the web) or of its noise as half floats, which
// are then copied to an image. A texel of the web has the mean of the web's values, the mean of their squares, and the
// mean slopes; mean and square give the variance, which stands for detail finer than a pixel. Not in the blog.
// Reads: texels of the host, or 32-bit floats, or the previous level. Writes: the level.

layout(local_size_x = 8, local_size_y = 8) in;

// 0: web, 1: noise.
layout(constant_id = 0) const uint NOISE = 0;
// Source: 0: the previous mip level, 1: floats, 2: the host's image.
layout(constant_id = 1) const uint FROM = 0;

layout(set = 0, binding = 0, std430) readonly buffer Floats { float floats[]; };
layout(set = 0, binding = 1, std430) buffer Halves { uint halves[]; };
layout(set = 0, binding = 2) uniform sampler2D image;

layout(push_constant, std430) uniform Push {
    vec4 part;   // the host's image: first texel and size
    uint size;   // of this level
    uint first;  // word of the level
    uint before; // word of the previous level
} push;

vec4 before_at(uvec2 at) {
    uint word = push.before + 2u * (at.y * 2u * push.size + at.x);
    return vec4(unpackHalf2x16(halves[word]), unpackHalf2x16(halves[word + 1u]));
}

// Samples the host's image at a texel of this mip level: bilinear, or, if the image has more texels than the level,
// the mean of bilinear samples spread evenly over the texel, no farther apart than the image's texels. The image
// repeats. Values are clamped to 0 to 1.
float host_at(ivec2 at) {
    vec2 step = push.part.zw / float(push.size);
    ivec2 taps = max(ivec2(ceil(step)), ivec2(1));
    float sum = 0.0;
    for (int y = 0; y < taps.y; ++y) {
        for (int x = 0; x < taps.x; ++x) {
            vec2 place = (vec2(at) + (vec2(x, y) + 0.5) / vec2(taps)) * step - 0.5;
            ivec2 base = ivec2(floor(place));
            vec2 f = place - vec2(base);
            ivec2 size = ivec2(push.part.zw);
            for (int i = 0; i < 4; ++i) {
                ivec2 texel = base + ivec2(i & 1, i >> 1);
                texel += size * ivec2(lessThan(texel, ivec2(0))) - size * ivec2(greaterThanEqual(texel, size));
                float weight = ((i & 1) == 0 ? 1.0 - f.x : f.x) * (i < 2 ? 1.0 - f.y : f.y);
                float value = texelFetch(image, texel + ivec2(push.part.xy), 0).x;
                // NaN counts as no foam.
                sum += weight * (value > 0.0 ? min(value, 1.0) : 0.0);
            }
        }
    }
    return sum / float(taps.x * taps.y);
}

float web_of(ivec2 at) {
    int size = int(push.size);
    at = (at + size) % size;
    return FROM == 1u ? floats[at.y * size + at.x] : host_at(at);
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, uvec2(push.size)))) {
        return;
    }
    uint texel = at.y * push.size + at.x;
    vec4 value;
    if (FROM == 0u) {
        value = 0.25 * (before_at(2u * at) + before_at(2u * at + uvec2(1, 0)) + before_at(2u * at + uvec2(0, 1))
                        + before_at(2u * at + 1u));
    } else if (NOISE == 1u) {
        value = vec4(floats[4u * texel], floats[4u * texel + 1u], floats[4u * texel + 2u], floats[4u * texel + 3u]);
    } else {
        ivec2 own = ivec2(at);
        float web = web_of(own);
        // The slope of the web is the difference between the texels on both sides, converted to a change per width of
        // the image. The image repeats, so texels at its edges have neighbours too.
        vec2 slope = vec2(web_of(own + ivec2(1, 0)) - web_of(own - ivec2(1, 0)),
                          web_of(own + ivec2(0, 1)) - web_of(own - ivec2(0, 1)));
        value = vec4(web, web * web, 0.5 * float(push.size) * slope);
    }
    uint word = push.first + 2u * texel;
    halves[word] = packHalf2x16(value.xy);
    halves[word + 1u] = packHalf2x16(value.zw);
}
