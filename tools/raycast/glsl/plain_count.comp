#version 460
// Pass `count` of the plain ray-caster: finds the cell of each ball, the number of balls in each cell, and the bounding
// box of all balls.
// Reads: records. Writes: places, cells, box.

#include "view.glsl"
#include "ball.glsl"
#include "space.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2, std430) writeonly buffer Places { uvec2 places[]; };
layout(set = 0, binding = 3, std430) buffer Cells { uint cells[]; };
layout(set = 0, binding = 4, std430) buffer Box { uint box[7]; };

// Corners of the group's box: six atomics per group instead of six per ball.
shared uint corners[6];

void main() {
    uint local = gl_LocalInvocationIndex;
    if (local < 6u) {
        corners[local] = 0u;
    }
    barrier();
    uint i = gl_GlobalInvocationID.x;
    Ball ball = ball_of(min(i, max(push.count, 1u) - 1u));
    if (i < push.count) {
        uvec2 place = uvec2(0u);
        if (ball.radius > 0.0) {
            uint layer = layer_of(ball.centre.z);
            vec2 at = ball.centre.xy * scale_of(layer);
            place.y = row_of(at.y, layer);
            place.x = bucket_of(place.y) + across_of(at.x);
            atomicAdd(cells[place.x], 1u);
            // A margin for rounding makes the box larger.
            vec3 reach = 1.001 * ball.radius * vec3(flare(), 1.0) + 1.0e-6 * abs(ball.centre);
            vec3 low = -(ball.centre - reach);
            vec3 high = ball.centre + reach;
            for (int axis = 0; axis < 3; ++axis) {
                atomicMax(corners[axis], outwards(low[axis]));
                atomicMax(corners[axis + 3], outwards(high[axis]));
            }
        }
        places[i] = place;
    }
    barrier();
    if (local < 6u && corners[local] > box[local]) {
        atomicMax(box[local], corners[local]);
    }
}
