// Light on its way through water (thesis, Eq. 3.5 to 3.7). Needs frame.glsl.

// Rungs of the ladder; layers above the selected rung are omitted.
const float BACK_WATER = 1.0;
const float FOAM_TOO = 2.0;
const float FRONT_WATER = 3.0;
const float WHOLE = 4.0;

// Light behind `path` metres of water. The light is premultiplied by `share`, its coverage per channel; the water adds
// its own light before that share, scaled by `lit`. w: mean transmittance (with the thesis' medium, the weight of the
// light behind).
vec4 through_medium(vec3 light, vec3 share, float path, vec3 lit) {
    // One exponential for both media: a CPU driver executes both sides of a branch.
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

// Light that a turbid medium scatters at a surface, relative to that of level ground in the sun. It depends on slope
// and sun visibility, as for a matte surface; emission is the same everywhere. `n` and `up` are unit vectors in eye
// space, `sun` is the visibility of the sun.
vec3 lit_on(vec3 n, vec3 up, float sun) {
    vec3 to = frame.sun_direction.xyz;
    float facing = sun * max(dot(n, to), 0.0) / max(dot(up, to), 0.05);
    vec3 lit = mix(vec3(facing), vec3(1.0), frame.shade.rgb);
    // Without a surface it is as for level ground.
    float scattered = dot(n, n) > 0.5 && frame.medium_a.w < 0.5 ? frame.medium_b.w : 0.0;
    return mix(vec3(1.0), lit, scattered);
}
