// Tile lists of shoreline and contact foam with their dispatches, shared by producers and consumers.
// Reads, writes: lists, arguments.

// Five lists. 1, 2, 3: tiles that may have shoreline foam, contact foam, or both. 4: runs of tiles with any foam
// (shore_runs.glsl). 5: tiles that may have contact foam on the particles' water.
layout(set = 0, binding = 9, std430) buffer Lists { uint list[]; };
// For each list: workgroups in x, y, z and the number of tiles. The fourth list holds runs of tiles, and its
// arguments are those of a draw: vertices, instances, first vertex, first instance.
layout(set = 0, binding = 10, std430) buffer Arguments { uint arguments[24]; };
layout(push_constant, std430) uniform Push {
    uint across; // tiles
    uint most;   // of a list
} push;

const uint TILE = 8u;            // pixels
const uint TILES = 4u;           // per group of a dispatch over the lists
const uint RUNS = 4u;            // the list of runs
const uint MOST_LISTED = 65535u; // limit of a dispatch, on each axis

// Writes a slot of a list; the first list is 1.
void lists(uint kind, uint slot, uint own) {
    list[(kind - 1u) * push.most + slot] = own;
}

// Enlarges the dispatch over a list to include a slot.
void dispatches(uint kind, uint slot, uint slots_a_group) {
    uint group = slot / slots_a_group;
    atomicMax(arguments[4u * kind], min(group + 1u, MOST_LISTED));
    atomicMax(arguments[4u * kind + 1u], 1u + group / MOST_LISTED);
}

// One of the four tiles of a workgroup; false if there is none.
bool tile_of(uint kind, uint own, out uint tile) {
    uint i = TILES * (gl_WorkGroupID.y * MOST_LISTED + gl_WorkGroupID.x) + own;
    bool listed = i < arguments[4u * kind + 3u];
    tile = list[(kind - 1u) * push.most + (listed ? i : 0u)];
    return listed;
}

uvec2 first_of(uint tile) {
    return TILE * uvec2(tile % push.across, tile / push.across);
}
