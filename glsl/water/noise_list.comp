#version 460
// Pass `noise`, first part: the particles whose noise may show, in eye space. Those so far below the
// surface that a step is more than what they add are left out.
// Reads: Counts (particles), positions, densities, ids, cells. Writes: Counts (noise), sprites.

#include "frame.glsl"
#include "frustum.glsl"
#include "sphere.glsl"
#include "counts.glsl"
#include "density.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 3, std430) readonly buffer Ids { uint ids[]; };
// Of `front`: for each cell of 4x4 pixels a depth behind which no surface is.
layout(set = 0, binding = 4, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 5, std430) buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 6, std430) writeonly buffer Sprites { vec4 sprites[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint density_word;
    uint density_stride;  // 0: no densities
    uint id_word;
    uint id_stride;       // 0: no ids, the number in the frame instead
    uint chunk_first;
    int columns;          // of the cells
} push;

// 1.23 exp(-13) is a fifth of half a step.
const float TOO_FAINT = 13.0;

bool may_show(vec3 centre) {
    float depth = -centre.z;
    vec4 slopes = vec4(centre.xy - frame.noise.w, centre.xy + frame.noise.w) / depth;
    // The surface is that of the pixel a texel's middle lies in.
    vec4 pixels = pixel_bounds(slopes, frame.slope) + vec4(-1.0, -1.0, 1.0, 1.0);
    ivec4 span = pixel_span(pixels, frame.extent.xy);
    if (span.z < span.x || span.w < span.y) {
        return false;
    }
    // Of wide ones a look would cost more than it saves.
    ivec4 touched = span >> 2;
    if (touched.z - touched.x > 7 || touched.w - touched.y > 7) {
        return true;
    }
    float least = depth - frame.particle.x;
    for (int y = touched.y; y <= touched.w; ++y) {
        for (int x = touched.x; x <= touched.z; ++x) {
            float surface = uintBitsToFloat(cells[uint(y * push.columns + x)]);
            if ((least - surface) * frame.noise.z < TOO_FAINT) {
                return true;
            }
        }
    }
    return false;
}

void visit(uint index) {
    if (push.density_stride > 0u) {
        float density = densities[push.density_word + index * push.density_stride];
        // As in cull.comp: 0 marks a particle just emitted, comparisons with NaN are false.
        if (density > 0.0 && density < frame.density.x) {
            return;
        }
    }
    uint at = push.position_word + index * push.position_stride;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    if (!(all(lessThan(abs(position), vec3(1.0e18))))) {
        return;
    }
    vec3 centre = (frame.view * vec4(position, 1.0)).xyz;
    // Half the diagonal of the quad.
    if (-centre.z <= frame.depth.z || !in_frustum(centre, 1.5 * frame.noise.w) || !may_show(centre)) {
        return;
    }
    uint id = push.id_stride > 0u ? ids[push.id_word + index * push.id_stride] : push.chunk_first + index;
    sprites[atomicAdd(counts.noise, 1u)] = vec4(centre, uintBitsToFloat(id));
}

void main() {
    uint count = counts.particles;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
