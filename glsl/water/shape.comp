#version 460
// Pass `shape`, third part: fits the ellipsoid of each particle to the weighted covariance of its neighbours (Yu and
// Turk 2013, Sec. 4, Eqs. 6 and 9 to 16). Differs: the ellipsoid keeps the volume of the particle's sphere (the
// paper's k_s is a kernel constant). The shape changes from sphere to ellipsoid gradually with the sum of the
// neighbours' weights, instead of at a number of neighbours, so that it does not jump in time. The droplets of spray
// fill a second ellipsoid, which needs only one neighbour: a line of torn water is a strand of droplets. Sums use
// fixed-point steps, so the order of the neighbours does not matter.
// Reads: the grid, counts. Writes: shaped, shifts.

#include "random.glsl"
#include "place.glsl"

layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Push {
    float cells;   // grid cells per unit of length: 1 / reach
    uint buckets;  // a power of two
    float ratio;   // largest ratio of the longest to the shortest half-axis
    float fewest;  // sum of the neighbours' weights from which on it is fully an ellipsoid
    float lone;    // size of a particle with at most one neighbour
    float strand;  // like `ratio`, for the ellipsoid of its spray
} push;

#include "grid.glsl"
#include "axes.glsl"
#include "eigen.glsl"
#include "shaped.glsl"

layout(set = 0, binding = 3, std430) readonly buffer CountBuffer { uint sorted; };
layout(set = 0, binding = 4, std430) writeonly buffer Shaped { uint shaped[]; };
// For each particle, in the order of the grid. xyz: vector from it to the weighted mean of itself and its neighbours,
// in units of the reach; w: weight of the ellipsoid, 0 for a sphere to 1.
layout(set = 0, binding = 5, std430) writeonly buffer Shifts { vec4 shifts[]; };

// Fixed-point steps per unit of a sum. Addends are at most 1, so the sums over 27 full buckets (MOST_IN_BUCKET
// particles) fit in 32 bits.
const float STEPS = 65536.0;

// Sums of the neighbours' weights between which the shape of spray changes from a ball to an ellipsoid. A single
// neighbour at half the reach has the weight 7/8.
const vec2 BESIDE_SPRAY = vec2(0.1, 0.6);

// Sums of the neighbours' weights between which a particle grows from the size of a lone one to full size. For each
// of two particles alone the sum is at most 1, for a particle in a line of them 2.8 (with a reach of 2.5 spacings).
const vec2 ALONE = vec2(1.5, 2.5);

// A film is water one particle thick, on a floor or a wall. Three values decide gradually, each between two limits,
// whether a particle is part of a film: FLAT limits the ratio of the smallest to the middle variance, BROAD that of
// the middle to the largest, SOME the sum of the neighbours' weights (because three particles always lie in a plane).
const vec2 FLAT = vec2(0.02, 0.06);
const vec2 BROAD = vec2(0.15, 0.3);
const vec2 SOME = vec2(2.5, 4.5);

// Variance, in squares of the reach, up to which it counts as 0: Jacobi rotations leave rounding errors.
const float NO_VARIANCE = 1.0e-6;

// Returns half-axes of an ellipsoid, proportional to the variances along them and with the product 1; the longest is
// at most `ratio` times the shortest.
vec3 axes_of(vec3 variances, float ratio) {
    float most = max(variances.x, max(variances.y, variances.z));
    if (most <= NO_VARIANCE) {
        return vec3(1.0);
    }
    vec3 axes = max(variances / most, vec3(1.0 / ratio));
    return axes * pow(axes.x * axes.y * axes.z, -1.0 / 3.0);
}

// 1 in a film, 0 elsewhere.
float film_of(vec3 variances, float beside) {
    float most = max(variances.x, max(variances.y, variances.z));
    float least = min(variances.x, min(variances.y, variances.z));
    float middle = max(variances.x + variances.y + variances.z - most - least, NO_VARIANCE);
    return (1.0 - smoothstep(FLAT.x, FLAT.y, least / middle)) * smoothstep(BROAD.x, BROAD.y, middle / max(most, NO_VARIANCE))
        * smoothstep(SOME.x, SOME.y, beside);
}

// V diag(axes) V^T, packed.
uvec3 words_of(vec3 axes, mat3 vectors) {
    return pack_axes(mat3(vectors[0] * axes.x, vectors[1] * axes.y, vectors[2] * axes.z) * transpose(vectors));
}

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
    float beside = float(weights) / STEPS - 1.0;
    // The edges are never equal: GLSL leaves that undefined.
    float share = smoothstep(0.5 * push.fewest, max(push.fewest, 1.0e-6), beside);
    float size = mix(push.lone, 1.0, smoothstep(ALONE.x, ALONE.y, beside));
    vec3 axes = pow(axes_of(variances, push.ratio), vec3(share)) * size;
    uvec3 water = words_of(axes, vectors);
    float torn = smoothstep(BESIDE_SPRAY.x, BESIDE_SPRAY.y, beside);
    uvec3 spray = words_of(pow(axes_of(variances, push.strand), vec3(torn)), vectors);
    uint at = SHAPED_WORDS * places[i].id;
    for (uint k = 0u; k < 3u; ++k) {
        shaped[at + k] = floatBitsToUint(position[k]);
        shaped[at + 3u + k] = water[k];
        shaped[at + 6u + k] = spray[k];
    }
    shaped[at + 9u] = floatBitsToUint(mix(beside, CROWDED, film_of(variances, beside)));
    shifts[i] = vec4(middle, share);
}

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < sorted; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
