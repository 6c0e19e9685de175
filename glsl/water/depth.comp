#version 460
// Pass `depth`, compute path: exact depth of spheres or ellipsoids (thesis Sec. 4.6.1, with the ray's exact
// intersection in place of the billboard's offset). The bits of positive floats, taken as integers, have the same
// order as the floats, so an integer atomic minimum finds the nearest depth.
// Reads: Counts, visible. Writes: depth bits (nearest eye depth, EMPTY elsewhere).

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"

layout(local_size_x = 64) in;
// 0: one invocation per sprite. 1: one workgroup per sprite, for large ones.
layout(constant_id = 0) const uint LARGE = 0;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 3, r32ui) uniform uimage2D depth_bits;

layout(push_constant, std430) uniform Push { uint capacity; } push;

void splat(ivec2 pixel, Ellipsoid body) {
    vec2 slope = ray_slope(vec2(pixel) + 0.5, frame.slope);
    float depth = ellipsoid_hit(slope, body, frame.depth.z);
    if (depth < EMPTY) {
        uint bits = floatBitsToUint(depth);
        // Most sprites lose the comparison: a read is cheaper than an atomic.
        if (bits < imageLoad(depth_bits, pixel).x) {
            imageAtomicMin(depth_bits, pixel, bits);
        }
    }
}

ivec4 span(Ellipsoid body) {
    vec4 slopes;
    ellipsoid_bounds(body, slopes);
    return pixel_span(pixel_bounds(slopes, frame.slope), frame.extent.xy);
}

void main() {
    if (LARGE == 0u) {
        uint index = gl_GlobalInvocationID.x;
        if (index >= counts.small) {
            return;
        }
        Ellipsoid body = ellipsoid_in(visible, index);
        ivec4 box = span(body);
        for (int y = box.y; y <= box.w; ++y) {
            for (int x = box.x; x <= box.z; ++x) {
                splat(ivec2(x, y), body);
            }
        }
        return;
    }
    for (uint i = gl_WorkGroupID.x; i < counts.large; i += gl_NumWorkGroups.x) {
        Ellipsoid body = ellipsoid_in(visible, push.capacity - 1u - i);
        ivec4 box = span(body);
        ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                splat(ivec2(x, y), body);
            }
        }
    }
}
