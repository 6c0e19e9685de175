#version 460
// Pass `thickness`, compute path: sums of fixed-point numbers, so that their order is no matter.
// An addend is 2^26 at most (a particle of half the radius), 64 overflow a word: what they carry is
// counted in a second one, as exact. Any number of particles may lie on one spot.
// Reads: Counts, visible, scene depth. Writes: sums (UNITS of the amplitude).

#include "frame.glsl"
#include "sphere.glsl"
#include "counts.glsl"
#include "kernel.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint LARGE = 0;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 3) uniform sampler2D scene_depth;
// The sum's low word and its carries.
layout(set = 0, binding = 4, std430) buffer Sums { uvec2 sums[]; };

layout(push_constant, std430) uniform Push { uint capacity; } push;

// A smaller sprite holds the same volume.
float units(float radius) {
    float grown = frame.particle.x / radius;
    return UNITS * grown * grown;
}

// Bounds of the disc in the plane of the centre: exact, it is parallel to the image.
ivec4 span(vec4 sphere, float axis) {
    float inverse = 1.0 / -sphere.z;
    vec4 slopes = vec4(sphere.xy - axis, sphere.xy + axis) * inverse;
    return pixel_span(pixel_bounds(slopes, frame.thick_slope), frame.thick_extent.xy);
}

void splat(ivec2 pixel, vec4 sphere, float inverse_axis, float scale) {
    vec2 slope = ray_slope(vec2(pixel) + 0.5, frame.thick_slope);
    float rho2 = thickness_rho2(slope, sphere.xyz, inverse_axis);
    if (rho2 > 1.0) {
        return;
    }
    float scene = eye_depth(texelFetch(scene_depth, scene_texel((vec2(pixel) + 0.5) * frame.thick_extent.z), 0).x);
    if (scene > 0.0 && -sphere.z >= scene) {
        return;
    }
    uint unit = uint(thickness_kernel(rho2) * scale + 0.5);
    uint at = uint(pixel.y) * uint(frame.thick_extent.x) + uint(pixel.x);
    // What the word held and the addend are more than it can hold.
    if (atomicAdd(sums[at].x, unit) > ~unit) {
        atomicAdd(sums[at].y, 1u);
    }
}

void main() {
    float share = frame.particle.z / frame.particle.x;
    if (LARGE == 0u) {
        uint index = gl_GlobalInvocationID.x;
        if (index >= counts.small) {
            return;
        }
        vec4 sphere = visible[index];
        // A centre behind the near plane has no sprite.
        if (-sphere.z <= frame.depth.z) {
            return;
        }
        float widened;
        float axis = drawn_axis(share * sphere.w, -sphere.z, frame.thick_slope, widened);
        float scale = units(sphere.w) / widened;
        ivec4 box = span(sphere, axis);
        if (box.x > box.z || box.y > box.w) {
            return;
        }
        // One loop with its condition last, not two: where invocations are lanes, all wait for the
        // one with the most pixels once, not once a row, and none runs an empty round.
        ivec2 p = box.xy;
        do {
            splat(p, sphere, 1.0 / axis, scale);
            p = p.x < box.z ? ivec2(p.x + 1, p.y) : ivec2(box.x, p.y + 1);
        } while (p.y <= box.w);
        return;
    }
    for (uint i = gl_WorkGroupID.x; i < counts.large; i += gl_NumWorkGroups.x) {
        vec4 sphere = visible[push.capacity - 1u - i];
        if (-sphere.z <= frame.depth.z) {
            continue;
        }
        float widened;
        float axis = drawn_axis(share * sphere.w, -sphere.z, frame.thick_slope, widened);
        float scale = units(sphere.w) / widened;
        ivec4 box = span(sphere, axis);
        ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                splat(ivec2(x, y), sphere, 1.0 / axis, scale);
            }
        }
    }
}
