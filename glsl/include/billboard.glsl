// Intersection of a blob (a ball of soap bubbles) with the ray through a pixel of the blob's billboard. Needs
// nothing. Reads: scene depth, blobs, inputs of blob.glsl.

#include "frame.glsl"
#include "bubbles.glsl"
#include "cube.glsl"
#include "blob.glsl"
#include "blob_ray.glsl"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3, std430) readonly buffer Blobs { Blob blobs[]; };

layout(location = 0) flat in uint blob_index;

// Discards fragments behind the scene.
Seen seen_here() {
    Seen seen = blob_seen(blobs[blob_index], world_ray(ray_slope(gl_FragCoord.xy, frame.slope)));
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(gl_FragCoord.xy), 0).x);
    // With a reversed infinite depth, infinity is 1/0, or negative by rounding.
    scene = scene > 0.0 ? min(scene, EMPTY) : EMPTY;
    if (seen.depth >= scene) {
        discard;
    }
    return seen;
}
