// Traversal of whitewater particles: one invocation per particle, or a group per host packet; then a group per large
// particle, from a list that the first dispatch wrote. There are no barriers, which are expensive on a CPU. The
// includer defines the struct `Sprite`, with a Whitewater `p` and a Footprint `f`; `sprite_at`, which returns a
// particle's sprite; `inside`, which clips a box to pixels that exist; `splat`, the operation on a pixel; and
// `shows`, whether particles in a sphere can contribute at all. It also binds arguments. Needs
// whitewater_streams.glsl. Reads: arguments, packets, list. Writes: list.

// 1: a group for each packet.
layout(constant_id = 1) const uint PACKETS = 0;
// 1: one workgroup per particle in the list of large ones.
layout(constant_id = 2) const uint LARGE = 0;

layout(set = 0, binding = 9, std430) readonly buffer HostPackets { uint packets[]; };
// For each chunk its large particles: three words of dispatch arguments, one of the number of large particles, then
// the indices of those that fit.
layout(set = 0, binding = 10, std430) buffer List { uint list[]; };

#include "packets.glsl"

// Max number of pixels of a particle that one invocation processes alone. Particles with more go into the list of
// large ones; if it is full, the invocation processes them too.
const int SMALL = 256;
const uint ROOM = 16384u;
const uint LIST = ROOM + 4u; // words per chunk

// Processes particle i of the chunk if i is less than `past`.
void cover_one(uint i, uint past) {
    if (i >= past) {
        return;
    }
    Sprite s = sprite_at(i);
    ivec4 box = s.p.life > 0.0 ? inside(s.f.box) : ivec4(0, 0, -1, -1);
    ivec2 size = max(box.zw - box.xy + 1, ivec2(0));
    bool small = is_small(s.f.box);
    uint covered = 0u;
    if (small) {
        // Columns of the box as four bits per row, and its rows.
        ivec2 first = clamp(box.xy - s.f.box.xy, 0, COVERED);
        ivec2 past = clamp(box.zw - s.f.box.xy + 1, first, ivec2(COVERED));
        uint columns = (1u << past.x) - (1u << first.x);
        uint rows = (1u << 4 * past.y) - (1u << 4 * first.y);
        covered = s.f.covered & columns * 0x1111u & rows;
    }
    int left = small ? bitCount(covered) : size.x * size.y;
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    for (bool done = left <= SMALL; !done; done = true) {
        uint head = LIST * push.chunk;
        uint slot = atomicAdd(list[head + 3u], 1u);
        if (slot < ROOM) {
            // The index is stored by an atomic, because synchronization validation would attribute a plain store to
            // the dispatch for large particles too, which shares the shader but not this branch.
            atomicExchange(list[head + 4u + slot], i);
            atomicMax(list[head], slot + 1u);
            left = 0;
        }
    }
    // One loop over all pixels of a box. With nested loops, lanes with boxes of different shapes would run as long as
    // the greatest width times the greatest height takes; with one loop, only as long as the largest box takes. In
    // small boxes only covered pixels are visited: mostly one or two of four.
    ivec2 at = box.xy;
    for (; left > 0; --left) {
        int bit = findLSB(covered);
        splat(small ? s.f.box.xy + ivec2(bit & 3, bit >> 2) : at, s);
        covered &= covered - 1u;
        bool last = at.x == box.z;
        at = ivec2(last ? box.x : at.x + 1, last ? at.y + 1 : at.y);
    }
}

// Processes a large particle with all invocations of the workgroup.
void cover_large(uint i) {
    Sprite s = sprite_at(i);
    ivec4 box = inside(s.f.box);
    ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
    for (int y = box.y + lane.y; y <= box.w; y += 8) {
        for (int x = box.x + lane.x; x <= box.z; x += 8) {
            splat(ivec2(x, y), s);
        }
    }
}

void cover() {
    if (LARGE == 1u) {
        cover_large(list[LIST * push.chunk + 4u + gl_WorkGroupID.x]);
        return;
    }
    uint count = arguments[push.chunk].w;
    if (PACKETS == 0u) {
        cover_one(gl_GlobalInvocationID.x, count);
        return;
    }
    Packet packet = packet_at(gl_WorkGroupID.x, push.chunk_first, count);
    if (!shows(packet.middle, packet.reach)) {
        return;
    }
    for (uint i = packet.first; i < packet.past; i += gl_WorkGroupSize.x) {
        cover_one(i + gl_LocalInvocationIndex, packet.past);
    }
}
