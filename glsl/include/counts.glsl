// Per-chunk counters that also serve as draw and dispatch arguments (src/water/cull.rs).

struct Counts {
    uint small;           // points: vertexCount. Small sprites, at the front of the list
    uint points_instances;
    uint points_vertex;
    uint points_instance;
    uint quads_vertices;  // quads: vertexCount = 4
    uint large;           // instanceCount. Large sprites, at the back of the list
    uint quads_vertex;
    uint quads_instance;
    uint small_groups[3]; // dispatch over the small sprites
    uint large_groups[3]; // dispatch over the large sprites
    uint cull_groups[3];  // dispatch over the particles of this chunk
    uint particles;       // number of those
    uint dropped;         // a coordinate is NaN, infinite, or at least 1e18 in magnitude
    uint spray;           // particles below the density threshold
    uint foam_vertices;   // foam: vertexCount = 4
    uint foam;            // instanceCount
    uint foam_vertex;
    uint foam_instance;
    uint spray_vertices;  // spray: vertexCount = 4
    uint droplets;        // instanceCount
    uint spray_vertex;
    uint spray_instance;
    uint cast_vertices;   // the light's maps: vertexCount = 4
    uint cast_particles;  // instanceCount: all
    uint cast_vertex;
    uint cast_instance;
    uint noise_vertices;  // surface noise: vertexCount = 4
    uint noise;           // instanceCount
    uint noise_vertex;
    uint noise_instance;
    uint foam_groups[3];  // dispatch over the foam
};
