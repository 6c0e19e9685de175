#version 460
// Pass `front`, second part: copies the sprites that may be visible in at least one of the cells of 4x4 pixels that
// they touch to a second list of the same form. In deep water these are only the sprites at the surface. Not in the
// thesis.
// Reads: Counts, visible, cells. Writes: front counts, front list.

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 3, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 4, std430) buffer FrontCounts { Counts front_counts; };
layout(set = 0, binding = 5, std430) writeonly buffer Front { vec4 front[]; };

layout(push_constant, std430) uniform Push {
    uint capacity;
    int columns;
    int rows;
} push;

shared uint group_count;
shared uint group_first;

bool can_show(Ellipsoid body) {
    vec4 slopes;
    ellipsoid_bounds(body, slopes);
    ivec4 span = pixel_span(pixel_bounds(slopes, frame.slope), frame.extent.xy);
    if (span.z < span.x || span.w < span.y) {
        return false;
    }
    // Sprites over 8 cells wide or high are kept without a test, which would cost more than it saves.
    ivec4 touched = span >> 2;
    if (touched.z - touched.x > 7 || touched.w - touched.y > 7) {
        return true;
    }
    uint near = floatBitsToUint(max(ellipsoid_nearest(body), frame.depth.z));
    for (int y = touched.y; y <= touched.w; ++y) {
        for (int x = touched.x; x <= touched.z; ++x) {
            if (near < cells[uint(y * push.columns + x)]) {
                return true;
            }
        }
    }
    return false;
}

void copy(uint from, uint to) {
    for (uint i = 0u; i < ENTRIES; ++i) {
        front[ENTRIES * to + i] = visible[ENTRIES * from + i];
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    bool keep = false;
    if (index < counts.small) {
        keep = can_show(ellipsoid_in(visible, index));
    }
    if (gl_LocalInvocationIndex == 0u) {
        group_count = 0u;
    }
    barrier();
    uint slot = keep ? atomicAdd(group_count, 1u) : 0u;
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        group_first = group_count > 0u ? atomicAdd(front_counts.small, group_count) : 0u;
    }
    barrier();
    if (keep) {
        copy(index, group_first + slot);
    }
    // Large sprites are few, so they are copied without a test.
    uint large = counts.large;
    if (index == 0u) {
        front_counts.large = large;
    }
    for (uint i = index; i < large; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        copy(push.capacity - 1u - i, push.capacity - 1u - i);
    }
}
