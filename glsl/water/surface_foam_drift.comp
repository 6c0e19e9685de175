#version 460
// Pass `surface_foam`: sums the velocities of the foam on grids of nodes on the screen. They advect the lace, a
// pattern of bubbles that tears thin foam into threads (not in the thesis). Each sprite adds its velocity to the four
// nodes around its centre, in each grid that it needs: in a coarser one only as far as it reaches beyond the nodes of
// the finer one. So a coarse node is not filled by thousands of small sprites.
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
// whose centre is more than half a cell outside the grid adds to no node, unless the grid is the `coarsest`: there it
// adds to the nodes at the border.
void add(DriftGrid grid, bool coarsest, vec2 pixel, float share, ivec3 steps) {
    vec2 at = pixel / grid.cell;
    vec2 last = vec2(grid.nodes - 1);
    bool near = all(greaterThan(at, vec2(-0.5))) && all(lessThan(at, last + 0.5));
    if (!(near || coarsest)) {
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
        // All additions are in one loop: a CPU driver runs the invocations one by one at each atomic operation in the
        // code, even those that add nothing. A weight that is added to a full sum is subtracted again.
        bool over = false;
        int k = weight > 0 ? 0 : 4;
        while (k < 4) {
            int value = k > 0 ? weight * steps[k - 1] : over ? -weight : weight;
            int old = atomicAdd(drift[word + uint(k)], value);
            bool undone = over;
            over = k == 0 && !over && old >= DRIFT_FULL;
            k = undone ? 4 : over ? 0 : k + 1;
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
    // The sprite's longer half-axis in pixels.
    vec3 along, across;
    float axis = frame.particle.x * FOAM_AXIS * (1.0 + foam_axes(sprite, along, across));
    float reach = axis / (-centre.z * max(abs(frame.slope.x), abs(frame.slope.y)));
    reach = max(reach, LEAST_FOAM_AXIS * frame.thick_extent.z);
    DriftGrid grid = finest_drift();
    float share = sprite.centre.w;
    for (int i = 0; i < DRIFT_GRIDS && share > 0.0; ++i) {
        add(grid, i == DRIFT_GRIDS - 1, pixel, share, steps);
        // From a reach of half a cell on, a sprite has a growing share in the next grid.
        share *= clamp(2.0 * reach / grid.cell - 1.0, 0.0, 1.0);
        grid = coarser(grid);
    }
}
