// Sunlight that reaches a point: past the host's scene (scene_shadow.glsl), and through water and foam (not in the
// thesis).
// Needs frame.glsl, convolution.glsl, intensity.glsl. Reads: what scene_shadow.glsl reads, the light's maps of
// thickness, whitewater particles and bubble foam.

#include "scene_shadow.glsl"

// 1: water and foam take light away.
layout(constant_id = 12) const uint CAST = 0;
// 1: so do whitewater particles.
layout(constant_id = 21) const uint DIFFUSED = 0;

layout(set = 0, binding = 17) uniform sampler2D light_thickness;
// 1: so does bubble foam.
layout(constant_id = 23) const uint SOAPED = 0;

layout(set = 0, binding = 24) uniform sampler2D light_diffuse;
layout(set = 0, binding = 27) uniform sampler2D light_soap;

// Texels of the light's maps round a point, and their weights.
struct LightTexels {
    ivec2 base;
    vec2 f;
    float depth; // metres along the light
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

// Metres of water and foam of a texel that lie before a depth: as if each hung together about its mean.
vec2 before_depth(vec4 thick, float depth) {
    vec2 t = thick.xy;
    vec2 mean = thick.zw / max(t, vec2(1.0e-9));
    return clamp(depth - mean + 0.5 * t, vec2(0.0), t);
}

// What whitewater particles of a texel cover at a depth: as much as of what they are drawn over, by so many of them as
// lie before it. Of these no more is known than where their middle is and how far they spread: behind the middle
// at least 1 - s^2 / (s^2 + x^2) of them (Cantelli), which is all there may be where they lie in two places, as
// foam on water and spray above it. It is scaled to be all at the end of an even body. A reach behind it begins:
// foam does not shade itself for what a texel does not tell.
float covered_by_diffuse(ivec2 texel, float depth) {
    vec3 there = texelFetch(light_diffuse, texel, 0).xyz;
    float reach = 0.5 * frame.particle.y + 1.5 * frame.light_map.y;
    float behind = max(depth - there.y - reach, 0.0);
    float square = behind * behind;
    float part = min(4.0 / 3.0 * square / (square + there.z * there.z + reach * reach / 9.0), 1.0);
    return intensity_of(part * there.x);
}

// Of the sun's light what whitewater particles before a point leave.
float past_diffuse(LightTexels t) {
    float lost = 0.0;
    for (int i = 0; i < 4; ++i) {
        float weight = ((i & 1) == 0 ? 1.0 - t.f.x : t.f.x) * (i < 2 ? 1.0 - t.f.y : t.f.y);
        lost += weight * covered_by_diffuse(t.base + ivec2(i & 1, i >> 1), t.depth);
    }
    return t.inside ? 1.0 - lost : 1.0;
}

// Of the sun's light what blobs of bubble foam before a point leave. It goes some way into them, and through them a
// little.
float past_soap(LightTexels t) {
    float edge = float(textureSize(light_soap, 0).x);
    float wide = frame.light_map.y * frame.light_map.x / edge; // of a texel, metres
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

// Of the sun's light what water and foam before a point leave.
vec3 through_fluid(vec3 eye) {
    LightTexels t = light_texels(eye);
    vec3 extinction = frame.medium_b.rgb + (frame.medium_a.w > 0.5 ? vec3(0.0) : frame.medium_a.rgb);
    // What is lost, not what is kept: where there is nothing it is nothing.
    vec3 lost = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = t.base + ivec2(i & 1, i >> 1);
        vec2 thick = before_depth(texelFetch(light_thickness, texel, 0), t.depth - 0.5 * frame.particle.y);
        float weight = ((i & 1) == 0 ? 1.0 - t.f.x : t.f.x) * (i < 2 ? 1.0 - t.f.y : t.f.y);
        lost += weight * (1.0 - exp(-extinction * thick.x - frame.shade.w * thick.y));
    }
    vec3 left = t.inside ? 1.0 - lost : vec3(1.0);
    left = DIFFUSED == 1u ? left * past_diffuse(t) : left;
    return SOAPED == 1u ? left * past_soap(t) : left;
}

// Share of the sun's light at a point of foam, of all colours together: what it is in is foam more than
// water. Not a mask's part, which is the pixels'.
float sun_in_foam(vec3 eye) {
    float past = SHADOW == 1u ? 1.0 : past_scene(eye, vec2(0.0));
    return CAST == 1u ? past * dot(through_fluid(eye), vec3(1.0 / 3.0)) : past;
}

// Share of the sun's light at a point of the fluid.
vec3 sunlight(vec3 eye, vec2 pixel) {
    vec3 light = vec3(past_scene(eye, pixel));
    return CAST == 1u ? light * through_fluid(eye) : light;
}
