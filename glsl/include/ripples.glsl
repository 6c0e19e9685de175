// How the baseline's surface noise shows in the picture (van der Laan et al. 2009; thesis Sec. 2.5.3): as a height
// along the surface's normal, and as the baseline's foam. Needs frame.glsl, surface_noise.glsl. Reads: noise, depth.

// 1: there may be surface noise; otherwise it is not read.
layout(constant_id = 14) const uint NOISE = 0;

layout(set = 0, binding = 20) uniform sampler2D surface_noise;

// Noise of a texel (x), and the eye depth of the water's surface there (y); outside the picture there is no surface,
// and the depth is huge.
vec2 ripple_texel(ivec2 texel) {
    bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(frame.noise_image.xy)));
    texel = clamp(texel, ivec2(0), ivec2(frame.noise_image.xy) - 1);
    float z = texelFetch(depth, noise_pixel(texel), 0).x;
    return vec2(texelFetch(surface_noise, texel, 0).x, inside ? z : 2.0 * EMPTY);
}

// Slope of the noise per texel along an axis, from the differences to those of the two neighbours that lie on the
// texel's surface.
float ripple_rise(vec2 before, vec2 here, vec2 after, float threshold) {
    bool has_before = abs(here.y - before.y) <= threshold;
    bool has_after = abs(after.y - here.y) <= threshold;
    float sum = (has_before ? here.x - before.x : 0.0) + (has_after ? after.x - here.x : 0.0);
    return has_before && has_after ? 0.5 * sum : sum;
}

// What a texel of the noise image adds to the bilinear sum at a pixel. xyz: its noise, and the noise's slope in x and
// y from its four neighbours, times `weight`; w: `weight`. All are 0 if the texel does not lie on the pixel's surface
// (`surface`: depth and its tolerance).
vec4 ripple_part(vec2 here, vec2 left, vec2 right, vec2 above, vec2 below, float weight, vec2 surface) {
    vec2 rise = vec2(ripple_rise(left, here, right, surface.y), ripple_rise(above, here, below, surface.y));
    return abs(here.y - surface.x) <= surface.y ? weight * vec4(here.x, rise, 1.0) : vec4(0.0);
}

// The noise at a pixel and its slope per pixel in x and y, interpolated bilinearly between those of the four texels
// around the pixel that lie on the pixel's own surface.
vec3 ripple_at(vec2 pixel, float front, float threshold) {
    vec2 h = pixel / frame.noise_image.z - 0.5;
    ivec2 base = ivec2(floor(h));
    vec2 f = h - vec2(base);
    vec2 a = ripple_texel(base);
    vec2 b = ripple_texel(base + ivec2(1, 0));
    vec2 c = ripple_texel(base + ivec2(0, 1));
    vec2 d = ripple_texel(base + ivec2(1, 1));
    vec2 left_a = ripple_texel(base + ivec2(-1, 0));
    vec2 left_c = ripple_texel(base + ivec2(-1, 1));
    vec2 right_b = ripple_texel(base + ivec2(2, 0));
    vec2 right_d = ripple_texel(base + ivec2(2, 1));
    vec2 above_a = ripple_texel(base + ivec2(0, -1));
    vec2 above_b = ripple_texel(base + ivec2(1, -1));
    vec2 below_c = ripple_texel(base + ivec2(0, 2));
    vec2 below_d = ripple_texel(base + ivec2(1, 2));
    vec2 surface = vec2(front, threshold);
    vec4 sum = ripple_part(a, left_a, b, above_a, c, (1.0 - f.x) * (1.0 - f.y), surface)
             + ripple_part(b, a, right_b, above_b, d, f.x * (1.0 - f.y), surface)
             + ripple_part(c, left_c, d, a, below_c, (1.0 - f.x) * f.y, surface)
             + ripple_part(d, c, right_d, b, below_d, f.x * f.y, surface);
    return sum.w > 0.0 ? sum.xyz / (sum.w * vec3(1.0, vec2(frame.noise_image.z))) : vec3(0.0);
}

// Normal of the surface with the height added (bump mapping, Blinn 1978; from screen-space derivatives, Mikkelsen
// 2010): as height per distance along the surface, so the tilt does not depend on distance or resolution. The thesis'
// program adds derivatives of the noise image to the normal, so its tilt depends on both.
vec3 rippled(vec3 n, vec3 px, vec3 py, vec2 rise) {
    vec2 height = frame.noise.x * rise;
    vec3 along_x = cross(py, n);
    float area = dot(px, along_x);
    vec3 turned = abs(area) * n - sign(area) * (height.x * along_x + height.y * cross(n, px));
    // Exactly the same bits without noise.
    return any(notEqual(height, vec2(0.0))) ? normalize(turned) : n;
}

// Light of the baseline's foam: grey, in proportion to the magnitude of the noise (thesis Sec. 2.5.3).
vec3 ripple_foam(float noise) {
    return frame.noise_color.rgb * min(frame.noise.y * abs(noise), 1.0);
}
