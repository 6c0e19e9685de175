#version 460
// Pass `blobs`, first part: clears all cells.
// Reads: nothing. Writes: range, cells, spans.

#include "frame.glsl"
#include "bubbles.glsl"

layout(local_size_x = 256) in;

layout(set = 0, binding = 7, std430) writeonly buffer Range { BlobRange range; };
layout(set = 0, binding = 8, std430) writeonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 10, std430) writeonly buffer Spans { uvec2 spans[]; };

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at == 0u) {
        range = BlobRange(0xffffffffu, 0u, 0u, 0u, 0u);
    }
    if (at < bubbly.tiles.x * bubbly.tiles.y * bubbly.tiles.z) {
        cells[at] = 0u;
    }
    if (at < bubbly.tiles.x * bubbly.tiles.y) {
        spans[at] = uvec2(0xffffffffu, 0u);
    }
}
