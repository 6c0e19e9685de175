// Shoreline foam: waves by v and a web in the world (blog, Sec. IV to VIII). What is too fine for a pixel is left out
// and kept as a variance, so that far foam covers what near foam does. Needs shore.glsl. Reads: noise, web.

layout(set = 0, binding = 28) uniform sampler2D shore_noise;
layout(set = 0, binding = 29) uniform sampler2D shore_web;

// 0: clipped, 1: smooth, 2: by four samples.
layout(constant_id = 0) const uint EDGE = 1;

// How far the mix is over the threshold, its change a pixel to the right and down, and the variance of what a pixel leaves
// out of it.
struct Mixed {
    float over;
    vec2 change;
    float variance;
};

vec4 noise_at(vec2 p, float scale, float width) {
    return textureLod(shore_noise, p * scale, log2(max(width * scale * shore.web.w, 1.0e-6)));
}

// Mean of the web and of its square, and its slope each way.
vec4 web_at(vec2 uv, float scale, float width) {
    return textureLod(shore_web, uv, log2(max(width * scale * shore.web.z, 1.0e-6)));
}

// dv: change of v a pixel to the right, and down. What the noises change from pixel to pixel is little.
Mixed shoreline_at(vec2 p, float v, mat2 across, vec2 dv) {
    float width = sqrt(abs(determinant(across)));
    vec4 noise = vec4(0.0);
    vec2 bent = vec2(0.0);
    // The world's bend first, the web's last.
    for (int i = 0; i < LOOKS; ++i) {
        vec4 n = noise_at(p + shore.look_moved[i].xy, shore.look[i].x, width);
        noise += shore.noise[i] * n;
        p += shore.look[i].y * n.xy;
        bent += shore.look[i].z * n.zw;
    }
    float frequency = shore.waves.x + noise.x;
    // Mean of the wave over a pixel, as if it were over a normal distribution of a box's variance.
    float kept = exp(-frequency * frequency * dot(dv, dv) / 24.0);
    float phase = frequency * v + shore.waves.y + noise.y;
    // Nothing is promised of a sine beyond half a turn.
    phase -= 6.2831853 * round(phase / 6.2831853);
    float waves = kept * sin(phase) + shore.waves.z * v + shore.waves.w + noise.z;
    float steep = waves > shore.mixed.x ? kept * frequency * cos(phase) + shore.waves.z : 0.0;
    waves = max(waves, shore.mixed.x);

    vec2 q = p + bent;
    float web = shore.web.x * v + shore.web.y + noise.z;
    vec2 change = shore.web.x * dv;
    float fine = 0.0;
    for (int i = 0; i < LAYERS; ++i) {
        vec4 layer = shore.layer[i];
        mat2 turn = mat2(layer.x, layer.y, -layer.y, layer.x);
        vec4 there = web_at(turn * q + layer.zw, length(layer.xy), width);
        float weight = shore.layer_weight[i];
        web += weight * there.x;
        change += weight * (there.zw * (turn * across));
        fine += weight * weight * max(there.y - there.x * there.x, 0.0);
    }
    vec2 ratio = shore.mixed.yz;
    float ends = smoothstep(0.0, shore.reach.z, v) * smoothstep(0.0, shore.reach.z, 2.0 - v);
    Mixed mixed;
    mixed.over = ratio.x * waves + ratio.y * web - shore.mixed.w - noise.w - 2.0 * (1.0 - ends);
    mixed.change = ratio.x * steep * dv + ratio.y * change;
    mixed.variance = ratio.x * ratio.x * 0.5 * (1.0 - kept * kept) + ratio.y * ratio.y * fine;
    return mixed;
}

// Share of a pixel that is foam: of a box as wide as the change along its steepest way and what is too fine are together.
float covered(Mixed mixed, vec2 pixel) {
    float width = sqrt(dot(mixed.change, mixed.change) + 12.0 * mixed.variance);
    float share = clamp(mixed.over / max(width, 1.0e-6) + 0.5, 0.0, 1.0);
    if (EDGE == 0u) {
        return step(0.0, mixed.over);
    }
    // Quarters, which of two 2x2 pixels share, as devices do.
    vec2 odd = mod(floor(pixel), 2.0);
    float order = (odd.x + odd.y == 1.0 ? 0.5 : 0.0) + (odd.y > 0.5 ? 0.25 : 0.0) + 0.125;
    return EDGE == 2u ? floor(4.0 * share + order) / 4.0 : share;
}
