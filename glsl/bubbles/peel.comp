#version 460
// Pass `peel` by tiles: the nearest blobs of each pixel, and the maximum opacity of all blobs (Huszar, Szecsi, Sec.
// 5, draw all blobs once per layer, and once more for the opacity). Here one pass suffices: a pixel visits its tile's
// blobs depth slice by depth slice from the front, keeps the nearest, and stops when no farther blob can change the
// result.
// Reads: blobs, range, cells, spans, list, scene depth, inputs of blob.glsl. Writes: layers, bubble depth (R32F).

#include "frame.glsl"
#include "bubbles.glsl"
#include "cube.glsl"
#include "blob.glsl"
#include "blob_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint LAYERS = 3;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3, std430) readonly buffer Blobs { Blob blobs[]; };
layout(set = 0, binding = 4, std430) readonly buffer Range { BlobRange range; };
layout(set = 0, binding = 5, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 6, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 12, std430) readonly buffer Spans { uvec2 spans[]; };
// For each pixel its layers, front to back, then the max opacity of the blobs that it has visited. The blobs behind
// those would not change the picture.
layout(set = 0, binding = 7, std430) writeonly buffer Layers { uint layers[]; };
layout(set = 0, binding = 11, r32f) uniform writeonly image2D bubble_depth;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.extent.xy)))) {
        return;
    }
    WorldRay ray = world_ray(ray_slope(vec2(pixel) + 0.5, frame.slope));
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(vec2(pixel) + 0.5), 0).x);
    // With a reversed infinite depth, infinity is 1/0, or negative by rounding.
    scene = scene > 0.0 ? min(scene, EMPTY) : EMPTY;
    float depths[LAYERS];
    uint found[LAYERS];
    float opacities[LAYERS];
    for (uint i = 0u; i < LAYERS; ++i) {
        depths[i] = EMPTY;
        found[i] = NO_LAYER;
        opacities[i] = 0.0;
    }
    float most = 0.0;
    uvec2 tile = gl_WorkGroupID.xy * gl_WorkGroupSize.xy / uint(TILE);
    uvec2 span = spans[tile.y * bubbly.tiles.x + tile.x];
    uint slice = span.x;
    bool done = span.x >= span.y;
    // Loops end by a flag and not by `break`, because lavapipe runs the code after a break once more.
    while (!done) {
        uint cell = cell_of(slice, tile);
        uint place = cell > 0u ? min(cells[cell - 1u], bubbly.tiles.w) : 0u;
        uint end = min(cells[cell], bubbly.tiles.w);
        while (place < end) {
            uint index = list[place];
            Seen seen = blob_seen(blobs[index], ray);
            if (seen.depth < scene) {
                most = max(most, seen.opacity);
                float depth = seen.depth;
                float opacity = seen.opacity;
                uint layer = layer_of(index, seen.id);
                // Of two layers at the same depth, the one with the lower number comes first, whatever their
                // order in the list.
                for (uint i = 0u; i < LAYERS; ++i) {
                    bool nearer = depth < depths[i] || (depth == depths[i] && layer < found[i]);
                    vec2 farther = nearer ? vec2(depths[i], opacities[i]) : vec2(depth, opacity);
                    uint other = nearer ? found[i] : layer;
                    depths[i] = nearer ? depth : depths[i];
                    opacities[i] = nearer ? opacity : opacities[i];
                    found[i] = nearer ? layer : found[i];
                    depth = farther.x;
                    opacity = farther.y;
                    layer = other;
                }
            }
            ++place;
        }
        ++slice;
        float begin = slice_begin(range, slice);
        float through = 1.0 - most;
        float behind = 1.0;
        for (uint i = 0u; i < LAYERS; ++i) {
            behind *= 1.0 - opacities[i];
        }
        // True if no farther blob can fill a visible hole between the layers.
        bool hidden = min(through, behind) < HIDDEN || bubbly.mirror.w < 0.5;
        bool full = depths[LAYERS - 1u] <= begin && hidden;
        done = slice >= span.y || full || begin >= scene;
    }
    // Find the exact bubble of the layers that are kept.
    uint at = BY_ID == 1u ? 0u : LAYERS;
    while (at < LAYERS && found[at] != NO_LAYER) {
        found[at] = exact_layer(blobs[found[at] >> 8], ray, found[at], depths[at]);
        ++at;
    }
    uint first = (uint(pixel.y) * uint(frame.extent.x) + uint(pixel.x)) * (LAYERS + 1u);
    for (uint i = 0u; i < LAYERS; ++i) {
        layers[first + i] = found[i];
    }
    layers[first + LAYERS] = floatBitsToUint(most);
    imageStore(bubble_depth, pixel, vec4(depths[0]));
}
