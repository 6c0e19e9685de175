// Which of a chunk's particles the host's packets hold, a bit each: those in no packet are nowhere (thesis Sec. 4.3). What
// includes this has push.packets, 1 where there are packets, and defines MEMBERS as its binding. Reads: members.

layout(set = 0, binding = MEMBERS, std430) readonly buffer Members { uint members[]; };

bool is_member(uint index) {
    return push.packets == 0u || (members[index >> 5] >> (index & 31u) & 1u) != 0u;
}
