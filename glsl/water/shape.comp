#version 460
// Pass `shape`, third part: fits the ellipsoid of each particle to the weighted covariance of its neighbours (Yu and
// Turk 2013, Sec. 4, Eqs. 6 and 9 to 16). Differs: it keeps its sphere's volume (the paper's k_s is a kernel
// constant), and it changes from sphere to ellipsoid with the sum of the neighbours' weights, not at a number of
// neighbours, so that it does not jump in time.
// Sums use fixed-point steps: the order of the neighbours does not matter.
// Reads: the grid, counts. Writes: shaped, shifts.

#include "random.glsl"
#include "place.glsl"

layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Push {
    float cells;   // grid cells per unit of length: 1 / reach
    uint buckets;  // a power of two
    float ratio;   // largest ratio of the longest to the shortest half-axis
    float fewest;  // sum of the neighbours' weights from which on it is an ellipsoid
    float lone;    // size of a particle without neighbours
} push;

#include "grid.glsl"
#include "axes.glsl"
#include "eigen.glsl"
#include "shaped.glsl"

layout(set = 0, binding = 3, std430) readonly buffer CountBuffer { uint sorted; };
layout(set = 0, binding = 4, std430) writeonly buffer Shaped { uint shaped[]; };
// In the order of the grid: vector to the mean of the neighbours in units of the reach, and the weight of the
// ellipsoid.
layout(set = 0, binding = 5, std430) writeonly buffer Shifts { vec4 shifts[]; };

// Fixed-point steps; addends are at most 1, so the sums of 27 full buckets fit.
const float STEPS = 65536.0;

// Variance that Jacobi rotations leave of 0, in squares of the reach.
const float NO_VARIANCE = 1.0e-6;

void visit(uint i) {
    vec3 position = places[i].position;
    // The particle is its own neighbour at distance 0.
    int weights = int(STEPS);
    ivec3 offsets = ivec3(0);
    ivec3 squares = ivec3(0); // xx yy zz
    ivec3 mixed = ivec3(0);   // yz xz xy
    for (int c = 0; c < 27; ++c) {
        ivec3 cell = neighbour_cell(position, c);
        uvec2 range = range_of(cell);
        for (uint j = range.x; j < range.y; ++j) {
            vec3 to = (places[j].position - position) * push.cells;
            float d2 = dot(to, to);
            if (j == i || !(d2 < 1.0) || !in_cell(places[j].position, cell)) {
                continue;
            }
            float weight = 1.0 - d2 * sqrt(d2);
            vec3 weighted = to * (weight * STEPS);
            weights += int(weight * STEPS + 0.5);
            offsets += ivec3(round(weighted));
            squares += ivec3(round(weighted * to));
            mixed += ivec3(round(weighted.yxx * to.zzy));
        }
    }
    float all = 1.0 / float(weights);
    vec3 middle = vec3(offsets) * all;
    vec3 diagonal = vec3(squares) * all - middle * middle;
    vec3 off = vec3(mixed) * all - middle.yxx * middle.zzy;
    mat3 vectors;
    vec3 variances = eigen(diagonal, off, vectors);
    float most = max(variances.x, max(variances.y, variances.z));
    vec3 axes = vec3(1.0);
    if (most > NO_VARIANCE) {
        axes = max(variances / most, vec3(1.0 / push.ratio));
        axes *= pow(axes.x * axes.y * axes.z, -1.0 / 3.0);
    }
    float beside = float(weights) / STEPS - 1.0;
    // The edges are never equal: GLSL leaves that undefined.
    float share = smoothstep(0.5 * push.fewest, max(push.fewest, 1.0e-6), beside);
    axes = pow(axes, vec3(share)) * mix(push.lone, 1.0, share);
    // V diag(axes) V^T.
    mat3 scaled = mat3(vectors[0] * axes.x, vectors[1] * axes.y, vectors[2] * axes.z);
    uvec3 words = pack_axes(scaled * transpose(vectors));
    uint at = SHAPED_WORDS * places[i].id;
    for (uint k = 0u; k < 3u; ++k) {
        shaped[at + k] = floatBitsToUint(position[k]);
        shaped[at + 3u + k] = words[k];
    }
    shifts[i] = vec4(middle, share);
}

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < sorted; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
