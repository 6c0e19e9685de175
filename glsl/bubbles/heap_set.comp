#version 460
// Pass `heap`, set: initial blobs from the host, at rest or with the host's velocities. Invalid blobs, and entries
// for the halves of blobs that may split later, get radius 0.
// Reads: the host's streams. Writes: balls, turns, ids, drifts, spins, growths.

#include "growth.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) writeonly buffer Balls { vec4 balls[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Turns { vec4 turns[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Drifts { vec4 drifts[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Spins { vec4 spins[]; };
layout(set = 0, binding = 5, std430) readonly buffer HostBalls { float host_balls[]; };
layout(set = 0, binding = 6, std430) readonly buffer HostTurns { float host_turns[]; };
layout(set = 0, binding = 7, std430) readonly buffer HostIds { uint host_ids[]; };
layout(set = 0, binding = 8, std430) readonly buffer HostDrifts { float host_drifts[]; };
layout(set = 0, binding = 10, std430) writeonly buffer Growths { Growth growths[]; };

layout(push_constant, std430) uniform Push {
    uint ball_word;
    uint ball_stride;
    uint turn_word;
    uint turn_stride;  // 0: no rotations
    uint id_word;
    uint id_stride;    // 0: the index is the id
    uint drift_word;
    uint drift_stride; // 0: at rest
    uint blobs;
    uint all;          // capacity, with entries for halves
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.blobs) {
        if (i < push.all) {
            balls[i] = vec4(0.0);
            turns[i] = vec4(0.0, 0.0, 0.0, 1.0);
            ids[i] = 0u;
            drifts[i] = vec4(0.0);
            spins[i] = vec4(0.0);
            growths[i] = Growth(0.0, 1.0, 0.0, 0u);
        }
        return;
    }
    uint at = push.ball_word + i * push.ball_stride;
    vec4 ball = vec4(host_balls[at], host_balls[at + 1u], host_balls[at + 2u], host_balls[at + 3u]);
    // Comparisons with NaN are false.
    bool good = all(lessThan(abs(ball), vec4(1.0e18))) && ball.w > 0.0;
    vec4 turn = vec4(0.0, 0.0, 0.0, 1.0);
    if (push.turn_stride > 0u) {
        at = push.turn_word + i * push.turn_stride;
        vec4 q = vec4(host_turns[at], host_turns[at + 1u], host_turns[at + 2u], host_turns[at + 3u]);
        float square = dot(q, q);
        turn = square > 1.0e-12 && square < 1.0e12 ? q * inversesqrt(square) : turn;
    }
    vec3 drift = vec3(0.0);
    if (push.drift_stride > 0u) {
        at = push.drift_word + i * push.drift_stride;
        vec3 v = vec3(host_drifts[at], host_drifts[at + 1u], host_drifts[at + 2u]);
        drift = all(lessThan(abs(v), vec3(1.0e9))) ? v : drift;
    }
    balls[i] = good ? ball : vec4(0.0);
    turns[i] = turn;
    ids[i] = push.id_stride > 0u ? host_ids[push.id_word + i * push.id_stride] : i;
    drifts[i] = vec4(drift, 0.0);
    spins[i] = vec4(0.0);
    growths[i] = Growth(ball.w, 1.0, 0.0, 0u);
}
