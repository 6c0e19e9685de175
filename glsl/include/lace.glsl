// Lace: bubbles of different sizes that tear thin foam open, so that it forms threads between them. The pattern is a
// power diagram of spheres of three sizes (Worley 1996 uses distances to points), warped by the slope of a gradient
// noise. It is defined in world space, evaluated per pixel, and moves with the foam as in pattern.glsl. Not in the
// thesis, whose thin foam is a veil. Needs frame.glsl, gradient_noise.glsl, surface_foam_drift.glsl. Reads: drift.

layout(set = 0, binding = 33, std430) readonly buffer Drift { int drift[]; };

// Min and max radius of a bubble in cells, and max distance of its centre from the centre of its cell on each axis.
// All bubbles that contain a point have their centres in the eight cells nearest to the point: the centre of any
// other cell is at least 1 away on some axis, its bubble's centre at least 1 - 0.3, which is the max radius.
const vec2 BUBBLE_RADII = vec2(0.5, 0.7);
const float BUBBLE_STRAY = 0.3;
// For large, medium and small bubbles: width of a cell relative to that of large bubbles, offset of the cells, and
// weight in the sum.
const vec3 BUBBLE_CELLS = vec3(1.0, 0.4, 0.16);
const vec3 BUBBLE_BEGIN = vec3(0.0, 31.7, 77.3);
const vec3 BUBBLE_PART = vec3(0.42, 0.34, 0.24);
// Mean of `bubbles_at`, used in its place for bubbles whose cells are less than 1.5 pixels wide, and in part up to 4
// pixels.
const float BUBBLE_MEAN = 0.232;
// A gradient noise warps the bubbles. DRAWN_CELL: width of its cells. DRAWN: distance by which it displaces a point
// where its slope is 1. Both are in cells of the large bubbles. RAGGED: weight with which the noise's value is added
// to the amount of foam that it takes to close a point (`lace_at`).
const float DRAWN_CELL = 2.6;
const float DRAWN = 0.3;
const float RAGGED = 0.3;
// Median of the amount of foam that closes a point.
const float CLOSES = 0.22;
// For a wanted coverage c the amount of foam is COVERS.x + COVERS.y ln(c / (1 - c)). For c from 0.1 to 0.9 the mean
// coverage over the pattern differs from c by at most 0.02.
const vec2 COVERS = vec2(0.33, 0.127);
// Half the range of amounts of foam over which the edge of a thread fades: max(THREAD_ENDS.x, THREAD_ENDS.y w), where
// w is the width of a pixel in cells of the large bubbles.
const vec2 THREAD_ENDS = vec2(0.04, 0.7);
// One half of a thread's opacity fades at the thread's edge over a wider range of amounts of foam than the other
// half, as foam of single bubbles does. This is the min half-width of that range.
const float EDGE_ENDS = 0.16;

// Foam that has just closed over a bubble is thin, so that bubbles show in it: where the amount of foam just closes a
// point, the opacity is multiplied by 1 - SHEER. Where the amount is greater by CLOSED, it is not reduced.
const float SHEER = 0.45;
const float CLOSED = 0.45;

// The pattern repeats after this many cells, centred on the world's origin, so that single precision resolves
// positions within a cell.
const float LACE_WRAP = 65536.0;

// How far a point lies inside its bubble: the difference between the two largest powers of bubbles at the point,
// relative to the square of the max radius. The power is max(r^2 - d^2, 0) for a bubble of radius r at distance d.
// The result is 0 on the wall between two bubbles and outside all bubbles, and 1 at the centre of a bubble of max
// radius that no other one overlaps.
float bubbles_at(vec3 p) {
    p -= 0.5;
    vec3 cell = floor(p);
    vec3 f = p - cell;
    vec2 deepest = vec2(0.0);
    for (int i = 0; i < 8; ++i) {
        uvec3 side = uvec3(i & 1, i >> 1 & 1, i >> 2);
        uvec3 at = (uvec3(ivec3(cell)) + side) * LATTICE;
        uint h = at.x ^ at.y ^ at.z;
        h = (h ^ (h >> 15)) * 0x27D4EB2Fu;
        h ^= h >> 13;
        vec4 own = vec4(uvec4(h, h >> 8, h >> 16, h >> 24) & 255u) / 255.0;
        vec3 apart = vec3(side) + BUBBLE_STRAY * (2.0 * own.xyz - 1.0) - f;
        float radius = mix(BUBBLE_RADII.x, BUBBLE_RADII.y, own.w);
        float power = max(radius * radius - dot(apart, apart), 0.0);
        deepest.y = max(deepest.y, min(power, deepest.x));
        deepest.x = max(deepest.x, power);
    }
    return (deepest.x - deepest.y) / (BUBBLE_RADII.y * BUBBLE_RADII.y);
}

// Amount of foam that it takes to close a point: small on a thread, largest at the centre of a hole. `place` is the
// point in cells of the large bubbles; these cells are `pixels` wide.
float lace_at(vec3 place, float pixels) {
    vec4 noise = gradient_noise_slope(place / DRAWN_CELL);
    place += DRAWN * noise.xyz;
    float closes = RAGGED * noise.w;
    for (int i = 0; i < 3; ++i) {
        float told = smoothstep(1.5, 4.0, pixels * BUBBLE_CELLS[i]);
        float own = bubbles_at(place / BUBBLE_CELLS[i] + BUBBLE_BEGIN[i]);
        closes += BUBBLE_PART[i] * mix(BUBBLE_MEAN, own, told);
    }
    return closes;
}

// Sum of the weights in a grid, in fixed-point steps, below which the next coarser grid has a share in the velocity:
// a sixteenth of a sprite.
const float DRIFT_ENOUGH = DRIFT_WHOLE / 16.0;

// World velocity of the foam at a pixel: that of the finest grid, and where few sprites are near, of coarser ones. It
// changes without steps, so that the pattern has no seams, and is 0 far from all sprites.
vec3 drift_at(vec2 pixel) {
    vec4 all = vec4(0.0);
    float open = 1.0;
    DriftGrid grid = finest_drift();
    for (int k = 0; k < DRIFT_GRIDS && open > 0.0; ++k) {
        vec2 at = pixel / grid.cell;
        ivec2 base = ivec2(at);
        vec2 f = at - vec2(base);
        vec4 sum = vec4(0.0);
        for (int i = 0; i < 4; ++i) {
            ivec2 side = ivec2(i & 1, i >> 1);
            vec2 part = mix(1.0 - f, f, vec2(side));
            uint word = drift_word(grid, base + side);
            sum += part.x * part.y * vec4(drift[word], drift[word + 1u], drift[word + 2u], drift[word + 3u]);
        }
        float whole = max(sum.x, DRIFT_ENOUGH);
        all += open / whole * sum;
        open *= (whole - sum.x) / whole;
        grid = coarser(grid);
    }
    return all.x > 0.0 ? all.yzw / all.x * (frame.particle.y / DRIFT_STEPS) : vec3(0.0);
}

// Coverage of a pixel by threads, where smooth foam would have the coverage `hidden`. `place` is the pixel's point in
// cells of the large bubbles, which are `pixels` wide; the foam moves by `way` cells in half a period. Two phases are
// blended as in pattern.glsl. `pore` becomes the amount of foam that closes the point, less its median: it is above 0
// in holes, and also tells where they were once foam has closed them.
float laced(float hidden, vec3 place, vec3 way, float pixels, out float pore) {
    float much = COVERS.x + COVERS.y * log(max(hidden, 1.0e-6) / max(1.0 - hidden, 1.0e-6));
    float ends = max(THREAD_ENDS.x, THREAD_ENDS.y / pixels);
    float closes = CLOSES;
    for (int i = 0; i < 2; ++i) {
        float part = frame.foam_phases[i];
        vec3 at = place - way * frame.foam_phases[2 + i] + frame.foam_octaves[1 + i];
        // A loop instead of a branch, for CPU drivers (docs/performance.md).
        for (bool any = part > 0.0; any; any = false) {
            closes += part * (lace_at(at, pixels) - CLOSES);
        }
    }
    pore = closes - CLOSES;
    float wide = max(ends, EDGE_ENDS);
    float thread = smoothstep(closes - ends, closes + ends, much);
    float edge = smoothstep(closes - wide, closes + wide, much);
    float body = mix(1.0 - SHEER, 1.0, smoothstep(0.0, CLOSED, much - closes));
    return hidden > 0.0 ? 0.5 * (thread + edge) * body : 0.0;
}
