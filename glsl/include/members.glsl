// Which of a chunk's particles are in host packets, one bit each; particles in no packet do not exist (thesis Sec.
// 4.3). The includer has push.packets, 1 with packets, and defines MEMBERS as its binding. Reads: members.

layout(set = 0, binding = MEMBERS, std430) readonly buffer Members { uint members[]; };

bool is_member(uint index) {
    return push.packets == 0u || (members[index >> 5] >> (index & 31u) & 1u) != 0u;
}
