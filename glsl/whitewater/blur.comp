#version 460
// Pass `blur`: blurs the light and shadow of whitewater, to remove their sampling noise (Akinci et al. 2013, Sec.
// 2.5; pass 7): first along rows, then along columns. Pixels whose depth differs too much from the middle pixel's do
// not count.
// Reads: tiles with foam, foam depth, foam normal with its search radius, light and shadow. Writes: light and shadow,
// blurred.

#include "frame.glsl"
#include "whitewater_tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 1: each pixel of a 4x4 block has only a sixteenth of the occlusion samples, so the blur must combine at least such
// a block. It then reaches 4 pixels or more, and accepts differences in depth up to the width of 8 pixels, however
// small the particles are.
layout(constant_id = 1) const uint FAST = 0;
const float BLOCK = FAST == 1u ? 4.0 : 0.0;
layout(set = 0, binding = 1) uniform sampler2D occluders;
layout(set = 0, binding = 2) uniform sampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D radiance;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D blurred;
layout(push_constant, std430) uniform Push { ivec2 step; } push;

// Max number of pixels read on each side. A wider blur reads only every n-th pixel, with the smallest odd n that
// suffices. With an odd n all positions in the 4x4 blocks are read, and at least eleven values per side remain,
// enough for a Gaussian.
const int MOST = 32;

void main() {
    ivec2 pixel;
    if (!tile_pixel(pixel)) {
        return;
    }
    ivec2 size = ivec2(frame.extent.xy);
    vec4 middle = texelFetch(radiance, pixel, 0);
    float depth = texelFetch(occluders, pixel, 0).x;
    if (depth >= EMPTY) {
        return;
    }
    float search = texelFetch(normals, pixel, 0).w;
    float first = search * (frame.whitewater_search.x + frame.whitewater_search.y);
    float radius = max(frame.whitewater_color.w * 0.5 * first * frame.extent.y, BLOCK);
    // Pixels whose depth differs by more than this do not count: two radii of the particle, with FAST at least the
    // width of 8 pixels.
    float gap = max(2.0 * search / abs(frame.projection.y), 2.0 * BLOCK * abs(frame.slope.y)) * depth;
    // Number of pixels before and after this one.
    int at = pixel.x * push.step.x + pixel.y * push.step.y;
    int last = (size.x - 1) * push.step.x + (size.y - 1) * push.step.y;
    ivec2 ends = ivec2(at, last - at);
    int reach = int(min(radius, float(max(at, last - at))));
    int stride = (reach + MOST - 1) / MOST | 1;
    float narrow = -2.0 / max(radius * radius, 1.0e-6);
    vec4 sum = middle;
    float weights = 1.0;
    for (int i = stride; i <= reach; i += stride) {
        float away = float(i);
        float weight = exp(narrow * away * away);
        for (int side = 0; side < 2; ++side) {
            ivec2 p = pixel + (side == 0 ? -i : i) * push.step;
            float z = i <= ends[side] ? texelFetch(occluders, p, 0).x : EMPTY;
            float own = abs(z - depth) <= gap ? weight : 0.0;
            sum += own > 0.0 ? own * texelFetch(radiance, p, 0) : vec4(0.0);
            weights += own;
        }
    }
    imageStore(blurred, pixel, sum / weights);
}
