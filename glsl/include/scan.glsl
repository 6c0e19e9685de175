// In-place exclusive prefix sum in three dispatches: sums of blocks, prefix sum of the block sums, prefix sum within
// each block (Blelloch 1990). Sums saturate at MOST_SUM: a wrapped sum would start again and place entries at wrong
// positions.
// Reads: counts, blocks. Writes: counts, blocks.

const uint SCAN_GROUP = 256u;
// Number of values per invocation, and per block.
const uint SCAN_EACH = 4u;
const uint SCAN_BLOCK = SCAN_GROUP * SCAN_EACH;

layout(push_constant, std430) uniform Push {
    uint most;  // numbers
    uint count; // the word of Counts with their number, or NONE for all
    uint total; // the word of Counts that gets the sum of all
} push;

const uint NONE = 0xffffffffu;

// Limit of sums: twice this value fits into 32 bits, and so does this value plus some millions.
const uint MOST_SUM = 0x7fffffffu;

uint plus(uint a, uint b) {
    return min(a + b, MOST_SUM);
}

// A number, clamped.
uint counted(uint value) {
    return min(value, MOST_SUM);
}

layout(set = 0, binding = 1, std430) buffer Counts { uint counts[]; };
layout(set = 0, binding = 2, std430) buffer Blocks { uint blocks[]; };

uint numbers() {
    return push.count == NONE ? push.most : min(counts[push.count], push.most);
}

shared uint sums[2][SCAN_GROUP];

// Sum over the preceding invocations of the workgroup; `all` is the sum over all of them.
uint sum_before(uint own, out uint all) {
    uint local = gl_LocalInvocationIndex;
    uint at = 0u;
    sums[0][local] = own;
    barrier();
    for (uint reach = 1u; reach < SCAN_GROUP; reach *= 2u) {
        sums[1u - at][local] = plus(sums[at][local], local >= reach ? sums[at][local - reach] : 0u);
        at = 1u - at;
        barrier();
    }
    uint before = local > 0u ? sums[at][local - 1u] : 0u;
    all = sums[at][SCAN_GROUP - 1u];
    // Wait before the shared values are written again.
    barrier();
    return before;
}
