#version 460
// Pass `peel`, billboards (Huszar, Szecsi, Sec. 5): a quad around the pixels of each blob.
// Reads: blobs. Writes: the corners of its quad.

#include "frame.glsl"
#include "sphere.glsl"
#include "bubbles.glsl"

layout(set = 0, binding = 3, std430) readonly buffer Blobs { Blob blobs[]; };

layout(location = 0) flat out uint blob_index;

void main() {
    Blob blob = blobs[gl_InstanceIndex];
    blob_index = gl_InstanceIndex;
    vec4 slopes;
    ivec4 span = ivec4(0, 0, ivec2(frame.extent.xy) - 1);
    if (sphere_bounds(mat3(frame.view) * blob.ball.xyz, max(blob.ball.w, 0.0), slopes)) {
        span = pixel_span(pixel_bounds(slopes, frame.slope), frame.extent.xy);
    }
    bool drawn = blob.nearest >= 0.0 && all(lessThanEqual(span.xy, span.zw));
    vec4 edges = vec4(span.xy, span.zw + 1);
    vec2 corner = vec2((gl_VertexIndex & 1) == 0 ? edges.x : edges.z, (gl_VertexIndex & 2) == 0 ? edges.y : edges.w);
    vec2 place = corner / frame.extent.xy * 2.0 - 1.0;
    gl_Position = drawn ? vec4(place, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
}
