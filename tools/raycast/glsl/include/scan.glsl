// Sums of all that is before each of many numbers, in place: of blocks, of the blocks before each, of the numbers
// before each (Blelloch 1990).
// Reads: blocks. Writes: blocks.

const uint GROUP = 256u;
// Numbers of an invocation, and of a block.
const uint EACH = 8u;
const uint BLOCK = GROUP * EACH;

// 1: of each number that is not 0 the sum is 1 more, its own counted; else its amount, its own not counted.
layout(constant_id = 0) const uint BRICKS = 0;

layout(push_constant, std430) uniform Push {
    uint count;
} push;

layout(set = 0, binding = 1, std430) buffer Blocks { uint blocks[]; };

uint amount_of(uint value) {
    return BRICKS == 1u ? min(value, 1u) : value;
}

shared uint sums[2][GROUP];

// Sum of what the invocations of the group before this one hold, and of all.
uint sum_before(uint own, out uint all) {
    uint local = gl_LocalInvocationIndex;
    uint at = 0u;
    sums[0][local] = own;
    barrier();
    for (uint reach = 1u; reach < GROUP; reach *= 2u) {
        sums[1u - at][local] = sums[at][local] + (local >= reach ? sums[at][local - reach] : 0u);
        at = 1u - at;
        barrier();
    }
    uint before = sums[at][local] - own;
    all = sums[at][GROUP - 1u];
    // Before they are written again.
    barrier();
    return before;
}
