// Light on its way through water (thesis, Eq. 3.5 to 3.7). Needs frame.glsl.

// Rungs of the ladder: what is above the one that is drawn is left out.
const float BACK_WATER = 1.0;
const float FOAM_TOO = 2.0;
const float FRONT_WATER = 3.0;
const float WHOLE = 4.0;

// Of a light that covers a share of each colour, premultiplied by it: its colour behind so many metres of water, with the
// water's own light before that share; and what of it comes through, of all channels together, to the source its weight
// of what is behind.
vec4 through_medium(vec3 light, vec3 share, float path) {
    // One exponential for both: a CPU runs branches whole.
    bool source = frame.medium_a.w > 0.5;
    vec3 extinction = frame.medium_a.rgb + frame.medium_b.rgb;
    vec4 kept = exp(-(source ? frame.medium_b : vec4(extinction, 0.0)) * path);
    vec3 albedo = frame.medium_b.rgb / max(extinction, vec3(1.0e-9));
    return source ? vec4(mix(share * frame.medium_a.rgb * kept.rgb, light, kept.a), kept.a)
                  : vec4(light * kept.rgb + share * frame.ambient.rgb * albedo * (1.0 - kept.rgb),
                         dot(kept.rgb, vec3(1.0 / 3.0)));
}

vec4 through_medium(vec3 background, float path) {
    return through_medium(background, vec3(1.0), path);
}
