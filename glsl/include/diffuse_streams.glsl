// The streams of a chunk of diffuse particles. Needs diffuse.glsl. Reads: positions, kinds, radii, ages, ids.

layout(set = 0, binding = 1, std430) readonly buffer Positions { uint positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Kinds { uint kinds[]; };
layout(set = 0, binding = 3, std430) readonly buffer Radii { uint radii[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ages { uint ages[]; };
layout(set = 0, binding = 5, std430) readonly buffer Ids { uint ids[]; };
// Of a stream that is not there the stride is 0.
layout(push_constant, std430) uniform Push {
    uint position_word;
    uint position_stride;
    uint kind_word;
    uint kind_stride;
    uint radius_word;
    uint radius_stride;
    uint age_word;
    uint age_stride;
    uint id_word;
    uint id_stride;
    uint chunk_first;
    uint chunk;
} push;

Diffuse diffuse_at(uint i) {
    uint word = push.position_word + i * push.position_stride;
    vec3 position = uintBitsToFloat(uvec3(positions[word], positions[word + 1u], positions[word + 2u]));
    uint kind = push.kind_stride > 0u ? kinds[push.kind_word + i * push.kind_stride] : 0u;
    float radius = push.radius_stride > 0u ? uintBitsToFloat(radii[push.radius_word + i * push.radius_stride]) : 0.0;
    float age = push.age_stride > 0u ? uintBitsToFloat(ages[push.age_word + i * push.age_stride]) : 0.0;
    uint id = push.id_stride > 0u ? ids[push.id_word + i * push.id_stride] : push.chunk_first + i;
    return diffuse_of(position, kind, radius, age, id);
}
