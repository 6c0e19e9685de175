// Marches a ray through the cells of its tile, from the first cell with particles to the last one, to the scene, or
// until the ray is opaque. One group marches one tile. Needs view.glsl, tiles.glsl, push.glsl. Reads: tiles, starts,
// cells, scene depth.

layout(local_size_x_id = 1, local_size_y_id = 1) in;

layout(set = 0, binding = 2, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 3, std430) readonly buffer Starts { uint starts[]; };
layout(set = 0, binding = 4, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 6, std430) readonly buffer Scene { float scene[]; };
layout(set = 0, binding = 7, std430) buffer Thickness { float thickness[]; };
