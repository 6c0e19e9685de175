#version 460
// Pass `prepare`: transforms particles to balls in eye space, with the shape, size and fading of whitewater's sprites
// (Akinci et al. 2013, Sec. 2.1 and 2.2), and widened like them where they are small. Marks the slabs of each tile that
// have particles.
// Reads: positions, kinds, ages, ids, tiles. Writes: records, tiles.

#include "view.glsl"
#include "tiles.glsl"
#include "footprint.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) writeonly buffer Records { vec4 records[]; };
layout(set = 0, binding = 2, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer Kinds { uint kinds[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ages { float ages[]; };
layout(set = 0, binding = 5, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 6, std430) buffer Tiles { uint tiles[]; };

layout(push_constant, std430) uniform Push {
    uint count;
} push;

const uint SPRAY = 1u;
const uint BUBBLE = 2u;

// Least half-axis in pixels: a little over half of a pixel's diagonal.
const float LEAST_REACH = 0.75;

// Coefficients a, b, c of the thickness across the disc, y (a + b y + c y^2) with y = 1 - x^2 at x radii from its
// middle. src/lib.rs has the same numbers.
vec3 profile_of(uint kind) {
    return kind == SPRAY ? vec3(0.80382775, -0.16404648, 0.32535885)
         : kind == BUBBLE ? vec3(4.55953372, -9.24229808, 5.20399667)
         : vec3(1.11000391, 0.00375636, -0.10736924);
}

// Mean of the sprite's thickness over its disc.
float mean_of(uint kind) {
    return kind == SPRAY ? 1.0 - 2.0 / 3.5 : kind == BUBBLE ? 0.5 : 1.0 - 2.0 / 4.25;
}

// Opacity left at an age, from 1 down to 0.
float life_of(float age) {
    float l = max(age, 0.0);
    return l < 1.0 ? pow(max(1.0 - l * l, 1.0e-20), 0.4) : 0.0;
}

// Factors from thickness to kernel: the integral of ABEL[k] sqrt(y) y^k along a ray is y^(k + 1).
const vec3 ABEL = vec3(0.63661977, 0.84882636, 1.01859164);

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    vec4 position = vec4(positions[3u * i], positions[3u * i + 1u], positions[3u * i + 2u], 1.0);
    vec3 centre = (view.view * position).xyz;
    centre.z = -centre.z;
    uint kind = kinds[i];
    float age = ages[i];
    bool drawn = age < 1.0 && centre.z > view.lens.z && centre.z < EMPTY && all(lessThan(abs(centre.xy), vec2(EMPTY)));
    // Until shown otherwise, no part of the particle is in the picture.
    records[2u * i] = vec4(0.0);
    records[2u * i + 1u] = vec4(0.0);
    if (!drawn) {
        return;
    }
    float own_radius = view.lattice.x / float(ids[i] % 5u + 1u) * (kind == BUBBLE ? 0.5 : 1.0);
    vec2 own_reach = own_radius / (centre.z * view.lens.xy);
    float wider = max(1.0, LEAST_REACH / min(own_reach.x, own_reach.y));
    float radius = own_radius * wider;
    vec2 reach = own_reach * wider;
    ivec4 box = pixels_of(centre, radius);
    if (box.x > box.z || box.y > box.w) {
        return;
    }
    // A small particle adds the same light wherever it lies between pixels: its share is normalised over the pixels
    // that it covers, those beside the picture included.
    float own = smoothstep(1.0, 2.0, min(reach.x, reach.y));
    float even = 0.0;
    if (own < 1.0) {
        vec2 middle = (centre.xy / centre.z - view.slope.zw) / view.slope.xy;
        vec2 first = ceil(middle - reach - 0.5);
        vec2 last = floor(middle + reach - 0.5);
        float sum = 0.0;
        for (float y = first.y; y <= last.y; y += 1.0) {
            for (float x = first.x; x <= last.x; x += 1.0) {
                vec2 place = (vec2(x, y) + 0.5 - middle) / reach;
                sum += max(1.0 - dot(place, place), 0.0);
            }
        }
        even = (1.0 - own) * 3.14159265 * own_reach.x * own_reach.y * mean_of(kind) / max(sum, 1.0e-6);
    }
    vec3 profile = life_of(age) * (own * profile_of(kind) + vec3(even, 0.0, 0.0));
    uvec2 slabs = slabs_between(centre.z - radius, centre.z + radius);
    bool seen = false;
    uvec4 touched = uvec4(box) / TILE;
    for (uint y = touched.y; y <= touched.w; ++y) {
        for (uint x = touched.x; x <= touched.z; ++x) {
            uint at = 4u * tile_of(uvec2(x, y));
            if (centre.z - radius < uintBitsToFloat(tiles[at + SCENE])) {
                seen = true;
                uint end = min(slabs.y, tiles[at + SCENE_SLAB]) + 1u;
                // Most particles change nothing, and a read is cheaper than an atomic.
                if (slabs.x < tiles[at + NEAR]) {
                    atomicMin(tiles[at + NEAR], slabs.x);
                }
                if (end > tiles[at + FAR]) {
                    atomicMax(tiles[at + FAR], end);
                }
            }
        }
    }
    if (seen) {
        records[2u * i] = vec4(centre, radius);
        records[2u * i + 1u] = vec4(ABEL * profile, 1.0) / radius;
    }
}
