#version 460
// Pass `emit`, last part: final counts.
// Reads: counts. Writes: counts.

#include "random.glsl"
#include "generate.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = 1, std430) buffer CountBuffer { GenerateCounts counts; };

void main() {
    uint beyond = counts.made - min(counts.made, counts.free);
    uint fits = min(beyond, push.most - counts.high);
    counts.high += fits;
    counts.lost += min(beyond - fits, 0xffffffffu - counts.lost);
}
