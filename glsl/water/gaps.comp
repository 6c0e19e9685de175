#version 460
// Pass `gaps` (which finds the air between two layers of water), first and second part: for each cell of 8x8 pixels
// the depth of the nearest particle's centre, then the depth slices behind it that hold water. A particle counts in
// each cell that its footprint touches (that of its sphere, also for ellipsoids), so water outside a cell's own
// pixels fills the cell too. Not in the thesis (its limitation, Fig. 5.13).
// Reads: Counts, visible, nearest. Writes: nearest (1), marks (2).

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"
#include "gaps.glsl"

layout(local_size_x = 64) in;
// 0: one invocation per sprite. 1: one workgroup per sprite, for large ones.
layout(constant_id = 0) const uint LARGE = 0;
// 0: nearest depth. 1: marks.
layout(constant_id = 1) const uint MARKS = 0;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
// First one word per cell: the bits of the nearest particle's depth. Then the words that mark the depth slices with
// water of every cell.
layout(set = 0, binding = 3, std430) buffer Cells { uint cells[]; };

layout(push_constant, std430) uniform Push { uint capacity; } push;

void visit(uint cell, uint all, float z) {
    if (MARKS == 0u) {
        uint bits = floatBitsToUint(z);
        if (bits < cells[cell]) {
            atomicMin(cells[cell], bits);
        }
        return;
    }
    float spacing = frame.particle.y;
    float behind = z - uintBitsToFloat(cells[cell]);
    vec2 reach = vec2(behind - REACH * spacing, behind + REACH * spacing) / (SLICE * spacing);
    ivec2 slices = ivec2(clamp(floor(reach), 0.0, float(SLICES - 1)));
    // The slices lie in one word, or in two neighbouring ones.
    for (int word = slices.x >> 5; word <= slices.y >> 5; ++word) {
        ivec2 own = clamp(slices - 32 * word, 0, 31);
        uint bits = bitfieldInsert(0u, ~0u, own.x, own.y - own.x + 1);
        uint at = uint(1 + word) * all + cell;
        // Most slices are already marked: a read is cheaper than an atomic.
        if ((cells[at] & bits) != bits) {
            atomicOr(cells[at], bits);
        }
    }
}

// First and last cell; empty if last < first.
ivec4 touched(vec4 sphere) {
    vec4 slopes;
    if (sphere.w < DROP * frame.particle.x || !sphere_bounds(sphere.xyz, sphere.w, slopes)) {
        return ivec4(0, 0, -1, -1);
    }
    vec2 beside = max(BESIDE * frame.particle.y / (frame.texel.xy * -sphere.z) - 4.0, 0.0);
    vec4 bounds = pixel_bounds(slopes, frame.slope) + vec4(-beside, beside);
    ivec4 span = pixel_span(bounds, frame.extent.xy);
    return any(lessThan(span.zw, span.xy)) ? ivec4(0, 0, -1, -1) : span >> 3;
}

void main() {
    int columns = (int(frame.extent.x) + 7) >> 3;
    uint all = uint(columns * ((int(frame.extent.y) + 7) >> 3));
    if (LARGE == 0u) {
        uint index = gl_GlobalInvocationID.x;
        if (index >= counts.small) {
            return;
        }
        vec4 sphere = visible[ENTRIES * index];
        ivec4 box = touched(sphere);
        if (box.z < box.x) {
            return;
        }
        // One `do`-`while` loop: see thickness.comp.
        ivec2 p = box.xy;
        do {
            visit(uint(p.y * columns + p.x), all, -sphere.z);
            p = p.x < box.z ? ivec2(p.x + 1, p.y) : ivec2(box.x, p.y + 1);
        } while (p.y <= box.w);
        return;
    }
    for (uint i = gl_WorkGroupID.x; i < counts.large; i += gl_NumWorkGroups.x) {
        vec4 sphere = visible[ENTRIES * (push.capacity - 1u - i)];
        ivec4 box = touched(sphere);
        ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                visit(uint(y * columns + x), all, -sphere.z);
            }
        }
    }
}
