// Accumulation of whitewater particles in the words of each pixel. Needs frame.glsl, whitewater_streams.glsl,
// whitewater_words.glsl, frustum.glsl, and the macro WORD(at), which names a word. Reads: words. Writes: words.

struct Sprite {
    Whitewater p;
    Footprint f;
    uint search;
};

Sprite sprite_at(uint i) {
    Whitewater p = whitewater_at(i);
    return Sprite(p, footprint_of(p), search_of(p.radius, -p.centre.z));
}

ivec4 inside(ivec4 box) {
    return ivec4(max(box.xy, ivec2(0)), min(box.zw, ivec2(frame.extent.xy) - 1));
}

// Whether a particle with its centre in this sphere may be visible. Particles beyond the far plane need not count:
// the scene hides them.
bool shows(vec3 middle, float reach) {
    vec3 centre = (frame.view * vec4(middle, 1.0)).xyz;
    // The largest radius of a particle, plus the largest to which sub-pixel particles are enlarged, scene units.
    float wider = frame.whitewater.x + LEAST_REACH * max(frame.texel.x, frame.texel.y) * (length(centre) + reach);
    return in_frustum(centre, reach + wider);
}

// Adds the steps to three consecutive words. One loop does all, with a single atomic operation in the code: at each
// atomic operation a CPU driver runs the invocations one by one, whether or not they add anything. An addition to a
// word that was half full already is subtracted again.
void add(uint word, uvec3 steps) {
    do {
        // An addend of 0 must not count as an overflow: the loop would subtract it again forever.
        bool over = atomicAdd(WORD(word), steps.x) >= HALF_FULL && steps.x - 1u < HALF_FULL - 1u;
        steps = over ? uvec3(0u - steps.x, steps.yz) : uvec3(steps.yz, 0u);
        word += over ? 0u : 1u;
        bool next = !over && steps.x == 0u;
        steps = next ? uvec3(steps.yz, 0u) : steps;
        word += next ? 1u : 0u;
    } while (any(notEqual(steps, uvec3(0u))));
}

// Adds the thickness of particle `p` to a pixel. `rr` is the pixel's squared distance from the centre, in radii.
void thicken(uint at, Whitewater p, Footprint f, float rr, float depth, float fluid) {
    float amount = whitewater_amount(p, f, rr);
    vec3 shares = whitewater_shares(amount, depth, fluid);
    uvec3 steps = uvec3(ivec3(min(shares * STEPS + 0.5, vec3(1.0e9))));
    if (any(notEqual(steps, uvec3(0u)))) {
        add(at + SUMS, steps);
    }
}
