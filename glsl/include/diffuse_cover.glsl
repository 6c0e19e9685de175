// An invocation a particle, all of a group the large ones. Needs diffuse_streams.glsl, diffuse_words.glsl, and what
// includes it says what a particle does to a pixel: splat(). Reads: arguments. Writes: words.

// Pixels of a box that an invocation does by itself.
const int SMALL = 256;

shared uint large[gl_WorkGroupSize.x];
shared uint larges;

// All in one loop: at each atomic that it finds a CPU goes through the invocations one by one, whether or not
// they have something to add. What comes to a word that is half full is taken out again.
void add(uint word, uvec3 steps) {
    do {
        bool over = atomicAdd(words[word], steps.x) >= HALF_FULL && steps.x < HALF_FULL;
        steps = over ? uvec3(0u - steps.x, steps.yz) : uvec3(steps.yz, 0u);
        word += over ? 0u : 1u;
        bool next = !over && steps.x == 0u;
        steps = next ? uvec3(steps.yz, 0u) : steps;
        word += next ? 1u : 0u;
    } while (any(notEqual(steps, uvec3(0u))));
}

// What it adds to a pixel's thickness, at such a place in it.
void thicken(uint at, Diffuse p, Footprint f, float rr, float depth) {
    float amount = diffuse_amount(p, f, rr);
    vec3 shares = diffuse_shares(amount, depth, uintBitsToFloat(words[at + FLUID]));
    uvec3 steps = uvec3(min(shares * STEPS + 0.5, vec3(1.0e9)));
    if (any(notEqual(steps, uvec3(0u)))) {
        add(at + SUMS, steps);
    }
}

void splat(ivec2 pixel, Diffuse p, Footprint f);

ivec4 inside(ivec4 box) {
    return ivec4(max(box.xy, ivec2(0)), min(box.zw, ivec2(frame.extent.xy) - 1));
}

void cover() {
    if (gl_LocalInvocationIndex == 0u) {
        larges = 0u;
    }
    barrier();
    uint i = gl_GlobalInvocationID.x;
    if (i < arguments[push.chunk].w) {
        Diffuse p = diffuse_at(i);
        Footprint f = footprint_of(p);
        ivec4 box = p.life > 0.0 ? inside(f.box) : ivec4(0, 0, -1, -1);
        ivec2 size = max(box.zw - box.xy + 1, ivec2(0));
        if (size.x * size.y > SMALL) {
            large[atomicAdd(larges, 1u)] = i;
        } else {
            // One loop: lanes with boxes of other shapes end with the largest, not with the widest and the highest.
            ivec2 at = box.xy;
            for (int left = size.x * size.y; left > 0; --left) {
                splat(at, p, f);
                bool last = at.x == box.z;
                at = ivec2(last ? box.x : at.x + 1, last ? at.y + 1 : at.y);
            }
        }
    }
    barrier();
    ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
    for (uint k = 0u; k < larges; ++k) {
        Diffuse p = diffuse_at(large[k]);
        Footprint f = footprint_of(p);
        ivec4 box = inside(f.box);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                splat(ivec2(x, y), p, f);
            }
        }
    }
}
