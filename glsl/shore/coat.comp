#version 460
// Pass `composite`, compute: foam on the scene's water, where the particles' is not: that is stored over it.
// Reads: scene colour, shoreline and contact foam. Writes: output.

#include "frame.glsl"
#include "scene_color.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

// Its format is the host's choice: written without being told.
layout(set = 0, binding = 8) uniform writeonly image2D target;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(pixel, ivec2(frame.extent.xy)));
    vec2 coat = inside ? texelFetch(shore_foam, pixel, 0).xy : vec2(0.0);
    for (bool go = coat.x + coat.y > 0.0; go; go = false) {
        imageStore(target, pixel + ivec2(frame.target.xy), vec4(scene_at(vec2(pixel) + 0.5), 1.0));
    }
}
