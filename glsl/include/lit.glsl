// Pass `lit`: the scene with the shadows and caustics of water and foam. Not in the thesis.
// Needs frame.glsl, sunlight.glsl. Reads: scene colour and depth, caustics, the light's maps.

#include "filtered.glsl"

layout(set = 0, binding = 1) uniform sampler2D scene_color;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D caustics;

// Max of the sunlight that caustics focus on a point, relative to the sunlight without water. The sun is not a point,
// and no real surface is as smooth as the rendered one, so real focused light is spread.
const float MOST_GATHERED = 3.0;

// Sunlight that arrives at a point after refraction, relative to the sunlight without water.
float caustics_at(LightTexels t) {
    float sum = 0.0;
    float below = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = t.base + ivec2(i & 1, i >> 1);
        float weight = ((i & 1) == 0 ? 1.0 - t.f.x : t.f.x) * (i < 2 ? 1.0 - t.f.y : t.f.y);
        vec4 thick = texelFetch(light_thickness, texel, 0);
        // The sun is a disc, so caustics blur with `far`, the distance along the light from the water above this
        // texel of the light map to the lit point behind it. Far behind the water, focused light is uniform.
        float far = max(t.depth - thick.z / max(thick.x, 1.0e-9) - 0.5 * thick.x, 0.0);
        float sharp = 1.0 / (1.0 + far / (8.0 * frame.particle.y));
        below += weight * sharp * before_depth(thick, t.depth).x / max(thick.x, 1.0e-9);
        sum += weight * texelFetch(caustics, texel, 0).x;
    }
    return t.inside ? mix(1.0, min(sum, MOST_GATHERED), below) : 1.0;
}

// Colour of the lit scene at the position `pixel` in pixels (the centre of a pixel is at +0.5), filtered if the
// scene's image has another size than the picture.
vec4 lit_at(vec2 pixel) {
    vec4 color = filtered(scene_color, pixel * frame.lit_color.xy, frame.lit_origin.xy, frame.lit_color.zw);
    float z = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    if (!(z > 0.0 && z < frame.depth.w)) {
        return color;
    }
    vec3 eye = z * vec3(ray_slope(pixel, frame.slope), -1.0);
    vec3 change = through_fluid(eye) * caustics_at(light_texels(eye)) - 1.0;
    // Only sunlight can be lost, and only where it arrives.
    vec3 sun = (1.0 - frame.shade.rgb) * past_scene(eye, pixel);
    return vec4(color.rgb * (1.0 + sun * change), color.a);
}
