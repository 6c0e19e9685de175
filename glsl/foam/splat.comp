#version 460
// Pass `splat`: the frontmost of the diffuse particles and their thickness (Akinci et al. 2013, Sec. 2.1 and 2.2;
// passes 3 and 4), an invocation a particle, all of a group the large ones. Depth, unlike in water, is not
// smoothed: that would take from the occlusion. The second time over what goes with the frontmost: its search
// radius and normal.
// Reads: positions, kinds, radii, ages, ids, words. Writes: words.

#include "frame.glsl"
#include "falloff.glsl"
#include "diffuse.glsl"
#include "diffuse_words.glsl"

layout(local_size_x = 64) in;
// 0: depth and thickness. 1: what goes with the depth.
layout(constant_id = 0) const uint FRONTMOST = 0;

layout(set = 0, binding = 1, std430) readonly buffer Positions { uint positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Kinds { uint kinds[]; };
layout(set = 0, binding = 3, std430) readonly buffer Radii { uint radii[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ages { uint ages[]; };
layout(set = 0, binding = 5, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 6, std430) buffer Words { uint words[]; };
layout(set = 0, binding = 7, std430) readonly buffer Arguments { uvec4 arguments[]; };

// Of a stream that is not there the stride is 0.
layout(push_constant, std430) uniform Push {
    uint position_word;
    uint position_stride;
    uint kind_word;
    uint kind_stride;
    uint radius_word;
    uint radius_stride;
    uint age_word;
    uint age_stride;
    uint id_word;
    uint id_stride;
    uint chunk_first;
    uint chunk;
} push;

// Pixels of a box that an invocation does by itself.
const int SMALL = 256;

shared uint large[gl_WorkGroupSize.x];
shared uint larges;

Diffuse diffuse_at(uint i) {
    uint word = push.position_word + i * push.position_stride;
    vec3 position = uintBitsToFloat(uvec3(positions[word], positions[word + 1u], positions[word + 2u]));
    uint kind = push.kind_stride > 0u ? kinds[push.kind_word + i * push.kind_stride] : 0u;
    float radius = push.radius_stride > 0u ? uintBitsToFloat(radii[push.radius_word + i * push.radius_stride]) : 0.0;
    float age = push.age_stride > 0u ? uintBitsToFloat(ages[push.age_word + i * push.age_stride]) : 0.0;
    uint id = push.id_stride > 0u ? ids[push.id_word + i * push.id_stride] : push.chunk_first + i;
    return diffuse_of(position, kind, radius, age, id);
}

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

void splat(ivec2 pixel, Diffuse p, Footprint f) {
    vec2 place;
    float rr = diffuse_place(f, pixel, place);
    if (!(rr < 1.0)) {
        return;
    }
    float w = sqrt(1.0 - rr);
    float depth = -p.centre.z - w * p.radius;
    uint bits = floatBitsToUint(depth);
    uint at = words_of(pixel);
    uint front = words[at + FRONT];
    if (FRONTMOST == 1u) {
        if (bits == front && front < words[at + SCENE]) {
            float search = p.radius * abs(frame.projection.y) / -p.centre.z;
            vec3 normal = normalize(mat3(frame.world) * vec3(place, w));
            atomicMin(words[at + WITH], pack_with(search, normal));
        }
        return;
    }
    if (!(bits < words[at + SCENE])) {
        return;
    }
    // Most lose: a read is cheaper than an atomic.
    if (bits < front) {
        atomicMin(words[at + FRONT], bits);
    }
    float amount = diffuse_amount(p, f, rr);
    vec3 shares = diffuse_shares(amount, depth, uintBitsToFloat(words[at + FLUID]));
    uvec3 steps = uvec3(min(shares * STEPS + 0.5, vec3(1.0e9)));
    if (any(notEqual(steps, uvec3(0u)))) {
        add(at + SUMS, steps);
    }
}

ivec4 inside(ivec4 box) {
    return ivec4(max(box.xy, ivec2(0)), min(box.zw, ivec2(frame.extent.xy) - 1));
}

void main() {
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
            for (int y = box.y; y <= box.w; ++y) {
                for (int x = box.x; x <= box.z; ++x) {
                    splat(ivec2(x, y), p, f);
                }
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
