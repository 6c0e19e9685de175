// Colour of the scene, with the foam overlay on its water. Needs frame.glsl.
// Reads: scene colour, shoreline and contact foam.

#include "coat_light.glsl"
#include "filtered.glsl"

// 1: there may be shore foam; otherwise it is not read.
layout(constant_id = 24) const uint SHORE = 0;

layout(set = 0, binding = 4) uniform sampler2D scene_color;
layout(set = 0, binding = 31) uniform sampler2D shore_foam;

// Light at a point, relative to the light in full sun, if the fraction `sun` of the sunlight arrives there.
vec3 under(vec3 sun) {
    return mix(frame.shade.rgb, vec3(1.0), sun);
}

// Overlay foam at a pixel. x: coverage by shoreline foam; y: coverage by contact foam on the host's water surface; z:
// fraction of the sunlight that both lose to shadows; w: coverage by contact foam on the particles' water.
vec4 coat_at(vec2 pixel) {
    return filtered(shore_foam, pixel, vec2(0.0), frame.extent.xy);
}

vec3 with_contact(vec3 c, float amount, float lost, CoatLight light) {
    return mix(c, light.contact - lost * light.contact_lost, amount);
}

vec3 coated(vec3 c, vec4 coat, CoatLight light) {
    c = mix(c, light.shore.rgb - coat.z * light.shore_lost, coat.x * light.shore.w);
    return with_contact(c, coat.y, coat.z, light);
}

// Fraction of the scene that both kinds of foam leave visible.
float uncovered(vec4 coat, CoatLight light) {
    return (1.0 - coat.x * light.shore.w) * (1.0 - coat.y);
}

// The scene's colour at a point, filtered.
vec3 uncoated_at(vec2 pixel) {
    return filtered(scene_color, pixel * frame.scene_color.xy, frame.scene_origin.zw, frame.scene_color.zw).rgb;
}

vec3 scene_at(vec2 pixel) {
    vec3 c = uncoated_at(pixel);
    return SHORE == 1u ? coated(c, coat_at(pixel), coat_light()) : c;
}
