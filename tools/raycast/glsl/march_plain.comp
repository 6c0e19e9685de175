#version 460
// Pass `march` of the plain ray-caster: sums at each sample of a ray the kernels of the particles in the surrounding
// cells (Ihmsen et al. 2012, Sec. 5), from where the ray enters the bounding box of all particles to where it leaves
// it. It runs in rounds: a ray that reaches its limit of look-ups goes on in the next round.
// Reads: cells, sorted, box, scene depth, rays. Writes: box, thickness, rays.

#include "view.glsl"
#include "kernel.glsl"
#include "space.glsl"

layout(local_size_x_id = 1, local_size_y_id = 1) in;
layout(set = 0, binding = 1, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 2, std430) readonly buffer Sorted { uvec4 sorted[]; };
layout(set = 0, binding = 3, std430) buffer Box { uint box[7]; };
layout(set = 0, binding = 4, std430) readonly buffer Scene { float scene[]; };
layout(set = 0, binding = 5, std430) buffer Thickness { float thickness[]; };
layout(set = 0, binding = 6, std430) buffer Rays { uint rays[]; };

// Look-ups per ray and round. The limit keeps a dispatch short; and lavapipe ends every loop after 65535 turns of eight
// rays together.
const uint MOST_LOOKS = 6000u;
// Stored for a finished ray in place of its next sample.
const uint DONE = 0xffffffffu;

// Sum of all kernels at a sample. Adds the number of look-ups to `looks`.
float density_at(vec2 slope, float depth, inout uint looks) {
    float sum = 0.0;
    uvec2 layers = layers_about(depth);
    for (uint layer = layers.x; layer <= layers.y; ++layer) {
        vec2 scale = scale_of(layer);
        vec2 at = slope * depth * scale;
        // Reach of a ball in cells, with a margin for rounding.
        vec2 reach = 1.0 / CELL + 1.0e-3 + 1.0e-6 * abs(at);
        uint left = across_of(at.x - reach.x);
        uint right = across_of(at.x + reach.x);
        float last = floor(at.y + reach.y);
        for (float down = floor(at.y - reach.y); down <= last; down += 1.0) {
            uint row = row_of(down, layer);
            uint bucket = bucket_of(row);
            uint begin = cells[bucket + left - 1u];
            uint end = cells[bucket + right];
            looks += end - begin + 2u;
            for (uint i = begin; i < end; ++i) {
                vec4 ball = uintBitsToFloat(sorted[2u * i]);
                float q = (depth - ball.z) * ball.w;
                float y = rest_of(ball.xyz, ball.w, slope) - q * q;
                if (y > 0.0) {
                    // Two rows may share buckets, so compare the row's key.
                    uvec4 what = sorted[2u * i + 1u];
                    sum += what.w == row ? kernel_at(uintBitsToFloat(what.xyz), y) : 0.0;
                }
            }
        }
    }
    return sum;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uint at = pixel.y * view.extent.x + pixel.x;
    if (any(greaterThanEqual(pixel, view.extent.xy)) || box[5] == 0u || rays[at] == DONE) {
        return;
    }
    vec2 slope = (vec2(pixel) + 0.5) * view.slope.xy + view.slope.zw;
    vec3 low = -vec3(inwards(box[0]), inwards(box[1]), inwards(box[2]));
    vec3 high = vec3(inwards(box[3]), inwards(box[4]), inwards(box[5]));
    vec2 inverse = 1.0 / mix(vec2(1.0e-12), slope, greaterThan(abs(slope), vec2(1.0e-12)));
    vec2 ins = min(low.xy * inverse, high.xy * inverse);
    vec2 outs = max(low.xy * inverse, high.xy * inverse);
    float near = 0.99999 * max(max(low.z, 0.0), max(ins.x, ins.y));
    float far = min(1.00001 * min(high.z, min(outs.x, outs.y)), scene[at]);
    if (near >= far) {
        rays[at] = DONE;
        return;
    }
    float sum = thickness[at];
    float place = sample_place(pixel);
    uint samples = view.samples.x;
    uvec2 slabs = slabs_between(near, far);
    // Index of the next sample, counted over all slabs of the ray.
    uint next = max(rays[at], slabs.x * samples);
    uint looks = 0u;
    for (uint slab = next / samples; slab <= slabs.y && sum < view.lens.w && looks < MOST_LOOKS; ++slab) {
        float begin = slab_depth(slab);
        float dz = (slab_depth(slab + 1u) - begin) / float(samples);
        float first = begin + place * dz;
        uint k = max(uint(clamp(floor((near - first) / dz), 0.0, float(samples))), next - slab * samples);
        uint end = uint(clamp(ceil((far - first) / dz), 0.0, float(samples)));
        float slab_sum = 0.0;
        while (k < end && sum + dz * slab_sum < view.lens.w && looks < MOST_LOOKS) {
            slab_sum += density_at(slope, first + float(k) * dz, looks);
            ++k;
        }
        sum += dz * slab_sum;
        ++looks;
        next = k < end ? slab * samples + k : (slab + 1u) * samples;
    }
    thickness[at] = sum;
    bool done = next > slabs.y * samples + samples - 1u || sum >= view.lens.w;
    rays[at] = done ? DONE : next;
    if (!done) {
        atomicMax(box[6], push.count + 1u);
    }
}
