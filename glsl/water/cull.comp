#version 460
// Pass `cull`: drops particles whose position is NaN, infinite or huge, leaves out those that are only spray or only
// foam, and culls the others against the frustum (thesis Sec. 4.3: the host's packets, which are groups of particles
// with a bounding box, or each bounding sphere). It writes the survivors in eye space to a list: those whose sprite is
// small on the screen fill it from the front, those whose sprite is large from the back.
// Reads: Counts (particles), positions (for ellipsoids with their shapes), densities, foam amounts, packets. Writes:
// Counts, visible, shares, members.

#include "frame.glsl"
#include "frustum.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"
#include "density.glsl"

layout(local_size_x = 64) in;
// 1: one workgroup per host packet.
layout(constant_id = 0) const uint PACKETS = 0;
// 1: the foam part of a particle is not counted as water.
layout(constant_id = 1) const uint FOAM = 0;
// 1: the shader records which of the host's particles lie in packets, because later passes visit the host's particles
// again.
layout(constant_id = 2) const uint MEMBERS = 0;

layout(set = 0, binding = 1, std430) readonly buffer Positions { uint positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 3, std430) readonly buffer HostPackets { uint packets[]; };
layout(set = 0, binding = 4, std430) buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 5, std430) writeonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 6, std430) readonly buffer Amounts { float amounts[]; };
// Fraction of water of each visible sphere.
layout(set = 0, binding = 7, std430) writeonly buffer Shares { float shares[]; };
// One bit per particle (members.glsl).
layout(set = 0, binding = 8, std430) buffer Members { uint members[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint density_word;
    uint density_stride;  // 0: no densities
    uint chunk_first;
    uint capacity;        // of the visible list
    float small_limit;    // largest sprite that counts as small, pixels
    uint small_inside;    // 1: small sprites have their centre on the screen (points)
    uint foam_word;
    uint foam_stride;     // 0: no foam
} push;

#include "packets.glsl"

shared uint group_small;
shared uint group_large;
shared uint first_small;
shared uint first_large;

const uint NONE = 0u;
const uint SMALL = 1u;
const uint LARGE = 2u;

// A smaller fraction of water counts as none.
const float LEAST_SHARE = 1.0 / 256.0;

// The shape that pass `shape` stored after a position, rotated to eye space.
vec4 seen_shape(uint at) {
    mat3 axes = unpack_axes(uvec3(positions[at], positions[at + 1u], positions[at + 2u]));
    mat3 turn = mat3(frame.view);
    return vec4(uintBitsToFloat(pack_axes(turn * axes * transpose(turn))), 0.0);
}

// SMALL or LARGE, by the larger of the sizes that the ellipsoid and its thickness sprite have on the screen; NONE if
// the ellipsoid is not in the frustum.
uint classify_ellipsoid(Ellipsoid body) {
    vec3 centre = body.sphere.xyz;
    float times = frame.particle.z / frame.particle.x;
    // The sprite lies in the plane of the centre, sheared along the ray.
    float reach = times * body.sphere.w * ellipsoid_reach(body);
    if (!in_frustum(centre, reach * max(length(centre) / max(-centre.z, frame.depth.z), 1.0))) {
        return NONE;
    }
    vec4 slopes;
    if (!ellipsoid_bounds(body, slopes) || -centre.z <= frame.depth.z) {
        return LARGE;
    }
    Disc disc = ellipsoid_disc(body, times, frame.thick_slope);
    vec4 sprite = vec4(centre.xy - disc.reach, centre.xy + disc.reach) / -centre.z;
    vec4 own = pixel_bounds(slopes, frame.slope);
    vec4 wide = pixel_bounds(sprite, frame.slope);
    vec2 size = max(own.zw - own.xy, wide.zw - wide.xy);
    bool small = max(size.x, size.y) <= push.small_limit;
    if (push.small_inside == 1u) {
        vec4 middles = 0.5 * vec4(own.xy + own.zw, wide.xy + wide.zw);
        small = small && all(greaterThan(middles, vec4(0.0))) && all(lessThan(middles, frame.extent.xyxy));
    }
    return small ? SMALL : LARGE;
}

uint classify(uint index, out vec4 sphere, out vec4 shape, out float share) {
    sphere = vec4(0.0);
    shape = vec4(0.0);
    share = 1.0;
    if (FOAM == 1u && push.foam_stride > 0u) {
        float foam = amounts[push.foam_word + index * push.foam_stride];
        // Comparisons with NaN are false.
        share = foam > 0.0 ? 1.0 - min(foam, 1.0) : 1.0;
    }
    uint at = push.position_word + index * push.position_stride;
    vec3 position = uintBitsToFloat(uvec3(positions[at], positions[at + 1u], positions[at + 2u]));
    // Comparisons with NaN are false.
    if (!(all(lessThan(abs(position), vec3(1.0e18))))) {
        atomicAdd(counts.dropped, 1u);
        return NONE;
    }
    float radius = frame.particle.x;
    if (push.density_stride > 0u) {
        float density = densities[push.density_word + index * push.density_stride];
        // 0 marks a particle that was just emitted and has no density yet.
        if (density > 0.0) {
            if (density < frame.density.x) {
                atomicAdd(counts.spray, 1u);
                return NONE;
            }
            radius *= 0.5 + 0.5 * bulk(density);
        }
    }
    vec3 centre = (frame.view * vec4(position, 1.0)).xyz;
    sphere = vec4(centre, radius * share);
    if (share < LEAST_SHARE) {
        return NONE;
    }
    if (ELLIPSOIDS == 1u) {
        shape = seen_shape(at + 3u);
        return classify_ellipsoid(ellipsoid_of(vec4(centre, radius), shape));
    }
    // The half-axis of the thickness sprite is larger than the sphere's radius, so one test with it bounds both
    // sphere and sprite.
    float reach = radius * frame.particle.z / frame.particle.x;
    if (!in_frustum(centre, reach)) {
        return NONE;
    }
    vec4 slopes;
    if (!sphere_bounds(centre, reach, slopes)) {
        return LARGE;
    }
    vec4 pixels = pixel_bounds(slopes, frame.slope);
    vec2 size = pixels.zw - pixels.xy;
    bool small = max(size.x, size.y) <= push.small_limit;
    if (push.small_inside == 1u) {
        vec2 middle = 0.5 * (pixels.xy + pixels.zw);
        small = small && all(greaterThan(middle, vec2(0.0))) && all(lessThan(middle, frame.extent.xy));
    }
    return small ? SMALL : LARGE;
}

void append(uint kind, vec4 sphere, vec4 shape, float share) {
    uint local = gl_LocalInvocationIndex;
    if (local == 0u) {
        group_small = 0u;
        group_large = 0u;
    }
    barrier();
    uint slot = 0u;
    if (kind == SMALL) {
        slot = atomicAdd(group_small, 1u);
    } else if (kind == LARGE) {
        slot = atomicAdd(group_large, 1u);
    }
    barrier();
    // One pair of global atomics per workgroup.
    if (local == 0u) {
        first_small = group_small > 0u ? atomicAdd(counts.small, group_small) : 0u;
        first_large = group_large > 0u ? atomicAdd(counts.large, group_large) : 0u;
    }
    barrier();
    uint order = slot + (kind == SMALL ? first_small : first_large);
    // Packets that overlap, against the contract, may append more entries than there are particles.
    if (kind != NONE && order < push.capacity) {
        uint at = kind == SMALL ? order : push.capacity - 1u - order;
        visible[ENTRIES * at] = sphere;
        if (ELLIPSOIDS == 1u) {
            visible[ENTRIES * at + 1u] = shape;
        }
        if (FOAM == 1u) {
            shares[at] = share;
        }
    }
    barrier();
}

// Sets the bits in `members` of all particles of the packet, visible or not, because the sun sees other particles
// than the camera.
void enter(Packet packet) {
    uint past = (packet.past + 31u) >> 5;
    for (uint word = (packet.first >> 5) + gl_LocalInvocationIndex; word < past; word += gl_WorkGroupSize.x) {
        uint low = max(packet.first, 32u * word) - 32u * word;
        uint high = min(packet.past - 32u * word, 32u);
        if (low < high) {
            atomicOr(members[word], (~0u >> (32u - (high - low))) << low);
        }
    }
}

void main() {
    uint here = counts.particles;
    vec4 sphere = vec4(0.0);
    vec4 shape = vec4(0.0);
    float share = 1.0;
    if (PACKETS == 0u) {
        uint index = gl_GlobalInvocationID.x;
        uint kind = index < here ? classify(index, sphere, shape, share) : NONE;
        append(kind, sphere, shape, share);
        return;
    }
    Packet packet = packet_at(gl_WorkGroupID.x, push.chunk_first, here);
    if (MEMBERS == 1u) {
        enter(packet);
    }
    vec3 centre = (frame.view * vec4(packet.middle, 1.0)).xyz;
    // Conservative test: the packet's box contains only the particles' centres, so its bounding sphere is enlarged by
    // the half-axis of a sprite.
    if (!in_frustum(centre, packet.reach + frame.particle.z)) {
        return;
    }
    for (uint i = packet.first; i < packet.past; i += gl_WorkGroupSize.x) {
        uint index = i + gl_LocalInvocationIndex;
        uint kind = index < packet.past ? classify(index, sphere, shape, share) : NONE;
        append(kind, sphere, shape, share);
    }
}
