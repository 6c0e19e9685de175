#version 460
// Pass `impostor`: blobs as cube maps of their outermost surface, once per renderer (Huszar, Szecsi, Sec. 4.2, 4.3):
// all six faces of all blobs in one dispatch, where the source has a geometry shader. Two maps: how far from the middle
// it lies, and which bubble's it is.
// Reads: bubbles. Writes: distances (R32F), ids (R32UI).

#include "cube.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 0: distances, 1: ids.
layout(constant_id = 0) const uint IDS = 0;

layout(set = 0, binding = 0, r32f) uniform writeonly image2DArray distances;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2DArray ids;
layout(set = 0, binding = 2, std430) readonly buffer Bubbles { vec4 bubbles[]; };
layout(push_constant, std430) uniform Push {
    uint count; // of a blob
    uint size;  // of a face
} push;

const uint NO_BUBBLE = 0xffffffffu;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at.xy, ivec2(push.size)))) {
        return;
    }
    vec3 direction = cube_direction(ivec3(at.xy, at.z % 6), int(push.size));
    uint first = uint(at.z / 6) * push.count;
    float best = 0.0;
    uint id = NO_BUBBLE;
    for (uint i = 0u; i < push.count; ++i) {
        vec4 bubble = bubbles[first + i];
        float along = dot(direction, bubble.xyz);
        vec3 off = bubble.xyz - along * direction;
        float left = bubble.w * bubble.w - dot(off, off);
        float far = along + sqrt(max(left, 0.0));
        bool farther = left >= 0.0 && far > best;
        best = farther ? far : best;
        id = farther ? i : id;
    }
    if (IDS == 1u) {
        imageStore(ids, at, uvec4(id));
    } else {
        imageStore(distances, at, vec4(best));
    }
}
