#version 460
// Pass `march` of the plain ray-caster: at each sample of a ray the sum of the kernels of the particles in the cells
// about it (Ihmsen et al. 2012, Sec. 5), from where the ray enters the box of all particles to where it leaves it.
// Reads: cells, sorted, box, scene depth. Writes: thickness.

#include "view.glsl"
#include "kernel.glsl"
#include "space.glsl"

layout(local_size_x_id = 1, local_size_y_id = 1) in;
layout(set = 0, binding = 1, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 2, std430) readonly buffer Sorted { uvec4 sorted[]; };
layout(set = 0, binding = 3, std430) readonly buffer Box { uint box[6]; };
layout(set = 0, binding = 4, std430) readonly buffer Scene { float scene[]; };
layout(set = 0, binding = 5, std430) buffer Thickness { float thickness[]; };

// Of all kernels at a sample.
float density_at(vec2 slope, float depth) {
    float sum = 0.0;
    uvec2 layers = layers_about(depth);
    for (uint layer = layers.x; layer <= layers.y; ++layer) {
        vec2 scale = scale_of(layer);
        vec2 at = slope * depth * scale;
        // A ball's reach in cells, and some for rounding.
        vec2 reach = 1.0 / CELL + 1.0e-3 + 1.0e-6 * abs(at);
        uint left = across_of(at.x - reach.x);
        uint right = across_of(at.x + reach.x);
        float last = floor(at.y + reach.y);
        for (float down = floor(at.y - reach.y); down <= last; down += 1.0) {
            uint row = row_of(down, layer);
            uint bucket = bucket_of(row);
            uint end = cells[bucket + right];
            for (uint i = cells[bucket + left - 1u]; i < end; ++i) {
                vec4 ball = uintBitsToFloat(sorted[2u * i]);
                float q = (depth - ball.z) * ball.w;
                float y = rest_of(ball.xyz, ball.w, slope) - q * q;
                // Most balls the sample misses: what is a loop a CPU goes past.
                int hits = y > 0.0 ? 1 : 0;
                for (int hit = 0; hit < hits; ++hit) {
                    // Two rows may share buckets: each finds its own.
                    uvec4 what = sorted[2u * i + 1u];
                    sum += what.w == row ? kernel_at(uintBitsToFloat(what.xyz), y) : 0.0;
                }
            }
        }
    }
    return sum;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy + uvec2(0u, push.count);
    if (any(greaterThanEqual(pixel, view.extent.xy)) || box[5] == 0u) {
        return;
    }
    vec2 slope = (vec2(pixel) + 0.5) * view.slope.xy + view.slope.zw;
    vec3 low = -vec3(inwards(box[0]), inwards(box[1]), inwards(box[2]));
    vec3 high = vec3(inwards(box[3]), inwards(box[4]), inwards(box[5]));
    vec2 inverse = 1.0 / mix(vec2(1.0e-12), slope, greaterThan(abs(slope), vec2(1.0e-12)));
    vec2 ins = min(low.xy * inverse, high.xy * inverse);
    vec2 outs = max(low.xy * inverse, high.xy * inverse);
    uint at = pixel.y * view.extent.x + pixel.x;
    float near = 0.99999 * max(max(low.z, 0.0), max(ins.x, ins.y));
    float far = min(1.00001 * min(high.z, min(outs.x, outs.y)), scene[at]);
    if (near >= far) {
        return;
    }
    float sum = thickness[at];
    float place = sample_place(pixel);
    int samples = int(view.samples.x);
    uvec2 slabs = slabs_between(near, far);
    for (uint slab = slabs.x; slab <= slabs.y && sum < view.lens.w; ++slab) {
        float begin = slab_depth(slab);
        float dz = (slab_depth(slab + 1u) - begin) / float(samples);
        float first = begin + place * dz;
        int k = int(clamp(floor((near - first) / dz), 0.0, float(samples)));
        int end = int(clamp(ceil((far - first) / dz), 0.0, float(samples)));
        float slab_sum = 0.0;
        while (k < end && sum + dz * slab_sum < view.lens.w) {
            slab_sum += density_at(slope, first + float(k) * dz);
            ++k;
        }
        sum += dz * slab_sum;
    }
    thickness[at] = sum;
}
