#version 460
// Pass `cast`: shadow map of the blobs: distance along the light to the first blob, taken as a ball, from two radii of
// the light's region before its centre. Blobs outside of the view cast shadows too. The shadows are grey, unlike those
// of water, because a blob's core is opaque.
// Reads: blobs. Writes: the map, by atomics.

#include "frame.glsl"
#include "bubbles.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 3, std430) readonly buffer Blobs { Blob blobs[]; };
// Bits of non-negative floats.
layout(set = 0, binding = 4, r32ui) uniform uimage2D front;
layout(push_constant, std430) uniform Push { uint most; } push;

// Radius of the ball that casts a blob's shadow, relative to the blob's radius. The soap films outside of this ball
// let light through, and with a larger ball they would lie in the shadow of their own blob.
const float CORE = 0.78;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.most || blobs[index].ball.w <= 0.0) {
        return;
    }
    vec4 ball = blobs[index].ball;
    ball.w *= CORE;
    int edge = imageSize(front).x;
    // Width of a texel of this map in scene units. The map covers the same square as the light's other maps.
    float texel = frame.light_map.y * frame.light_map.x / float(edge);
    vec3 at = (frame.to_light * vec4(mat3(frame.view) * ball.xyz, 1.0)).xyz;
    vec2 middle = at.xy * float(edge);
    float reach = ball.w / texel;
    ivec2 low = max(ivec2(ceil(middle - reach - 0.5)), ivec2(0));
    ivec2 high = min(ivec2(floor(middle + reach - 0.5)), ivec2(edge - 1));
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            vec2 off = (vec2(x, y) + 0.5 - middle) * texel;
            float left = ball.w * ball.w - dot(off, off);
            float depth = at.z - sqrt(max(left, 0.0)) + frame.light_map.x * frame.light_map.y;
            if (left >= 0.0) {
                imageAtomicMin(front, ivec2(x, y), floatBitsToUint(max(depth, 0.0)));
            }
        }
    }
}
