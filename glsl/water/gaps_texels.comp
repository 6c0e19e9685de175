#version 460
// Pass `gaps`, last part: for each texel of the thickness the boundary, a depth in the air between the water that the
// texel shows and the next body of water behind. A cell of 8x8 pixels may have several airs, and its neighbours other
// ones. So each texel chooses an air by its own depth and by weights that are bilinear between cells, so that the
// edges of cells do not show. Any depth in the same air separates the same layers. Not in the thesis.
// Reads: airs, dilated; depth. Writes: boundaries.

#include "frame.glsl"
#include "gaps.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1, std430) readonly buffer Airs { uint airs[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Boundaries { float boundaries[]; };
layout(set = 0, binding = 3, r32f) uniform readonly image2D depth;

layout(push_constant, std430) uniform Push {
    int columns;
    int rows;
} push;

// A boundary between two layers of water lies in the middle of the air between them, but at most this far behind the
// nearer layer, in spacings.
const float BEYOND = 2.0;
// Min distance, in spacings, of a boundary from the ends of the depth range that all chosen airs share, if there is
// room.
const float CLEAR = 0.5;
// Weight of an air with only a drop behind it, relative to an air with a body of water behind it.
const float LEAST = 0.05;

// Nearest depth of a texel's pixels.
float front_of(ivec2 texel) {
    int edge = int(frame.thick_extent.z);
    ivec2 end = min((texel + 1) * edge, ivec2(frame.extent.xy));
    float z = EMPTY;
    for (int y = texel.y * edge; y < end.y; ++y) {
        for (int x = texel.x * edge; x < end.x; ++x) {
            z = min(z, imageLoad(depth, ivec2(x, y)).x);
        }
    }
    return z;
}

// The airs of the four cells around.
struct Cells {
    vec4 origin;
    uvec4 words[3];
};

// One air (depth range without water) of each of the four cells, between the depths `from` and `to`. If `behind` is
// true: the first air whose middle is behind the surface at depth z and that begins at `after` or farther. Otherwise:
// the last air whose middle is before the surface. Without such an air `to` is -1. `body`: 0 if the water behind the
// air is a drop, 1 if it is a body of water.
void airs_of(Cells cells, float z, float after, bool behind, out vec4 from, out vec4 to, out vec4 body) {
    float size = SLICE * frame.particle.y;
    from = vec4(EMPTY);
    to = vec4(-1.0);
    body = vec4(0.0);
    for (int k = 0; k < AIRS; ++k) {
        // The last of the cell's airs that fits is kept. Their order is reversed to find the first one behind the
        // surface.
        int i = behind ? AIRS - 1 - k : k;
        for (int c = 0; c < 4; ++c) {
            uint word = cells.words[i >> 1][c] >> (16 * (i & 1));
            uint next = (cells.words[(i + 1) >> 1][c] >> (16 * ((i + 1) & 1))) & 255u;
            uint water = word >> 8 & 255u;
            float a = cells.origin[c] + size * float(word & 255u);
            float b = cells.origin[c] + size * float(water);
            bool fits = water > 0u && (a + b > 2.0 * z) == behind && (!behind || a >= after);
            float far = next == 255u ? 1.0 : clamp((float(next - water) - BODY.x) / (BODY.y - BODY.x), 0.0, 1.0);
            from[c] = fits ? a : from[c];
            to[c] = fits ? b : to[c];
            body[c] = fits ? far : body[c];
        }
    }
}

float least(vec4 v) {
    return min(min(v.x, v.y), min(v.z, v.w));
}

float boundary_of(ivec2 p) {
    vec2 at = (vec2(p) + 0.5) * (frame.thick_extent.z / 8.0) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    Cells cells;
    for (int i = 0; i < 4; ++i) {
        ivec2 q = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), ivec2(push.columns, push.rows) - 1);
        uint cell = AIR_WORDS * uint(q.y * push.columns + q.x);
        cells.origin[i] = uintBitsToFloat(airs[cell]);
        for (int k = 0; k < 3; ++k) {
            cells.words[k][i] = weights[i] > 0.0 ? airs[cell + 1u + uint(k)] : 0u;
        }
    }
    // Airs that a cell took from another cell have no weight when airs are compared.
    vec4 counted = mix(weights, vec4(0.0), lessThan(cells.origin, vec4(0.0)));
    cells.origin = abs(cells.origin);
    float boundary = EMPTY;
    float most = -1.0;
    float after = 0.0;
    // An air of at least half this width is chosen without regard to the airs behind it: the surfaces at its ends are
    // farther apart in depth than surfaces that `composite` takes for one (`frame.surface.w`), so their texels are
    // not mixed. A narrower air hardly shows.
    float spacing = frame.particle.y;
    float wide = 2.0 * max(frame.surface.w - spacing, CLEAR * spacing);
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool there = any(greaterThan(cells.words[0], uvec4(255u)));
    float z = 0.0;
    // Whether airs behind the surface are examined, or airs before it.
    bool behind = true;
    while (there) {
        z = behind && after == 0.0 ? front_of(p) : z;
        vec4 from;
        vec4 to;
        vec4 body;
        airs_of(cells, z, after, behind, from, to, body);
        // Of all four cells' airs, the one nearest to the surface; below, the airs of other cells that overlap it
        // count with it.
        vec2 first = vec2(EMPTY, -1.0);
        for (int i = 0; i < 4; ++i) {
            bool nearer = to[i] >= 0.0 && (behind ? from[i] < first.x : to[i] > first.y);
            first = nearer ? vec2(from[i], to[i]) : first;
        }
        vec2 all = vec2(0.0, EMPTY); // the range that these airs share
        float sum = 0.0;
        float weight = 0.0;
        float open = 0.0;
        for (int i = 0; i < 4; ++i) {
            bool member = from[i] < first.y && to[i] > first.x;
            float width = to[i] - from[i];
            all = member ? vec2(max(all.x, from[i]), min(all.y, to[i])) : all;
            sum += member ? weights[i] * (from[i] + min(0.5 * width, BEYOND * spacing)) : 0.0;
            weight += member ? weights[i] : 0.0;
            open += member ? counted[i] * min(width / wide, 1.0) * mix(LEAST, 1.0, body[i]) : 0.0;
        }
        bool better = weight > 0.0 && open > most;
        float rest = 0.5 * (all.y - all.x);
        float edge = min(rest, CLEAR * spacing);
        float at = rest > 0.0 ? clamp(sum / weight, all.x + edge, all.y - edge) : sum / weight;
        boundary = better ? at : boundary;
        most = better ? open : most;
        // Airs farther behind the surface are examined until one is wide enough or none is left. If there was none at
        // all behind it, airs before the surface are.
        there = behind && (weight > 0.0 ? open < 0.5 : boundary == EMPTY);
        behind = weight > 0.0;
        after = first.y;
    }
    return boundary;
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, ivec2(frame.thick_extent.xy)))) {
        boundaries[uint(p.y) * uint(frame.thick_extent.x) + uint(p.x)] = boundary_of(p);
    }
}
