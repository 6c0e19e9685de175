// A quad around each particle as seen from the sun, read from the host's streams, for the vertex shaders of pass
// `light`. Not in the thesis. FRONT: 1: discs of spheres; 0: discs of thickness sprites, with the thickness that they
// add. Two shaders instead of a branch, because validation layers warn of outputs that a fragment shader does not
// read.
// Reads: positions, densities, foam, members. Writes: the quad's corners; centre, half-axis, depth and thickness of
// its disc.

#include "frame.glsl"
#include "density.glsl"
#include "random.glsl"
#include "whole_steps.glsl"

layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 3, std430) readonly buffer Amounts { float amounts[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint density_word;
    uint density_stride;  // 0: no densities
    uint foam_word;
    uint foam_stride;     // 0: no foam
    uint packets;         // 1: particles in no packet do not count
} push;

#define MEMBERS 4
#include "members.glsl"

// Half-axis of the shadow disc of a particle that is only spray, relative to the radius within which the particle's
// droplets scatter.
const float SPREAD = 0.6;

layout(location = 0) flat out vec2 centre; // texels
layout(location = 1) flat out float depth; // along the light, scene units
layout(location = 2) flat out float axis;  // half-axis, scene units
#if FRONT == 0
layout(location = 3) flat out vec2 amount; // thickness of its water and of its foam
layout(location = 4) flat out uint chance; // for stochastic rounding
#endif

void main() {
    uint index = gl_InstanceIndex;
    uint at = push.position_word + index * push.position_stride;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    float bulk_share = 1.0;
    float spray_share = 0.0;
    if (push.density_stride > 0u) {
        float density = densities[push.density_word + index * push.density_stride];
        // A density of 0 marks a particle that was just emitted and has no density yet. A density of NaN is treated
        // likewise, because comparisons with NaN are false.
        if (density > 0.0) {
            bulk_share = density < frame.density.x ? 0.0 : 0.5 + 0.5 * bulk(density);
            spray_share = share_of_spray(density);
        }
    }
    float foam = 0.0;
    if (FOAM == 1u && push.foam_stride > 0u) {
        float share = amounts[push.foam_word + index * push.foam_stride];
        foam = share > 0.0 ? min(share, 1.0) : 0.0;
    }
    // Torn water casts a shadow; a few drops hardly do.
    float torn = torn_of(spray_share);
    float spray = frame.spray_mist.y * spray_share * torn * torn;
    vec2 shares = vec2(bulk_share * (1.0 - foam), bulk_share * foam + spray * (1.0 - bulk_share * foam));
    vec3 seen = (frame.to_light * (frame.view * vec4(position, 1.0))).xyz;
    float texel = frame.light_map.y;
    float radius = frame.particle.x * max(bulk_share, 0.5);
    // At least one texel wide, so that it does not fall between texels.
    float wide = mix(frame.particle.z, max(frame.particle.z, SPREAD * frame.spray.z), spray_share);
    axis = max(FRONT == 1 ? radius : wide, texel);
    depth = seen.z;
#if FRONT == 0
    // As for the camera's thickness sprites, the integral of a sprite over the map is the particle's volume.
    float volume = frame.particle.w * frame.particle.z * frame.particle.z;
    amount = shares * volume / (axis * axis);
    // The random number for rounding is computed from the particle's position, so it needs no ids and does not depend
    // on the order of the particles.
    uvec3 bits = floatBitsToUint(position);
    chance = chance_of(bits.x, chance_of(bits.y, bits.z));
#endif
    vec2 side = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
    // The quad is one texel wider than its disc on each side, so that snapping of vertex positions does not cut the
    // disc.
    centre = seen.xy * frame.light_map.x;
    vec2 ndc = (centre + side * (axis / texel + 1.0)) / frame.light_map.x * 2.0 - 1.0;
    bool there = is_member(index) && shares.x + shares.y > 0.0 && all(lessThan(abs(position), vec3(1.0e18)));
    gl_Position = vec4(there ? ndc : vec2(-4.0), 0.5, 1.0);
}
