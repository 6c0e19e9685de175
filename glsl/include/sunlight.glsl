// Sunlight that reaches a point: past the host's scene (scene_shadow.glsl), and through water and foam (not in the
// thesis). Needs frame.glsl, convolution.glsl, intensity.glsl. Reads: inputs of scene_shadow.glsl, the light's maps
// of thickness, whitewater particles and bubble foam.

#include "scene_shadow.glsl"

// 1: water and foam absorb sunlight.
layout(constant_id = 12) const uint CAST = 0;
// 1: whitewater particles absorb it too.
layout(constant_id = 21) const uint WITH_WHITEWATER = 0;

layout(set = 0, binding = 17) uniform sampler2D light_thickness;
// 1: bubble foam absorbs it too.
layout(constant_id = 23) const uint SOAPED = 0;

layout(set = 0, binding = 24) uniform sampler2D light_whitewater;
layout(set = 0, binding = 27) uniform sampler2D light_soap;

// The texels of the light maps around a point, and their weights.
struct LightTexels {
    ivec2 base;
    vec2 f;
    float depth; // along the light, scene units
    bool inside;
};

LightTexels light_texels(vec3 eye) {
    vec3 at = (frame.to_light * vec4(eye, 1.0)).xyz;
    float size = frame.light_map.x;
    vec2 texel = at.xy * size - 0.5;
    LightTexels t;
    t.base = ivec2(floor(clamp(texel, 0.0, size - 2.0)));
    t.f = clamp(texel - vec2(t.base), 0.0, 1.0);
    t.depth = at.z;
    t.inside = all(greaterThan(texel, vec2(0.0))) && all(lessThan(texel, vec2(size - 1.0)));
    return t;
}

// Thickness of the water (x) and of the foam (y) in a texel of the light's maps that lie before a depth, that is,
// nearer to the sun. Each is taken as contiguous around its mean depth.
vec2 before_depth(vec4 thick, float depth) {
    vec2 t = thick.xy;
    vec2 mean = thick.zw / max(t, vec2(1.0e-9));
    return clamp(depth - mean + 0.5 * t, vec2(0.0), t);
}

// Unit of positions in the map of whitewater, scene units: the power of two at or below the edge of a texel.
float whitewater_unit() {
    return uintBitsToFloat(floatBitsToUint(frame.light_map.y) & 0x7f800000u);
}

// Coverage of a texel by the whitewater particles in front of a depth, that is, nearer to the sun. Only their mean
// depth and standard deviation s are known. At a distance x behind the mean at least 1 - s^2 / (s^2 + x^2) of them
// lie before it (Cantelli's inequality), with equality if they lie at two depths, such as foam on water and spray
// above it. The bound is scaled to reach 1 at the far end of a uniform distribution. From x a minimal distance is
// subtracted, so that foam does not shade itself within what a texel can resolve.
float covered_by_whitewater(ivec2 texel, float depth) {
    vec3 there = texelFetch(light_whitewater, texel, 0).xyz;
    there.yz *= whitewater_unit();
    float reach = 0.5 * frame.particle.y + 1.5 * frame.light_map.y;
    float behind = max(depth - there.y - reach, 0.0);
    float square = behind * behind;
    float part = min(4.0 / 3.0 * square / (square + there.z * there.z + reach * reach / 9.0), 1.0);
    return intensity_of(part * there.x);
}

// Sunlight that whitewater particles before a point let through.
float past_whitewater(LightTexels t) {
    float lost = 0.0;
    for (int i = 0; i < 4; ++i) {
        float weight = ((i & 1) == 0 ? 1.0 - t.f.x : t.f.x) * (i < 2 ? 1.0 - t.f.y : t.f.y);
        lost += weight * covered_by_whitewater(t.base + ivec2(i & 1, i >> 1), t.depth);
    }
    return t.inside ? 1.0 - lost : 1.0;
}

// Fraction of sunlight that blobs of bubble foam in front of a point let through. The light fades with depth into a
// blob, down to the 15 % that always pass.
float past_soap(LightTexels t) {
    float edge = float(textureSize(light_soap, 0).x);
    float wide = frame.light_map.y * frame.light_map.x / edge; // width of a texel, scene units
    vec2 at = (vec2(t.base) + t.f + 0.5) / frame.light_map.x * edge - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    float depth = t.depth + frame.light_map.x * frame.light_map.y;
    float lost = 0.0;
    for (int i = 0; i < 16; ++i) {
        ivec2 side = ivec2(i & 3, i >> 2) - 1;
        ivec2 texel = clamp(base + side, ivec2(0), ivec2(edge) - 1);
        vec2 part = mix(vec2(1.0), 1.0 - f, equal(side, ivec2(-1)));
        part = mix(part, f, equal(side, ivec2(2)));
        float behind = depth - texelFetch(light_soap, texel, 0).x;
        lost += part.x * part.y * smoothstep(1.5 * wide, 9.0 * wide, behind);
    }
    return t.inside ? 1.0 - 0.85 / 9.0 * lost : 1.0;
}

// Sunlight that water and foam before a point let through.
vec3 through_fluid(vec3 eye) {
    LightTexels t = light_texels(eye);
    vec3 extinction = frame.medium_b.rgb + (frame.medium_a.w > 0.5 ? vec3(0.0) : frame.medium_a.rgb);
    // Sums the fraction of sunlight that is absorbed instead of the fraction that passes, so that the sum is exactly
    // 0 where there is neither water nor foam.
    vec3 lost = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = t.base + ivec2(i & 1, i >> 1);
        vec2 thick = before_depth(texelFetch(light_thickness, texel, 0), t.depth - 0.5 * frame.particle.y);
        float weight = ((i & 1) == 0 ? 1.0 - t.f.x : t.f.x) * (i < 2 ? 1.0 - t.f.y : t.f.y);
        lost += weight * (1.0 - exp(-extinction * thick.x - frame.shade.w * thick.y));
    }
    vec3 left = t.inside ? 1.0 - lost : vec3(1.0);
    left = WITH_WHITEWATER == 1u ? left * past_whitewater(t) : left;
    return SOAPED == 1u ? left * past_soap(t) : left;
}

// Sunlight at a point of foam, as one value for all colours, because there is more (grey) foam than water around the
// point. The host's shadow mask is not included, because it is per pixel.
float sun_in_foam(vec3 eye) {
    float past = SHADOW == 1u ? 1.0 : past_scene(eye, vec2(0.0));
    return CAST == 1u ? past * dot(through_fluid(eye), vec3(1.0 / 3.0)) : past;
}

// Visibility of the sun at a point of the fluid, per colour channel.
vec3 sunlight(vec3 eye, vec2 pixel) {
    vec3 light = vec3(past_scene(eye, pixel));
    return CAST == 1u ? light * through_fluid(eye) : light;
}
