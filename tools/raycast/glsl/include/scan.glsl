// In-place prefix sum in three passes: sums of blocks, prefix sums of those, prefix sums within each block (Blelloch
// 1990).
// Reads: blocks. Writes: blocks.

const uint GROUP = 256u;
// Values per invocation, and per block.
const uint EACH = 8u;
const uint BLOCK = GROUP * EACH;

// 1: each value counts as 0 or 1, and the sum is inclusive for values that are not 0. 0: an exclusive sum of the
// values.
layout(constant_id = 0) const uint BRICKS = 0;

layout(push_constant, std430) uniform Push {
    uint count;
} push;

layout(set = 0, binding = 1, std430) buffer Blocks { uint blocks[]; };

uint amount_of(uint value) {
    return BRICKS == 1u ? min(value, 1u) : value;
}

shared uint sums[2][GROUP];

// Sum over the invocations of the group before this one, and (`all`) over the whole group.
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
    // All reads end before the next call writes the sums again.
    barrier();
    return before;
}
