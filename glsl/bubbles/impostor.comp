#version 460
// Pass `impostor`: cube maps of the outermost surface of each different blob, once per renderer (Huszar, Szecsi, Sec.
// 4.2, 4.3): all six faces of all blobs in one dispatch (the paper uses a geometry shader). There are two maps per
// blob, each with a dispatch of its own: distance of the surface from the centre, and index of the bubble there. The
// later passes use one of them; the other one is small.
// Reads: bubbles. Writes: distances (R32F) or ids (bytes).

#include "cube.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 0: distances, 1: ids.
layout(constant_id = 0) const uint IDS = 0;

layout(set = 0, binding = 0, r32f) uniform writeonly image2DArray distances;
// Four texels per word.
layout(set = 0, binding = 1, std430) writeonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 2, std430) readonly buffer Bubbles { vec4 bubbles[]; };
layout(push_constant, std430) uniform Push {
    uint count; // bubbles per blob
    uint size;  // texels per edge of a face
} push;

// Distance of the surface from the centre in a direction, and the bubble there. If no bubble lies in this direction,
// the distance is 0 and the bubble is the one whose centre is farthest along the direction.
float outermost(vec3 direction, uint first, out uint id) {
    float best = 0.0;
    float nearest = -2.0;
    id = 0u;
    for (uint i = 0u; i < push.count; ++i) {
        vec4 bubble = bubbles[first + i];
        float along = dot(direction, bubble.xyz);
        vec3 off = bubble.xyz - along * direction;
        float left = bubble.w * bubble.w - dot(off, off);
        float far = along + sqrt(max(left, 0.0));
        bool farther = left >= 0.0 && far > best;
        best = farther ? far : best;
        bool beside = best == 0.0 && along > nearest;
        nearest = beside ? along : nearest;
        id = farther || beside ? i : id;
    }
    return best;
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int size = int(push.size);
    uint first = uint(at.z / 6) * push.count;
    uint id;
    if (IDS == 0u && all(lessThan(at.xy, ivec2(size)))) {
        imageStore(distances, at, vec4(outermost(cube_direction(ivec3(at.xy, at.z % 6), size), first, id)));
    }
    if (IDS == 1u && at.x < size / 4 && at.y < size) {
        uint word = 0u;
        for (int i = 0; i < 4; ++i) {
            outermost(cube_direction(ivec3(4 * at.x + i, at.y, at.z % 6), size), first, id);
            word |= id << (8 * i);
        }
        ids[(at.z * size + at.y) * (size / 4) + at.x] = word;
    }
}
