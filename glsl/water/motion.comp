#version 460
// Pass `motion`, second part, not in the sources: sums in each texel the motions of the particles near a visible
// surface, weighted by the thickness that each particle adds there. One invocation handles a sprite that covers few
// texels, a whole workgroup a larger one.
// Reads: Counts (particles), positions, velocities, densities, foam, members, fronts. Writes: sums.

#include "frame.glsl"
#include "frustum.glsl"
#include "sphere.glsl"
#include "counts.glsl"
#include "density.glsl"
#include "kernel.glsl"
#include "random.glsl"
#include "surface_foam.glsl"

layout(local_size_x = 64) in;
// 1: the foam part of a particle is not counted as water.
layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 3, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 4, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 5, std430) readonly buffer Velocities { float velocities[]; };
layout(set = 0, binding = 6, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 7, std430) readonly buffer Amounts { float amounts[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint velocity_word;
    uint velocity_stride;
    uint density_word;
    uint density_stride;  // 0: no densities
    uint foam_word;
    uint foam_stride;     // 0: no foam
    uint level;
    uint packets;         // 1: particles in no packet do not count
} push;

#define MEMBERS 8
#include "members.glsl"
#include "motion.glsl"

// The sprite of a particle's water or of its foam.
struct Sprite {
    vec3 centre; // eye space
    float share; // fraction of the particle
    vec3 along;  // divided by its half-axis
    vec3 across;
    vec3 normal; // of its plane
    vec3 moved;  // since the previous frame, eye space, in units
    ivec4 box;   // texels that it may cover; empty: none
};

// Least half-axis of a sprite in texels. If the ray of one of a texel's pixels meets a particle's sphere of radius r,
// then the texel's centre is at most r + 0.71 texels from the sphere's centre. With this minimum, the sprite of a
// small particle reaches that far.
const float LEAST_AXIS = 1.5;
// Largest number of texels that one invocation handles alone.
const int SMALL = 64;

shared uint large_count;
shared uvec2 large[128]; // particle; 1 for its foam

const Sprite NONE = Sprite(vec3(0.0), 0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), ivec4(0, 0, -1, -1));

// The sprite of a particle's water, or of its foam.
Sprite sprite_of(uint index, bool foamy) {
    uint at = push.position_word + index * push.position_stride;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    at = push.velocity_word + index * push.velocity_stride;
    vec3 velocity = vec3(velocities[at], velocities[at + 1u], velocities[at + 2u]);
    // Comparisons with NaN are false.
    if (!(all(lessThan(abs(position), vec3(1.0e18))) && all(lessThan(abs(velocity), vec3(1.0e18))))) {
        return NONE;
    }
    float foam = 0.0;
    if (FOAM == 1u && push.foam_stride > 0u) {
        foam = amounts[push.foam_word + index * push.foam_stride];
        foam = foam > 0.0 ? min(foam, 1.0) : 0.0;
    }
    float body = 1.0;
    if (push.density_stride > 0u) {
        // 0 marks a particle that was just emitted and has no density yet.
        float density = densities[push.density_word + index * push.density_stride];
        if (density > 0.0 && density < frame.density.x) {
            return NONE;
        }
        body = density > 0.0 ? bulk(density) : 1.0;
    }
    Sprite s;
    s.share = foamy ? foam * body : 1.0 - foam;
    if (!(s.share > 0.0)) {
        return NONE;
    }
    s.centre = (frame.view * vec4(position, 1.0)).xyz;
    float depth = -s.centre.z;
    // A particle whose centre is nearer than the near plane has no sprite.
    if (depth <= frame.depth.z || !in_frustum(s.centre, 2.0 * FOAM_AXIS * frame.particle.x)) {
        return NONE;
    }
    velocity = mat3(frame.view) * velocity;
    s.moved = clamp(velocity * frame.motion.x, vec3(-MOST_SPACINGS), vec3(MOST_SPACINGS));
    float least = LEAST_AXIS * depth * max(abs(texel_slope().x), abs(texel_slope().y));
    vec4 slopes;
    if (foamy) {
        vec3 e1;
        vec3 e2;
        float b = FOAM_AXIS * frame.particle.x;
        float a = b * (1.0 + foam_axes(FoamSprite(vec4(s.centre, foam), vec4(velocity, 0.0), vec4(0.0), vec4(0.0)), e1, e2));
        a = max(a, least);
        s.along = e1 / a;
        s.across = e2 / max(b, least);
        s.normal = cross(e1, e2);
        sphere_bounds(s.centre, a, slopes);
    } else {
        float axis = frame.particle.z * (0.5 + 0.5 * body);
        axis = max(axis, least);
        s.along = vec3(1.0 / axis, 0.0, 0.0);
        s.across = vec3(0.0, 1.0 / axis, 0.0);
        s.normal = vec3(0.0, 0.0, 1.0);
        slopes = vec4(s.centre.xy - axis, s.centre.xy + axis) / depth;
    }
    s.box = pixel_span(pixel_bounds(slopes, texel_slope()), vec2(texel_extent()));
    return s;
}

// Adds an integer with a magnitude below 2^31 to a sum.
void add(uint at, int amount) {
    if (amount == 0) {
        return;
    }
    uint low = uint(amount);
    uint carry = atomicAdd(sums[at], low) > ~low ? 1u : 0u;
    uint high = carry - (amount < 0 ? 1u : 0u);
    if (high != 0u) {
        atomicAdd(sums[at + 1u], high);
    }
}

void splat(ivec2 texel, Sprite s) {
    uint at = texel_index(texel);
    vec2 front = fronts[at];
    if (front.x >= EMPTY) {
        return;
    }
    // Where the ray meets the sprite's plane.
    vec3 w = vec3(ray_slope(vec2(texel) + 0.5, texel_slope()), -1.0);
    float q = dot(s.normal, w);
    float depth = dot(s.normal, s.centre) / q;
    vec3 off = w * depth - s.centre;
    vec2 place = vec2(dot(off, s.along), dot(off, s.across));
    float rho2 = dot(place, place);
    if (!(abs(q) >= 1.0e-6 && depth >= frame.depth.z && rho2 <= 1.0)) {
        return;
    }
    float weight = s.share * thickness_kernel(rho2);
    uint count = surfaces_of(front);
    for (uint surface = 0u; surface < count; ++surface) {
        float part = weight * (front[surface] < EMPTY ? near_surface(depth, front[surface]) : 0.0) * MOTION_UNITS;
        if (part >= 0.5) {
            add(sum_index(at, surface, 0u), int(round(part * s.moved.x)));
            add(sum_index(at, surface, 1u), int(round(part * s.moved.y)));
            add(sum_index(at, surface, 2u), int(round(part * s.moved.z)));
            add(sum_index(at, surface, 3u), int(round(part)));
        }
    }
}

// The smallest rectangle of the sprite's box that holds all texels in which the sprite lies near a surface. In a deep
// body of water it is empty for most particles.
ivec4 near_surfaces(Sprite s) {
    // The plane of a foam sprite may be tilted. Inside the sprite, its depth differs from the depth of the sprite's
    // centre by at most the sum of the sprite's half-axes.
    float tilt = s.normal.z == 1.0 ? 0.0 : inversesqrt(dot(s.along, s.along)) + inversesqrt(dot(s.across, s.across));
    float reach = 3.0 * frame.particle.x + 1.001 * tilt;
    ivec4 part = ivec4(s.box.zw + 1, s.box.xy - 1);
    for (int y = s.box.y; y <= s.box.w; ++y) {
        for (int x = s.box.x; x <= s.box.z; ++x) {
            vec2 front = fronts[texel_index(ivec2(x, y))];
            vec2 off = abs(-s.centre.z - front);
            if (min(off.x, off.y) <= reach) {
                part = ivec4(min(part.xy, ivec2(x, y)), max(part.zw, ivec2(x, y)));
            }
        }
    }
    return part;
}

bool is_small(ivec4 box) {
    return (box.z - box.x + 1) * (box.w - box.y + 1) <= SMALL;
}

void visit(uint index, bool foamy) {
    Sprite s = sprite_of(index, foamy);
    if (s.box.x > s.box.z || s.box.y > s.box.w) {
        return;
    }
    if (!is_small(s.box)) {
        large[atomicAdd(large_count, 1u)] = uvec2(index, foamy ? 1u : 0u);
        return;
    }
    s.box = near_surfaces(s);
    for (int y = s.box.y; y <= s.box.w; ++y) {
        for (int x = s.box.x; x <= s.box.z; ++x) {
            splat(ivec2(x, y), s);
        }
    }
}

void main() {
    uint count = counts.particles;
    uint local = gl_LocalInvocationIndex;
    // All invocations of a workgroup run this loop the same number of times, because the loop contains barriers.
    for (uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x; first < count;
         first += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        if (local == 0u) {
            large_count = 0u;
        }
        barrier();
        if (first + local < count && is_member(first + local)) {
            visit(first + local, false);
            if (FOAM == 1u && push.foam_stride > 0u) {
                visit(first + local, true);
            }
        }
        barrier();
        uint wide = large_count;
        for (uint i = 0u; i < wide; ++i) {
            Sprite s = sprite_of(large[i].x, large[i].y == 1u);
            ivec2 lane = ivec2(local & 7u, local >> 3);
            for (int y = s.box.y + lane.y; y <= s.box.w; y += 8) {
                for (int x = s.box.x + lane.x; x <= s.box.z; x += 8) {
                    splat(ivec2(x, y), s);
                }
            }
        }
        barrier();
    }
}
