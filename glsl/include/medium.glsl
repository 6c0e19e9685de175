// Light on its way through water (thesis, Eq. 3.5 to 3.7). Needs frame.glsl.

// Debug views. Each contains all layers from the farthest up to the one that it is named after; WHOLE contains all.
const float BACK_WATER = 1.0;
const float FOAM_TOO = 2.0;
const float FRONT_WATER = 3.0;
const float WHOLE = 4.0;

// Light after a path of length `path` through water. `light` is the light from behind the water, premultiplied by
// `share`, the fraction of the pixel that it covers, per channel. In front of this fraction the water adds its own
// light, scaled by `lit`. w of the result: the water's mean transmittance (with the thesis' medium, the weight of the
// light from behind).
vec4 through_medium(vec3 light, vec3 share, float path, vec3 lit) {
    // One exponential serves both media (the thesis' and the others), because a CPU driver executes both sides of a
    // branch.
    bool source = frame.medium_a.w > 0.5;
    vec3 extinction = frame.medium_a.rgb + frame.medium_b.rgb;
    vec4 kept = exp(-(source ? frame.medium_b : vec4(extinction, 0.0)) * path);
    vec3 albedo = frame.medium_b.rgb / max(extinction, vec3(1.0e-9));
    return source ? vec4(mix(share * frame.medium_a.rgb * kept.rgb, light, kept.a), kept.a)
                  : vec4(light * kept.rgb + share * lit * frame.ambient.rgb * albedo * (1.0 - kept.rgb),
                         dot(kept.rgb, vec3(1.0 / 3.0)));
}

vec4 through_medium(vec3 light, vec3 share, float path) {
    return through_medium(light, share, path, vec3(1.0));
}

vec4 through_medium(vec3 background, float path, vec3 lit) {
    return through_medium(background, vec3(1.0), path, lit);
}

// Factor on the light of turbid water under a surface with normal `n`: 1 for a level surface in full sun. The
// scattered part of this light depends on the surface's slope and on `sun`, the visibility of the sun, as for a matte
// surface; the emitted part is the same everywhere. `n` and `up` are unit vectors in eye space.
vec3 lit_on(vec3 n, vec3 up, float sun) {
    vec3 to = frame.sun_direction.xyz;
    float facing = sun * max(dot(n, to), 0.0) / max(dot(up, to), 0.05);
    vec3 lit = mix(vec3(facing), vec3(1.0), frame.shade.rgb);
    // Without a surface it is as for level ground.
    float scattered = dot(n, n) > 0.5 && frame.medium_a.w < 0.5 ? frame.medium_b.w : 0.0;
    return mix(vec3(1.0), lit, scattered);
}
