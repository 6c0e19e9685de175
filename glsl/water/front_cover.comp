#version 460
// Pass `front`, first part: finds for each cell of 4x4 pixels a depth behind which nothing is visible, because one
// sphere or ellipsoid in front of it covers the whole cell. Each small sprite tests the four cells nearest its
// centre, by the rays through their corners. That suffices: the part of a convex body's front that is nearer than a
// given depth has a convex outline, so over a cell the farthest point of the front is at a corner. Not in the thesis.
// Reads: Counts, visible. Writes: cells (bits of the depth; EMPTY if no sphere covers the cell).

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 3, std430) buffer Cells { uint cells[]; };

layout(push_constant, std430) uniform Push {
    uint capacity;
    int columns;
    int rows;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counts.small) {
        return;
    }
    Ellipsoid body = ellipsoid_in(visible, index);
    vec4 sphere = body.sphere;
    // Too small to cover a cell (half the cell's diagonal is 2.83 pixels).
    if (ellipsoid_reach(body) * sphere.w * 2.9 < 8.0 * frame.texel.x * -sphere.z) {
        return;
    }
    vec2 middle = (sphere.xy / -sphere.z - frame.slope.zw) / frame.slope.xy;
    ivec2 first = ivec2(floor(middle * 0.25 - 0.5));
    float hit[9];
    for (int i = 0; i < 9; ++i) {
        vec2 corner = vec2(first + ivec2(i % 3, i / 3)) * 4.0;
        hit[i] = ellipsoid_hit(ray_slope(corner, frame.slope), body, frame.depth.z);
    }
    for (int i = 0; i < 4; ++i) {
        ivec2 cell = first + ivec2(i & 1, i >> 1);
        int at = (i & 1) + 3 * (i >> 1);
        float farthest = max(max(hit[at], hit[at + 1]), max(hit[at + 3], hit[at + 4]));
        bool inside = cell.x >= 0 && cell.y >= 0 && cell.x < push.columns && cell.y < push.rows;
        if (inside && farthest < EMPTY) {
            uint where = uint(cell.y * push.columns + cell.x);
            uint bits = floatBitsToUint(farthest);
            if (bits < cells[where]) {
                atomicMin(cells[where], bits);
            }
        }
    }
}
