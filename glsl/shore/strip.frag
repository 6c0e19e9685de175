#version 460
// Pass `shoreline`: foam on the host's strip, a mesh that gives the shore coordinate v (blog, Sec. IV to VIII).
// Reads: scene depth, noise, foam texture, inputs of sunlight.glsl. Writes: shoreline foam, blocked share of sunlight.

#include "frame.glsl"
#include "shore.glsl"
#include "shoreline.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;

layout(location = 0) in vec3 eye;
layout(location = 1) in float v;

layout(location = 0) out vec4 foam;

#include "shore_light.glsl"

void main() {
    vec2 pixel = gl_FragCoord.xy;
    float z = -eye.z;
    Water w = water_point(eye / z, z);
    vec2 dv = vec2(dFdxFine(v), dFdyFine(v));
    float line = covered(mixed_at(place_at(w.p, w.across, dv), v, vec2(0.0)), pixel);
    float scene = scene_of(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    line *= seen_before(z, scene) && v > 0.0 && v < 2.0 ? 1.0 : 0.0;
    float lost = 0.0;
    for (bool go = line > 0.0; go; go = false) {
        lost = sun_lost(eye, pixel);
    }
    foam = vec4(line, 0.0, lost, 0.0);
}
