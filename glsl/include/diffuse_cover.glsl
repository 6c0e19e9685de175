// An invocation a particle, all of a group the large ones; or a group for each of the host's packets. What includes it
// says what a particle is there (a Sprite with a Diffuse p and a Footprint f, by sprite_at), which pixels of a box there
// are (inside), what it does to a pixel (splat), and whether anything of a sphere may come to one (shows); it binds
// arguments. Needs diffuse_streams.glsl. Reads: arguments, packets.

// 1: a group for each packet.
layout(constant_id = 1) const uint PACKETS = 0;

layout(set = 0, binding = 9, std430) readonly buffer HostPackets { uint packets[]; };

#include "packets.glsl"

// Pixels of a box that an invocation does by itself.
const int SMALL = 256;

shared uint large[gl_WorkGroupSize.x];
shared uint larges;

// As many of the chunk's particles, from the first on, as the group has invocations; none from the last on.
void cover_group(uint first, uint past) {
    if (gl_LocalInvocationIndex == 0u) {
        larges = 0u;
    }
    barrier();
    uint i = first + gl_LocalInvocationIndex;
    if (i < past) {
        Sprite s = sprite_at(i);
        ivec4 box = s.p.life > 0.0 ? inside(s.f.box) : ivec4(0, 0, -1, -1);
        ivec2 size = max(box.zw - box.xy + 1, ivec2(0));
        if (size.x * size.y > SMALL) {
            large[atomicAdd(larges, 1u)] = i;
        } else {
            // One loop: lanes with boxes of other shapes end with the largest, not with the widest and the highest.
            ivec2 at = box.xy;
            for (int left = size.x * size.y; left > 0; --left) {
                splat(at, s);
                bool last = at.x == box.z;
                at = ivec2(last ? box.x : at.x + 1, last ? at.y + 1 : at.y);
            }
        }
    }
    barrier();
    ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
    for (uint k = 0u; k < larges; ++k) {
        Sprite s = sprite_at(large[k]);
        ivec4 box = inside(s.f.box);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                splat(ivec2(x, y), s);
            }
        }
    }
}

void cover() {
    uint count = arguments[push.chunk].w;
    if (PACKETS == 0u) {
        cover_group(gl_WorkGroupID.x * gl_WorkGroupSize.x, count);
        return;
    }
    Packet packet = packet_at(gl_WorkGroupID.x, push.chunk_first, count);
    if (!shows(packet.middle, packet.reach)) {
        return;
    }
    for (uint first = packet.first; first < packet.past; first += gl_WorkGroupSize.x) {
        cover_group(first, packet.past);
        // What is left over for all of the group is read before the next ones take its place.
        barrier();
    }
}
