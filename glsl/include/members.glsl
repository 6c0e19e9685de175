// Bit mask with one bit for each particle of a chunk: whether it is in one of the host's packets (ranges of particles
// with a bounding box). If the host gives packets, particles outside of all packets are treated as absent (thesis
// Sec. 4.3). The includer defines MEMBERS, the binding of the mask; its push.packets is 1 if there are packets.
// Reads: members.

layout(set = 0, binding = MEMBERS, std430) readonly buffer Members { uint members[]; };

bool is_member(uint index) {
    return push.packets == 0u || (members[index >> 5] >> (index & 31u) & 1u) != 0u;
}
