// Cells of the neighbour grid, and the buckets of its hash table. Needs random.glsl and push constants `cells` (cells
// per unit of length) and `buckets`.

ivec3 cell_of(vec3 position) {
    // `precise`, so that all passes compute the same cell.
    precise vec3 at = position * push.cells;
    return ivec3(floor(at));
}

uint bucket_of(ivec3 cell) {
    uvec3 c = uvec3(cell);
    return pcg(c.x + pcg(c.y + pcg(c.z))) & (push.buckets - 1u);
}
