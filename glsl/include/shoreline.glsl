// Shoreline foam: a mix of waves along the shore coordinate v and of a foam texture, the web, that lies in the world
// (blog, Sec. IV to VIII). Detail finer than a pixel is removed and kept as a variance, so that far foam covers as
// much as near foam. Needs shore.glsl. Reads: noise, web.

layout(set = 0, binding = 28) uniform sampler2D shore_noise;
layout(set = 0, binding = 29) uniform sampler2D shore_web;

// 0: clipped, 1: smooth, 2: four samples.
layout(constant_id = 0) const uint EDGE = 1;

// Mip level of a texture for a footprint in texels.
float level_of(float texels) {
    return log2(max(texels, 1.0e-6));
}

vec4 noise_at(vec2 p, float scale, float width) {
    return textureLod(shore_noise, p * scale, level_of(width * scale * shore.web.w));
}

// Samples the web (the texture of shoreline foam) at a mip level: x is its mean, y the mean of its square, zw its
// slope on each axis.
vec4 web_at(vec2 uv, float level) {
    return textureLod(shore_web, uv, level);
}

// Sums of the noises at a point: `sum` is added to frequency, phase, offset and threshold; `moved` displaces the web,
// in scene units.
struct Noises {
    vec4 sum;
    vec2 moved;
};

Noises noises_at(vec2 p, float width) {
    Noises noises = Noises(vec4(0.0), vec2(0.0));
    vec2 bent = p;
    // Displace the point by the first noise first, and the web last.
    for (int i = 0; i < LOOKS; ++i) {
        vec4 n = noise_at(bent + shore.look_moved[i].xy, shore.look[i].x, width);
        noises.sum += shore.noise[i] * n;
        bent += shore.look[i].y * n.xy;
        noises.moved += shore.look[i].y * n.xy + shore.look[i].z * n.zw;
    }
    return noises;
}

// Shoreline foam at a point: the mix of waves and foam texture minus the threshold (foam where it is positive), its
// change per pixel to the right and down, and the variance of the detail that is too fine for the pixel.
struct Mixed {
    float over;
    vec2 change;
    float variance;
};

// Values of shoreline foam that the pixels around a point share. The noises change little from one pixel to the next,
// so their change is neglected.
struct Place {
    vec4 noise;     // sums of the noises
    vec2 moved;     // p, displaced by them
    mat2 across;    // change of p per pixel to the right and down
    vec2 dv;        // derivative of v per pixel
    float kept;     // fraction of the waves that a pixel resolves
    vec4 levels;    // mip level of each layer of the web
};

Place place_at(vec2 p, mat2 across, vec2 dv) {
    float width = sqrt(abs(determinant(across)));
    Noises noises = noises_at(p, width);
    // `kept` is the factor by which the mean over a pixel reduces the wave's amplitude. The pixel's filter is taken
    // as a normal distribution with the variance of a box.
    float frequency = shore.waves.x + noises.sum.x;
    float kept = exp(-frequency * frequency * dot(dv, dv) / 24.0);
    vec4 levels = vec4(0.0);
    for (int i = 0; i < LAYERS; ++i) {
        levels[i] = level_of(width * length(shore.layer[i].xy) * shore.web.z);
    }
    return Place(noises.sum, p + noises.moved, across, dv, kept, levels);
}

// Evaluates shoreline foam, the mix of waves and foam texture, at an offset in pixels from the point of `place`; `v`
// is the shore coordinate there.
Mixed mixed_at(Place place, float v, vec2 off) {
    vec4 noise = place.noise;
    float frequency = shore.waves.x + noise.x;
    float phase = frequency * v + shore.waves.y + noise.y;
    // Bring the phase to within half a turn of 0: beyond that the precision of a sine is not guaranteed.
    phase -= 6.2831853 * round(phase / 6.2831853);
    float waves = place.kept * sin(phase) + shore.waves.z * v + shore.waves.w + noise.z;
    float steep = waves > shore.mixed.x ? place.kept * frequency * cos(phase) + shore.waves.z : 0.0;
    float web = shore.web.x * v + shore.web.y + noise.z;
    float ends = smoothstep(0.0, shore.reach.z, v) * smoothstep(0.0, shore.reach.z, 2.0 - v);
    vec2 ratio = shore.mixed.yz;
    Mixed mixed;
    mixed.over = ratio.x * max(waves, shore.mixed.x) + ratio.y * web - shore.mixed.w - noise.w - 2.0 * (1.0 - ends);
    mixed.change = (ratio.x * steep + ratio.y * shore.web.x) * place.dv;
    mixed.variance = ratio.x * ratio.x * 0.5 * (1.0 - place.kept * place.kept);
    vec2 q = place.moved + place.across * off;
    for (int i = 0; i < LAYERS; ++i) {
        vec4 layer = shore.layer[i];
        mat2 turn = mat2(layer.x, layer.y, -layer.y, layer.x);
        vec4 there = web_at(turn * q + layer.zw, place.levels[i]);
        float weight = ratio.y * shore.layer_weight[i];
        mixed.over += weight * there.x;
        mixed.change += weight * (there.zw * (turn * place.across));
        mixed.variance += weight * weight * max(there.y - there.x * there.x, 0.0);
    }
    return mixed;
}

// Coverage of a pixel by foam: a box filter over the values of the mix. Its variance is that of the mix's change
// across the pixel in the steepest direction, plus that of the detail that is too fine for the pixel.
float covered(Mixed mixed, vec2 pixel) {
    float width = sqrt(dot(mixed.change, mixed.change) + 12.0 * mixed.variance);
    float share = clamp(mixed.over / max(width, 1.0e-6) + 0.5, 0.0, 1.0);
    if (EDGE == 0u) {
        return step(0.0, mixed.over);
    }
    // Coverage in quarters, with an ordered dither over 2x2 pixels.
    vec2 odd = mod(floor(pixel), 2.0);
    float order = (odd.x + odd.y == 1.0 ? 0.5 : 0.0) + (odd.y > 0.5 ? 0.25 : 0.0) + 0.125;
    return EDGE == 2u ? floor(4.0 * share + order) / 4.0 : share;
}
