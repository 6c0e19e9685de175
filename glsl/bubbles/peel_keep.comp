#version 460
// Pass `peel`, raster path: copies the result of one draw, a layer or the opacity, to the buffer that the tiled path
// fills.
// Reads: layer or opacity, blobs, inputs of blob.glsl. Writes: layers, bubble depth (R32F).

#include "frame.glsl"
#include "bubbles.glsl"
#include "cube.glsl"
#include "blob.glsl"
#include "blob_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint LAYERS = 3;

layout(set = 0, binding = 3, std430) readonly buffer Blobs { Blob blobs[]; };
layout(set = 0, binding = 4) uniform usampler2D drawn;
layout(set = 0, binding = 5) uniform sampler2D opacity;
layout(set = 0, binding = 7, std430) writeonly buffer Layers { uint layers[]; };
layout(set = 0, binding = 11, r32f) uniform writeonly image2D bubble_depth;
// Index of the layer; LAYERS for the opacity.
layout(push_constant, std430) uniform Push { uint layer; } push;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.extent.xy)))) {
        return;
    }
    uint at = (uint(pixel.y) * uint(frame.extent.x) + uint(pixel.x)) * (LAYERS + 1u) + push.layer;
    if (push.layer == LAYERS) {
        layers[at] = floatBitsToUint(texelFetch(opacity, pixel, 0).x);
        return;
    }
    uvec2 found = texelFetch(drawn, pixel, 0).xy;
    float depth = found.y == NO_LAYER ? EMPTY : uintBitsToFloat(found.x);
    bool exact = BY_ID == 1u && found.y != NO_LAYER;
    while (exact) {
        WorldRay ray = world_ray(ray_slope(vec2(pixel) + 0.5, frame.slope));
        found.y = exact_layer(blobs[found.y >> 8], ray, found.y, depth);
        exact = false;
    }
    layers[at] = found.y;
    if (push.layer == 0u) {
        imageStore(bubble_depth, pixel, vec4(depth));
    }
}
