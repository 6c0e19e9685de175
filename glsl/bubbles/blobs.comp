#version 460
// Pass `blobs`: lists the blobs (balls of soap bubbles) in each cell, a depth slice of a screen tile. The slices are
// in order front to back, the blobs within a cell in any order (the paper draws a billboard for each blob). Three
// dispatches: the first finds the blobs that are on the screen, their places relative to the eye, and the range of the
// depths of their nearest points; the second counts the blobs in each cell; the third enters them. Between the second
// and the third the counts are replaced by their exclusive prefix sums, which the third turns into inclusive ones. With
// the raster path of pass `peel` only the first runs.
// Reads: the host's streams, count. Writes: blobs, range, cells, spans, list.

#include "frame.glsl"
#include "frustum.glsl"
#include "sphere.glsl"
#include "random.glsl"
#include "bubbles.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint GO = 0;

layout(set = 0, binding = 2, std430) readonly buffer Balls { float balls[]; };
layout(set = 0, binding = 3, std430) readonly buffer Turns { float turns[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 5, std430) readonly buffer Count { uint count; };
layout(set = 0, binding = 6, std430) buffer Blobs { Blob blobs[]; };
layout(set = 0, binding = 7, std430) buffer Range { BlobRange range; };
layout(set = 0, binding = 8, std430) buffer Cells { uint cells[]; };
layout(set = 0, binding = 9, std430) writeonly buffer List { uint list[]; };
// For each tile: the first depth slice with a blob, and the slice behind the last one with a blob.
layout(set = 0, binding = 10, std430) buffer Spans { uint spans[]; };

layout(push_constant, std430) uniform Push {
    uint ball_word; // word of the first blob
    uint ball_stride; // in words
    uint turn_word;
    uint turn_stride; // 0: no rotations
    uint id_word;
    uint id_stride; // 0: the index is the id
    uint most;      // number from the host, or the capacity
    uint from_gpu;
} push;

// Quaternion from the world to the blob's space: the inverse of the host's, or the identity if that is invalid.
vec4 turn_of(uint index) {
    vec4 q = vec4(0.0, 0.0, 0.0, 1.0);
    if (push.turn_stride > 0u) {
        uint at = push.turn_word + index * push.turn_stride;
        q = vec4(turns[at], turns[at + 1u], turns[at + 2u], turns[at + 3u]);
        float square = dot(q, q);
        // Comparisons with NaN are false.
        q = square > 1.0e-12 && square < 1.0e12 ? q * inversesqrt(square) : vec4(0.0, 0.0, 0.0, 1.0);
    }
    return turned_back(q);
}

// Factor on a blob's radius. Blobs that would be smaller on the screen than a limit are replaced by a random subset
// of them, enlarged so that the mean coverage stays the same (Cook et al. 2007). Blobs shrink before they vanish from
// the subset; the mean of the squared factors includes that.
float merged(float radius, float distance_, uint id) {
    const float FADES = 0.5; // range of the fade, relative to the kept fraction
    float pixels = radius / max(distance_ * frame.texel.x, 1.0e-20);
    float size = pixels / max(bubbly.sun_mirror.w, 1.0e-20);
    float share = clamp(size * size, 1.0e-12, 1.0);
    if (share == 1.0) {
        return 1.0;
    }
    float own = float(pcg(id ^ 0x6d657267u) >> 8) / 16777216.0;
    float left = clamp(((1.0 + FADES) * share - own) / (FADES * share), 0.0, 1.0);
    float last = clamp(((1.0 + FADES) * share - 1.0) / (FADES * share), 0.0, 1.0);
    float mean = share * (1.0 + FADES / 3.0 * (1.0 - last * last * last));
    return left * inversesqrt(mean);
}

// Stores a blob with its place relative to the eye, and decides whether it is drawn.
void place(uint index) {
    uint at = push.ball_word + index * push.ball_stride;
    vec4 ball = vec4(balls[at], balls[at + 1u], balls[at + 2u], balls[at + 3u]);
    Blob blob = Blob(vec4(0.0, 0.0, 0.0, -1.0), vec4(0.0, 0.0, 0.0, 1.0), 0u, 0u, -1.0, 0u);
    bool valid = all(lessThan(abs(ball), vec4(1.0e18))) && ball.w >= 0.0;
    if (!valid) {
        atomicAdd(range.dropped, 1u);
    }
    // A radius of 0 is no error: it is an empty entry, or foam of which nothing is a blob yet.
    bool good = valid && ball.w > 0.0;
    vec3 centre = (frame.view * vec4(good ? ball.xyz : vec3(0.0), 1.0)).xyz;
    blob.id = push.id_stride > 0u ? ids[push.id_word + index * push.id_stride] : index;
    ball.w *= merged(ball.w, length(centre), blob.id);
    good = good && ball.w > 0.0;
    // A blob around the eye is listed, although it has no bounds on the screen; the near plane clips it.
    blob.ball = good ? vec4(mat3(frame.world) * centre, ball.w) : blob.ball;
    if (good && in_frustum(centre, ball.w)) {
        blob.nearest = max(-centre.z - ball.w, 0.0);
        blob.turn = turn_of(index);
        blob.template_ = pcg(blob.id) % bubbly.kinds.x;
        atomicAdd(range.seen, 1u);
        uint near = floatBitsToUint(blob.nearest);
        atomicMin(range.nearest, near);
        atomicMax(range.farthest, near);
    }
    blobs[index] = blob;
}

// First and last tile that it may touch.
bool tiles_of(Blob blob, out ivec4 span) {
    vec4 slopes;
    span = ivec4(0, 0, ivec2(bubbly.tiles.xy) - 1);
    if (sphere_bounds(mat3(frame.view) * blob.ball.xyz, blob.ball.w, slopes)) {
        ivec4 pixels = pixel_span(pixel_bounds(slopes, frame.slope), frame.extent.xy);
        if (any(lessThan(pixels.zw, pixels.xy))) {
            return false;
        }
        span = pixels / TILE;
    }
    return true;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint here = push.from_gpu == 1u ? min(count, push.most) : push.most;
    if (index >= here) {
        // Entries up to the capacity are drawn, so clear the unused ones.
        if (GO == 0u && index < push.most) {
            blobs[index].ball = vec4(0.0, 0.0, 0.0, -1.0);
            blobs[index].nearest = -1.0;
        }
        return;
    }
    if (GO == 0u) {
        place(index);
        return;
    }
    Blob blob = blobs[index];
    ivec4 span;
    if (blob.nearest < 0.0 || !tiles_of(blob, span)) {
        return;
    }
    uint slice = slice_of(range, blob.nearest);
    for (int y = span.y; y <= span.w; ++y) {
        for (int x = span.x; x <= span.z; ++x) {
            uint at = atomicAdd(cells[cell_of(slice, uvec2(x, y))], 1u);
            if (GO == 1u) {
                uint tile = uint(y) * bubbly.tiles.x + uint(x);
                atomicMin(spans[2u * tile], slice);
                atomicMax(spans[2u * tile + 1u], slice + 1u);
            }
            if (GO == 2u && at < bubbly.tiles.w) {
                list[at] = index;
            }
        }
    }
}
