#version 460
// Pass `surface_foam`: sums the velocities of the foam on grids of nodes on the screen. They advect the lace, a
// pattern of bubbles that tears thin foam into threads (not in the thesis). Each sprite adds its velocity to the four
// nodes around its centre, in each grid.
// Reads: Counts, sprites. Writes: drift.

#include "frame.glsl"
#include "counts.glsl"
#include "surface_foam.glsl"
#include "surface_foam_drift.glsl"

layout(local_size_x = FOAM_GROUP) in;
layout(set = 0, binding = 1, std430) readonly buffer Sprites { FoamSprite sprites[]; };
layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 5, std430) buffer Drift { int drift[]; };

// Adds a sprite with its centre at `pixel` and the velocity `steps` to the four nodes of a grid around it. A sprite
// whose centre is more than half a cell outside the grid adds to no node: if a part of it is visible, other sprites
// lie inside the grid and give the velocity there.
void add(DriftGrid grid, vec2 pixel, float share, ivec3 steps) {
    vec2 at = pixel / grid.cell;
    vec2 last = vec2(grid.nodes - 1);
    if (!(all(greaterThan(at, vec2(-0.5))) && all(lessThan(at, last + 0.5)))) {
        return;
    }
    at = clamp(at, vec2(0.0), last);
    vec2 base = min(floor(at), last - 1.0);
    vec2 f = at - base;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 part = mix(1.0 - f, f, vec2(side));
        int weight = int(round(DRIFT_WHOLE * share * part.x * part.y));
        uint word = drift_word(grid, ivec2(base) + side);
        if (weight > 0 && drift[word] < DRIFT_FULL) {
            atomicAdd(drift[word], weight);
            atomicAdd(drift[word + 1u], weight * steps.x);
            atomicAdd(drift[word + 2u], weight * steps.y);
            atomicAdd(drift[word + 3u], weight * steps.z);
        }
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= counts.foam) {
        return;
    }
    FoamSprite sprite = sprites[index];
    vec3 centre = sprite.centre.xyz;
    vec2 pixel = (centre.xy / -centre.z - frame.slope.zw) / frame.slope.xy;
    vec3 velocity = mat3(frame.world) * sprite.velocity.xyz * (DRIFT_STEPS / frame.particle.y);
    ivec3 steps = ivec3(round(clamp(velocity, vec3(-DRIFT_MOST), vec3(DRIFT_MOST))));
    DriftGrid grid = finest_drift();
    for (int i = 0; i < DRIFT_GRIDS; ++i) {
        add(grid, pixel, sprite.centre.w, steps);
        grid = coarser(grid);
    }
}
