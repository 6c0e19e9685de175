// The host's streams of whitewater particles: the chunk of each that a splat pass binds. Needs frame.glsl,
// falloff.glsl, whitewater.glsl, crossfade.glsl, and push constants with offsets and strides (0 for an absent
// stream).
// Reads: positions, kinds, radii, ages, ids.

layout(set = 0, binding = 1, std430) readonly buffer Positions { uint positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Kinds { uint kinds[]; };
layout(set = 0, binding = 3, std430) readonly buffer Radii { uint radii[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ages { uint ages[]; };
layout(set = 0, binding = 5, std430) readonly buffer Ids { uint ids[]; };

// World position of a particle of the chunk, and its age.
vec4 whitewater_world(uint i) {
    uint word = push.position_word + i * push.position_stride;
    vec3 position = uintBitsToFloat(uvec3(positions[word], positions[word + 1u], positions[word + 2u]));
    return vec4(position, push.age_stride > 0u ? uintBitsToFloat(ages[push.age_word + i * push.age_stride]) : 0.0);
}

// Id of the particle.
uint whitewater_id(uint i) {
    return push.id_stride > 0u ? ids[push.id_word + i * push.id_stride] : push.chunk_first + i;
}

// The whole particle, also where blobs replace it.
Whitewater whitewater_whole(uint i, vec4 world) {
    uint kind = push.kind_stride > 0u ? kinds[push.kind_word + i * push.kind_stride] : 0u;
    float radius = push.radius_stride > 0u ? uintBitsToFloat(radii[push.radius_word + i * push.radius_stride]) : 0.0;
    return whitewater_of(world.xyz, kind, radius, world.w, whitewater_id(i));
}

// The part of the particle that is drawn as a sprite.
Whitewater whitewater_at(uint i, vec4 world) {
    Whitewater p = whitewater_whole(i, world);
    p.life *= kept_of(p);
    return p;
}

Whitewater whitewater_at(uint i) {
    return whitewater_at(i, whitewater_world(i));
}
