#version 460
// Pass `scene`: draws the sky where there is no mesh: the displayed environment along the pixel's ray, and before it
// thin clouds and a band of haze, if the scene has them. The sun's disc and glow are added unless the environment
// contains them; the built-in sky does not, because the disc would be a few texels of huge radiance. If the scene has a
// sea, and the eye is above it, it is drawn below the horizon: lava, or deep water without a bottom.
// Reads: environment, displayed environment, irradiance. Writes: scene colour.

#include "../headless/scene.glsl"
#include "../headless/noise.glsl"
#include "../headless/light.glsl"
#include "../headless/sea.glsl"

layout(set = 0, binding = 5) uniform samplerCube backdrop; // the full environment

layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 color;

void main() {
    vec3 d = normalize(ray);
    vec3 c = textureLod(backdrop, d, 0.0).rgb;
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    int wet = over_sea() && d.y < 0.0 ? 1 : 0;
    for (int i = 0; i < wet; ++i) {
        // The sea has no floor here.
        c = sea_over(c, 1.0e6, sky_irradiance(vec3(0.0, 1.0, 0.0)), surf());
    }
    // Thin high clouds in streaks, and the band of haze below them.
    vec2 q = 1.3 * d.xz / (max(d.y, 0.0) + 0.035);
    float width = 0.7 * max(length(dFdx(q)), length(dFdy(q)));
    int veiled = scene.air.z > 0.0 && d.y > 0.0 ? 1 : 0;
    for (int i = 0; i < veiled; ++i) {
        c = over_the_sea(c, d.y);
        vec2 warp = vec2(octaves(vec3(q, 2.0), 0.35, 3, width), octaves(vec3(q, 9.0), 0.35, 3, width));
        // The wind stretches the clouds along its direction.
        vec2 along = vec2(0.28 * (q.x + 0.6 * q.y), q.y - 0.6 * q.x) + 1.5 * warp;
        float patchy = 0.5 + octaves(vec3(0.22 * q, 5.0), 0.6, 3, width);
        float fibres = 0.5 + octaves(vec3(along, 0.0), 0.55, 5, width);
        float thick = smoothstep(0.42, 1.0, 0.55 * fibres + 0.55 * patchy);
        c = with_band(with_clouds(c, d.y, thick), d.y);
    }
    // The angle to the sun, from the chord between the unit vectors: acos of a cosine near 1 is imprecise in 32 bits.
    float angle = 2.0 * asin(min(0.5 * length(d - scene.sun_direction.xyz), 1.0));
    const float radius = 0.00465; // 0.533 degrees across
    float edge = max(fwidth(angle), 1.0e-5);
    float disc = 1.0 - smoothstep(radius - edge, radius + edge, angle);
    // Glow around the sun's disc, as of a lens and of haze: the sum of a narrow and a wide exponential of the angle.
    float glow = 0.6 * exp(-angle / 0.012) + 0.03 * exp(-angle / 0.06);
    float above = scene.sun_color.w > 0.0 ? smoothstep(-0.01, 0.01, d.y) : 0.0;
    c += above * scene.sun_color.rgb * (disc * scene.sun_color.w + glow);
    color = vec4(min(c, 60000.0), 1.0);
}
