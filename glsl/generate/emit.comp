#version 460
// Pass `emit`: new diffuse particles, in a cylinder along the way of each particle of the fluid in the step
// (Ihmsen et al. 2012, Sec. 3.2). In the order of the fluid's particles they take the slots that are free.
// Reads: the grid, normals, wanted (how many are before each), free. Writes: diffuse particles.

#include "random.glsl"
#include "generate.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Places { Place places[]; };
layout(set = 0, binding = 3, std430) readonly buffer Motions { Motion motions[]; };
layout(set = 0, binding = 4, std430) readonly buffer Normals { vec4 normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Wanted { uint wanted[]; };
layout(set = 0, binding = 6, std430) readonly buffer Free { uint free_slots[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Particles { Diffuse particles[]; };
layout(set = 0, binding = 8, std430) writeonly buffer Drifts { Drift drifts[]; };
layout(set = 0, binding = 9, std430) writeonly buffer Kinds { uint kinds[]; };

// Two axes that are perpendicular to a third (Duff et al. 2017).
void axes_of(vec3 z, out vec3 x, out vec3 y) {
    float side = z.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + z.z);
    float b = z.x * z.y * a;
    x = vec3(1.0 + side * z.x * z.x * a, side * b, -side * z.x);
    y = vec3(b, side + z.y * z.y * a, -z.y);
}

void visit(uint i) {
    uint number = motions[i].number;
    uint first = wanted[number];
    uint end = number + 1u < counts.fluid ? wanted[number + 1u] : counts.made;
    if (first >= end) {
        return;
    }
    vec3 velocity = motions[i].velocity;
    float speed = length(velocity);
    vec3 ahead = velocity / speed;
    vec3 x;
    vec3 y;
    axes_of(ahead, x, y);
    uint seed = step_seed();
    uint id = places[i].id;
    for (uint k = 0u; first + k < end; ++k) {
        uint order = first + k;
        uint slot = order < counts.free ? free_slots[order] : counts.high + (order - counts.free);
        if (slot >= push.most) {
            return;
        }
        float radius = 0.5 * push.spacing * sqrt(uniform_of(seed, id, 4u * k + 1u));
        float along = push.dt * speed * uniform_of(seed, id, 4u * k + 2u);
        // Less half a turn: sines are exact only there.
        float turn = 6.28318531 * (uniform_of(seed, id, 4u * k + 3u) - 0.5);
        vec3 off = -radius * (cos(turn) * x + sin(turn) * y);
        particles[slot] = Diffuse(places[i].position + off + along * ahead, 0.0);
        // Files hold numbers of 31 bits.
        drifts[slot] = Drift(velocity + off, pcg(id + pcg(4u * k + 4u + pcg(seed))) >> 1);
        kinds[slot] = kind_of(uint(normals[i].w));
    }
}

void main() {
    uint end = counts.sorted;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
