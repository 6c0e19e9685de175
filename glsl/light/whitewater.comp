#version 460
// Pass `whitewater_light`: for each texel of the light map, sums the thickness of whitewater as seen from the sun,
// and this thickness times its position along the light and times the square of the position. Particles are splatted
// as for the camera (Akinci et al. 2013, Sec. 2.2; shadows of whitewater are future work there). One invocation
// handles a particle, a whole workgroup a large one.
// Reads: positions, kinds, radii, ages, ids, crossfade, front, arguments, packets, list. Writes: words, list.

#include "frame.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "crossfade.glsl"
#include "frustum.glsl"
#include "near_blob.glsl"
#include "light_whitewater.glsl"

layout(local_size_x = 64) in;

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
    int first; // first row of the map whose words are bound
    int last;
} push;

#include "whitewater_streams.glsl"

layout(set = 0, binding = 6, std430) buffer Words { uint words[]; };
layout(set = 0, binding = 7, std430) readonly buffer Arguments { uvec4 arguments[]; };
// Depth at which the light first meets water, foam or spray of the water's particles.
layout(set = 0, binding = 8) uniform sampler2D front;

// A particle as seen from the sun.
struct Sprite {
    Whitewater p;
    Footprint f;
    float depth; // depth of its centre along the light, scene units
    uint place;  // position of its far end, texels along the light
};

Sprite sprite_at(uint i) {
    Sprite s;
    vec4 world = whitewater_world(i);
    s.p = whitewater_whole(i, world);
    vec3 seen = (frame.to_light * vec4(s.p.centre, 1.0)).xyz;
    float texel = frame.light_map.y;
    s.depth = seen.z;
    s.f = footprint_at(seen.xy * frame.light_map.x, vec2(s.p.radius / texel), s.p.kind);
    // The position of a particle along the light is that of its far end, so that a particle of any size does not
    // shade itself. A particle between the sun and the region that the light map covers shades all of the region;
    // one behind the region shades nothing.
    float place = (s.depth + s.p.radius) / texel + 0.5 * frame.light_map.x + 0.5;
    // Particles behind the eye cast shadows too.
    bool there = world.w < 1.0 && all(lessThan(abs(s.p.centre), vec3(EMPTY))) && place < frame.light_map.x;
    // Near the camera a particle can be drawn partly as a blob of bubble foam (cross-fade). That fraction of it
    // casts its shadow as a blob, so only the rest counts here.
    float kept = 1.0;
    for (bool handed = frame.whitewater.z > 0.0 && may_be_blob(s.p, length(s.p.centre)); handed; handed = false) {
        kept = kept_of(s.p);
    }
    s.p.life = there ? kept * life_of(world.w) : 0.0;
    s.place = uint(max(place, 0.0));
    return s;
}

// All additions are in one loop: a CPU driver runs the invocations one by one at each atomic operation in the code,
// even those that add nothing. An addition to a sum that is already full is subtracted again.
void add(uint at, uint steps, uint place) {
    uint high, low;
    umulExtended(steps * place, place, high, low);
    bool over = false;
    uint i = 0u;
    while (i < WORDS) {
        uint value = i == 0u ? (over ? 0u - steps : steps) : i == 1u ? steps * place : i == 2u ? low : high;
        uint old = atomicAdd(words[at + i], value);
        uint carry = old + value < old ? 1u : 0u;
        high += i == 1u ? carry * CARRY : i == 2u ? carry : 0u;
        bool taken = i == 0u && over;
        over = i == 0u && !over && old >= FULL;
        i = taken ? WORDS : over ? 0u : i == 2u && high == 0u ? WORDS : i + 1u;
    }
}

void splat(ivec2 texel, Sprite s) {
    vec2 place;
    float rr = whitewater_place(s.f, texel, place);
    if (!(rr < 1.0)) {
        return;
    }
    float amount = whitewater_amount(s.p, s.f, rr);
    // If whitewater particles fade out behind the water's surface in the picture (`Submerged::Falloff`), their
    // shadows fade out likewise.
    if (SHAPED == 1u && frame.whitewater.w > 0.0) {
        float depth = s.depth - sqrt(1.0 - rr) * s.p.radius;
        amount = whitewater_shares(amount, depth, texelFetch(front, texel, 0).x).x;
    }
    uint steps = uint(amount * STEPS + 0.5);
    if (steps > 0u) {
        add(WORDS * uint((texel.y - push.first) * int(frame.light_map.x) + texel.x), steps, s.place);
    }
}

ivec4 inside(ivec4 box) {
    return ivec4(max(box.xy, ivec2(0, push.first)), min(box.zw, ivec2(int(frame.light_map.x) - 1, push.last)));
}

// Whether a particle whose centre lies in a sphere (`middle` in world space, radius `reach`) may shade any of the
// light map's rows that are bound.
bool shows(vec3 middle, float reach) {
    vec3 seen = (frame.to_light * (frame.view * vec4(middle, 1.0))).xyz;
    // How far the shadow of a particle in the sphere may reach from the sphere's centre `middle`, in texels of the
    // light map: the sum of the sphere's radius, the default radius of a particle, and the half-axis to which small
    // particles are enlarged. If particles have radii of their own, the sphere encloses them.
    float texel = frame.light_map.y;
    float wider = (reach + frame.whitewater.x) / texel + LEAST_REACH;
    vec2 at = seen.xy * frame.light_map.x;
    // Particles behind the region shade nothing in it.
    bool before = (seen.z - reach) / texel + 0.5 * frame.light_map.x < frame.light_map.x + 1.0;
    return before && all(greaterThan(at + wider, vec2(0, push.first)))
        && all(lessThan(at - wider, vec2(frame.light_map.x, push.last + 1)));
}

#include "whitewater_cover.glsl"

void main() {
    cover();
}
