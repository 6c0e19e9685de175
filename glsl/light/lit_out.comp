#version 460
// Pass `lit`, last part, compute: copies the lit scene to the output, before the fluid is composited over it.
// Reads: lit scene. Writes: output.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform sampler2D lit;
// The host chooses the format, so the image has no format qualifier.
layout(set = 0, binding = 8) uniform writeonly image2D target;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, ivec2(frame.extent.xy)))) {
        imageStore(target, pixel + ivec2(frame.target.xy), texelFetch(lit, pixel, 0));
    }
}
