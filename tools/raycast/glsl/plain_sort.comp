#version 460
// Pass `sort` of the plain ray-caster: copies the balls, cell by cell (counting sort). A cell's number is the index of
// its first ball before this pass, and the index after its last ball afterwards.
// Reads: records, places, cells. Writes: cells, sorted.

#include "view.glsl"
#include "ball.glsl"
#include "space.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2, std430) readonly buffer Places { uvec2 places[]; };
layout(set = 0, binding = 3, std430) buffer Cells { uint cells[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Sorted { uvec4 sorted[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    uvec2 place = places[i];
    if (place.x > 0u) {
        Ball ball = ball_of(i);
        uint at = atomicAdd(cells[place.x], 1u);
        // The first word decides whether a sample lies in the ball.
        sorted[2u * at] = floatBitsToUint(vec4(ball.centre, ball.inverse));
        sorted[2u * at + 1u] = uvec4(floatBitsToUint(ball.kernel), place.y);
    }
}
