// Calls `visit` for each cell that a particle overlaps, with one invocation per particle. Needs view.glsl, tiles.glsl,
// ball.glsl, footprint.glsl, push.glsl. Reads: records, tiles, starts.

layout(local_size_x = 64) in;

layout(set = 0, binding = 2, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 3, std430) readonly buffer Starts { uint starts[]; };

void visit(uint particle, uint cell);

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    Ball ball = ball_of(i);
    if (!(ball.radius > 0.0)) {
        return;
    }
    uvec4 touched = uvec4(pixels_of(ball.centre, ball.radius)) / TILE;
    uvec2 slabs = slabs_between(ball.centre.z - ball.radius, ball.centre.z + ball.radius);
    for (uint y = touched.y; y <= touched.w; ++y) {
        for (uint x = touched.x; x <= touched.z; ++x) {
            uint tile = tile_of(uvec2(x, y));
            uint near = tiles[4u * tile + NEAR];
            uint end = min(slabs.y + 1u, tiles[4u * tile + FAR]);
            for (uint slab = max(slabs.x, near); slab < end; ++slab) {
                uint cell = starts[tile] + slab - near;
                if (cell < push.cells) {
                    visit(i, cell);
                }
            }
        }
    }
}
