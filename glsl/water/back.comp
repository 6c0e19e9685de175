#version 460
// Pass `back`, second part: nearest exact depth of the spheres or ellipsoids that lie behind the boundary (the depth
// that separates the nearer of two layers of water from the farther one), one sample per texel. Not in the thesis;
// the hit of a ray is computed as in pass `depth`.
// Reads: Counts, visible, boundaries, blocks, levels. Writes: bits of the back depth.

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"
#include "level.glsl"
#include "sheets.glsl"

layout(local_size_x = 64) in;
// 0: one invocation per sprite. 1: one workgroup per sprite, for large ones.
layout(constant_id = 0) const uint LARGE = 0;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 3, r32ui) uniform uimage2D back_bits;
// The nearest boundary of each block.
layout(set = 0, binding = 4, std430) readonly buffer Blocks { float blocks[]; };

layout(push_constant, std430) uniform Push { uint capacity; } push;

void splat(ivec2 texel, Ellipsoid body, Level level) {
    int edge = int(level.texel.z);
    ivec2 pixel = min(texel * edge + (edge >> 1), ivec2(frame.extent.xy) - 1);
    if (-body.sphere.z < boundary_at(pixel)) {
        return;
    }
    vec2 slope = ray_slope(vec2(texel) + 0.5, level.slope);
    float depth = ellipsoid_hit(slope, body, frame.depth.z);
    if (depth < EMPTY) {
        uint bits = floatBitsToUint(depth);
        if (bits < imageLoad(back_bits, texel).x) {
            imageAtomicMin(back_bits, texel, bits);
        }
    }
}

ivec4 span(Ellipsoid body, Level level) {
    vec4 slopes;
    ellipsoid_bounds(body, slopes);
    return pixel_span(pixel_bounds(slopes, level.slope), vec2(level.rect.zw));
}

// Narrows a box of texels to those blocks of 16x16 pixels in which a boundary between two layers of water lies in
// front of the sphere's centre.
ivec4 behind_boundary(Ellipsoid body, ivec4 box, int edge) {
    int columns = (int(frame.extent.x) + BLOCK - 1) / BLOCK;
    // From the centre of each texel.
    ivec2 most = ivec2(frame.extent.xy) - 1;
    ivec4 touched = ivec4(min(box.xy * edge + (edge >> 1), most), min(box.zw * edge + (edge >> 1), most)) >> BLOCK_BITS;
    ivec4 part = ivec4(touched.zw + 1, touched.xy - 1);
    // Two nested loops: a single `do`-`while` loop that runs only once would lose `part` with lavapipe 22.3.
    for (int y = touched.y; y <= touched.w; ++y) {
        for (int x = touched.x; x <= touched.z; ++x) {
            if (-body.sphere.z >= blocks[y * columns + x]) {
                part = ivec4(min(part.xy, ivec2(x, y)), max(part.zw, ivec2(x, y)));
            }
        }
    }
    int bits = findMSB(edge);
    ivec4 pixels = ivec4(part.xy, part.zw + 1) << BLOCK_BITS;
    ivec4 texels = ivec4(pixels.xy >> bits, ((pixels.zw + edge - 1) >> bits) - 1);
    return ivec4(max(box.xy, texels.xy), min(box.zw, texels.zw));
}

void main() {
    Level level = levels.level[BACK];
    if (LARGE == 0u) {
        uint index = gl_GlobalInvocationID.x;
        if (index >= counts.small) {
            return;
        }
        Ellipsoid body = ellipsoid_in(visible, index);
        ivec4 box = span(body, level);
        if (box.x > box.z || box.y > box.w) {
            return;
        }
        box = behind_boundary(body, box, int(level.texel.z));
        if (box.x > box.z || box.y > box.w) {
            return;
        }
        // One `do`-`while` loop: see thickness.comp.
        ivec2 p = box.xy;
        do {
            splat(p, body, level);
            p = p.x < box.z ? ivec2(p.x + 1, p.y) : ivec2(box.x, p.y + 1);
        } while (p.y <= box.w);
        return;
    }
    for (uint i = gl_WorkGroupID.x; i < counts.large; i += gl_NumWorkGroups.x) {
        Ellipsoid body = ellipsoid_in(visible, push.capacity - 1u - i);
        ivec4 box = span(body, level);
        ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                splat(ivec2(x, y), body, level);
            }
        }
    }
}
