#version 460
// Pass `composite`: the only one that writes the output (thesis Sec. 3.3 and 4.10, Listing A.20).
// Layers so far: water over the scene. Refraction in screen space, Beer's law along the ray,
// Fresnel reflection of the environment, the sun's highlight.
// Reads: smoothed, depth, thickness, scene colour and depth, environment. Writes: output.

#include "frame.glsl"
#include "surface.glsl"

layout(constant_id = 0) const uint THICKNESS_REDUCED = 1; // thickness at the smoothing's resolution
layout(constant_id = 1) const uint SCHLICK = 1;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D thickness;
layout(set = 0, binding = 4) uniform sampler2D scene_color;
layout(set = 0, binding = 5) uniform sampler2D scene_depth;
layout(set = 0, binding = 6) uniform samplerCube environment;

layout(location = 0) out vec4 color;

float thickness_at(Surface s, ivec2 pixel) {
    if (THICKNESS_REDUCED == 0u) {
        ivec2 p = ivec2((vec2(pixel) + 0.5) / frame.thick_extent.z);
        return texelFetch(thickness, p, 0).x;
    }
    ivec2 last = ivec2(frame.thick_extent.xy) - 1;
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (s.weights[i] > 0.0) {
            ivec2 t = clamp(s.base + ivec2(i & 1, i >> 1), ivec2(0), last);
            sum += s.weights[i] * texelFetch(thickness, t, 0).x;
        }
    }
    return sum;
}

// Scene colour behind the water at an offset in pixels; never scene that stands in front of it.
vec3 refracted(vec2 pixel, vec2 offset, float z) {
    vec2 q = clamp(pixel + offset, vec2(0.5), frame.extent.xy - 0.5);
    ivec2 base = ivec2(floor(q - 0.5));
    for (int i = 0; i < 4; ++i) {
        vec2 at = clamp(vec2(base + ivec2(i & 1, i >> 1)) + 0.5, vec2(0.5), frame.extent.xy - 0.5);
        float scene = eye_depth(texelFetch(scene_depth, scene_texel(at), 0).x);
        if (scene > 0.0 && scene < z) {
            q = pixel;
        }
    }
    return textureLod(scene_color, q / frame.extent.xy, 0.0).rgb;
}

vec3 through_medium(vec3 background, float path) {
    if (frame.medium_a.w > 0.5) {
        vec3 tint = frame.medium_a.rgb * exp(-frame.medium_b.rgb * path);
        return mix(tint, background, exp(-frame.medium_b.a * path));
    }
    vec3 extinction = frame.medium_a.rgb + frame.medium_b.rgb;
    vec3 kept = exp(-extinction * path);
    vec3 albedo = frame.medium_b.rgb / max(extinction, vec3(1.0e-9));
    return background * kept + frame.ambient.rgb * albedo * (1.0 - kept);
}

float fresnel(float cosine) {
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    if (SCHLICK == 1u) {
        float x2 = x * x;
        return frame.fresnel.x + frame.fresnel.y * x2 * x2 * x;
    }
    return clamp(frame.fresnel.x + frame.fresnel.y * pow(x, frame.fresnel.z), 0.0, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float front = texelFetch(depth, pixel, 0).x;
    if (front >= EMPTY) {
        discard;
    }
    float threshold = frame.surface.w;
    Surface surface = surface_at(gl_FragCoord.xy, front, threshold);
    vec2 slope = ray_slope(gl_FragCoord.xy, frame.slope);
    vec3 position;
    vec3 n;
    surface_frame(surface, slope, frame.reduced_slope.xy, position, n);
    float t = thickness_at(surface, pixel);

    float away = length(position);
    vec3 v = -position / away;
    float path = t * away / surface.z;
    // Light bends towards the water's normal: the look-up moves against it (the source has it the
    // other way, which shows things smaller under a bump).
    vec2 offset = -n.xy * sign(frame.projection.xy) * t * frame.surface.x / (frame.texel.xy * surface.z);
    vec3 c = through_medium(refracted(gl_FragCoord.xy, offset, surface.z), path);

    // Thin films at the rim of a drop neither reflect nor shine: no outlines.
    float w = smoothstep(0.0, 0.25 * frame.particle.x, t);
    vec3 reflected = mat3(frame.world) * reflect(-v, n);
    c = mix(c, textureLod(environment, reflected, 0.0).rgb, w * fresnel(dot(n, v)));
    vec3 h = normalize(v + frame.sun_direction.xyz);
    float shine = pow(max(dot(n, h), 0.0), frame.surface.z);
    c += w * frame.surface.y * shine * frame.sun_color.rgb;
    color = vec4(c, 1.0);
}
