#version 460
// Pass `foam`: metres of foam, of all and of the layer right behind the frontmost (thesis Sec. 4.8.2,
// Listing A.16).
// A noise of its own in each sprite, that changes as it ages, breaks up the discs.
// Reads: scene depth, foam depth. Writes: foam thickness (RG32F, or RGBA32F: what of that layer the sun
// lights).

#include "frame.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "foam.glsl"
#include "kernel.glsl"
#include "sprite_hit.glsl"

layout(location = 4) flat in vec4 look;
layout(location = 5) flat in vec2 torn;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D foam_depth;

layout(location = 0) out vec4 thickness;

void main() {
    vec2 place;
    float depth;
    if (!sprite_hit(ray_slope(gl_FragCoord.xy, frame.thick_slope), place, depth)) {
        discard;
    }
    vec2 pixel = gl_FragCoord.xy * frame.thick_extent.z;
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    if (scene > 0.0 && depth >= scene) {
        discard;
    }
    float noise = gradient_noise(vec3(NOISE_CELLS * place, 0.0) + look.yzw);
    float amount = look.x * thickness_kernel(dot(place, place));
    amount *= max(1.0 + torn.x * noise, 0.0);
    // It sinks into the scene softly: a sprite that the scene cuts would end in steps of the texels.
    amount *= scene > 0.0 ? min((scene - depth) / (0.5 * frame.particle.y), 1.0) : 1.0;
    ivec2 last = ivec2(frame.extent.xy) - 1;
    float front = texelFetch(foam_depth, min(ivec2(pixel), last), 0).x;
    // The layer ends softly, within a spacing: what passes its end would pop.
    float past = clamp((depth - front - frame.foam.w) / frame.particle.y, 0.0, 1.0);
    float first = front < EMPTY ? 1.0 - past * past * (3.0 - 2.0 * past) : 0.0;
    thickness = amount * vec4(1.0, first, first * torn.y, 0.0);
    // Whole steps: their sums are exact, in any order.
    thickness = floor(thickness / frame.foam_back.w + 0.5) * frame.foam_back.w;
}
