// The smoothed water surface at a full-resolution pixel, from the smoothed depth image of lower resolution (thesis
// Sec. 4.9.3, Listings A.17, A.18, A.21 and A.23-A.25). Two depths belong to one surface if they differ by at most
// the depth falloff (`threshold`). If one of a texel's two neighbours on an axis belongs to the texel's surface, the
// other neighbour also does if it continues the slope, that is, if the differences of the texel to both neighbours
// differ by at most the falloff. (The thesis' program tests the second difference as well.) So a surface seen at a
// grazing angle has no border.
// - The slope of a texel along an axis is the mean of the differences to its two neighbours on its surface. A texel
//   that lacks one of its four neighbours is on the rim; the others are complete.
// - A pixel uses those of the four texels around it that belong to the surface of its own depth, with bilinear
//   weights. Texels beyond the image's edge are replaced by those at the edge.
// - Depth and slope of the pixel are the weighted means. In the slope, rim texels have the weight RIM. If complete
//   texels have at most 1/63 of the weight, RIM_SLOPE limits the slope.
// - If none of the four texels belongs to the pixel's surface, the pixel keeps its own depth and takes slope and
//   thickness of another texel: of the one nearest in depth among those beside the four (within one and a half texels
//   of the pixel). If that one is not on the pixel's surface either, or at full resolution, the pixel's surface faces
//   the eye, and the thickness is that of the texel nearest in depth among the four.
// The thesis' program shades four neighbours at a border and blends their colours. Here the derivatives on the same
// surface are blended and shaded once: the colour of another surface never bleeds in, which would show as dark seams.
// Needs frame.glsl, level.glsl. Reads: smoothed.

struct Surface {
    float z;
    vec2 dz;        // per full-resolution pixel
    bool widened;   // a texel belongs to a surface before the pixel's own
    float found;    // weight of texels on the pixel's surface with all neighbours, 0 to 1
    float covered;  // weight of all texels on the pixel's surface
    vec4 weights;   // of the four texels; their sum is 1
    ivec2 base;     // the first of the four texels, from the corner of the level
};

layout(set = 0, binding = 1) uniform sampler2D smoothed;

// Derivatives of four texels along one axis: central, one-sided if the other side belongs to another surface, or 0 if
// both sides do. Clears `whole` for texels that lack a side.
vec4 differences(vec4 before, vec4 z, vec4 after, float threshold, inout bvec4 whole) {
    vec4 a = z - before;
    vec4 b = after - z;
    vec4 turn = abs(b - a);
    bvec4 has_a = lessThanEqual(min(abs(a), max(abs(b), turn)), vec4(threshold));
    bvec4 has_b = lessThanEqual(min(abs(b), max(abs(a), turn)), vec4(threshold));
    bvec4 both = bvec4(has_a.x && has_b.x, has_a.y && has_b.y, has_a.z && has_b.z, has_a.w && has_b.w);
    whole = bvec4(whole.x && both.x, whole.y && both.y, whole.z && both.z, whole.w && both.w);
    vec4 either = mix(mix(vec4(0.0), b, has_b), a, has_a);
    return mix(either, 0.5 * (a + b), both);
}

float smoothed_at(Level level, ivec2 texel) {
    bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, level.rect.zw));
    return inside ? texelFetch(smoothed, level.rect.xy + texel, 0).x : EMPTY;
}

// Weight of a rim texel in the slope, relative to a complete texel. The last particle of a body of water curves away
// within a pixel or two; with full weight it would reflect the horizon, as a row of white dots along every outline.
const float RIM = 1.0 / 64.0;
// Largest slope (change of depth per width) of a drop. A drop is a place where complete texels, whose four neighbours
// all belong to their surface, have at most 1/63 of the weight.
const float RIM_SLOPE = 1.5;

// Returns the smoothed surface at a pixel. `front` is the depth of the pixel's own surface. If it is negative, the
// surface at or behind the depth -front is asked for: that of the nearest texel with such a depth among the four
// around the pixel or, if none of them has one, among the four texels beside these.
Surface surface_at(Level level, vec2 pixel, float front, float threshold) {
    Surface s;
    vec2 h = pixel / level.texel.z - 0.5;
    ivec2 base = ivec2(floor(h));
    vec2 f = h - vec2(base);
    ivec2 last = level.rect.zw - 1;
    s.base = base;

    // The depths of the four texels around the pixel, in the order left-up, right-up, left-down, right-down, and of
    // the neighbours of each. They are in vectors, because an array would live in memory.
    vec2 texel = 1.0 / vec2(levels.atlas.xy);
    ivec2 corner = level.rect.xy + base;
    vec4 upper_left = textureGather(smoothed, vec2(corner) * texel);
    vec4 upper_right = textureGather(smoothed, vec2(corner + ivec2(2, 0)) * texel);
    vec4 lower_left = textureGather(smoothed, vec2(corner + ivec2(0, 2)) * texel);
    vec4 lower_right = textureGather(smoothed, vec2(corner + 2) * texel);
    bool first_x = base.x < 1;
    bool last_x = base.x + 2 > last.x;
    bool first_y = base.y < 1;
    bool last_y = base.y + 2 > last.y;
    // A neighbour beyond the image's edge counts as another surface.
    vec2 row0 = first_y ? vec2(EMPTY) : vec2(upper_left.z, upper_right.w);
    vec4 row1 = vec4(first_x ? EMPTY : upper_left.x, upper_left.y, upper_right.x, last_x ? EMPTY : upper_right.y);
    vec4 row2 = vec4(first_x ? EMPTY : lower_left.w, lower_left.z, lower_right.w, last_x ? EMPTY : lower_right.z);
    vec2 row3 = last_y ? vec2(EMPTY) : vec2(lower_left.y, lower_right.x);
    vec4 z = vec4(row1.yz, row2.yz);
    vec4 left = vec4(row1.xy, row2.xy);
    vec4 right = vec4(row1.zw, row2.zw);
    vec4 up = vec4(row0, row1.yz);
    vec4 down = vec4(row2.yz, row3);
    // The texels at the image's edge, which will replace those beyond it, have no neighbour on that side.
    if (base.x < 0) { left.yw = vec2(EMPTY); }
    if (base.x >= last.x) { right.xz = vec2(EMPTY); }
    if (base.y < 0) { up.zw = vec2(EMPTY); }
    if (base.y >= last.y) { down.xy = vec2(EMPTY); }
    bvec4 whole = bvec4(true);
    vec4 dx = differences(left, z, right, threshold, whole);
    vec4 dy = differences(up, z, down, threshold, whole);
    vec4 trust = mix(vec4(RIM), vec4(1.0), whole);
    // Texels beyond the image's edge repeat it.
    if (base.x < 0) { z.xz = z.yw; dx.xz = dx.yw; dy.xz = dy.yw; trust.xz = trust.yw; }
    if (base.x >= last.x) { z.yw = z.xz; dx.yw = dx.xz; dy.yw = dy.xz; trust.yw = trust.xz; }
    if (base.y < 0) { z.xy = z.zw; dx.xy = dx.zw; dy.xy = dy.zw; trust.xy = trust.zw; }
    if (base.y >= last.y) { z.zw = z.xy; dx.zw = dx.xy; dy.zw = dy.xy; trust.zw = trust.xy; }

    vec4 w = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    // The depths of the two texels above or below the four around the pixel, and of the two to the left or right of
    // the four, in each case on the side that the pixel is nearer to.
    bvec2 after = greaterThan(f, vec2(0.5));
    vec4 beside = vec4(after.y ? row3 : row0, after.x ? vec2(row1.w, row2.w) : vec2(row1.x, row2.x));
    bvec4 outside = bvec4(base.x < 0, base.x >= last.x, base.y < 0, base.y >= last.y);
    bool behind = front < 0.0;
    vec4 past = mix(z, vec4(EMPTY), lessThan(z, vec4(-front)));
    float next_past = min(min(past.x, past.y), min(past.z, past.w));
    past = mix(beside, vec4(EMPTY), lessThan(beside, vec4(-front)));
    past = mix(past, vec4(EMPTY), outside);
    next_past = next_past < EMPTY ? next_past : min(min(past.x, past.y), min(past.z, past.w));
    front = behind ? next_past : front;
    vec4 off = abs(z - front);
    vec4 own = w * vec4(lessThanEqual(off, vec4(threshold)));
    float sum = own.x + own.y + own.z + own.w;
    bool lost = sum == 0.0;
    s.widened = any(lessThan(z, vec4(front - threshold)));
    s.found = dot(own, vec4(whole));
    s.covered = front < EMPTY ? sum : 0.0;
    if (lost) {
        // At full resolution the pixel is one of the four texels, and the other three have weight 0: these are
        // excluded from the search for the texel nearest in depth.
        off = mix(off, vec4(2.0 * EMPTY), equal(w, vec4(0.0)));
        float least = min(min(off.x, off.y), min(off.z, off.w));
        own = off.x == least ? vec4(1, 0, 0, 0) : off.y == least ? vec4(0, 1, 0, 0)
          : off.z == least ? vec4(0, 0, 1, 0) : vec4(0, 0, 0, 1);
        sum = 1.0;
    }
    s.weights = own / sum;
    s.z = lost ? front : dot(s.weights, z);
    vec4 slopes = s.weights * trust;
    float trusted = slopes.x + slopes.y + slopes.z + slopes.w;
    // The texel size is a power of two, so this does not round.
    s.dz = lost ? vec2(0.0) : vec2(dot(slopes, dx), dot(slopes, dy)) / (trusted * level.texel.z);
    vec2 steepest = frame.texel.xy * s.z * RIM_SLOPE;
    // The condition means that complete texels have more than 1/63 of the weight.
    s.dz = trusted > 2.0 * RIM ? s.dz : clamp(s.dz, -steepest, steepest);

    vec4 miss = mix(abs(beside - front), vec4(2.0 * EMPTY), outside);
    float least = min(min(miss.x, miss.y), min(miss.z, miss.w));
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool found = lost && least <= threshold && level.texel.z > 1.0;
    while (found) {
        ivec2 next = mix(ivec2(-1), ivec2(2), after);
        s.base = base + (miss.x == least ? ivec2(0, next.y) : miss.y == least ? ivec2(1, next.y)
                       : miss.z == least ? ivec2(next.x, 0) : ivec2(next.x, 1));
        s.weights = vec4(1, 0, 0, 0);
        vec2 low = vec2(smoothed_at(level, s.base - ivec2(1, 0)), smoothed_at(level, s.base - ivec2(0, 1)));
        vec2 high = vec2(smoothed_at(level, s.base + ivec2(1, 0)), smoothed_at(level, s.base + ivec2(0, 1)));
        bvec4 sides = bvec4(true);
        vec4 middle = vec4(smoothed_at(level, s.base));
        vec2 dz = differences(low.xyxy, middle, high.xyxy, threshold, sides).xy / level.texel.z;
        s.dz = sides.x && sides.y ? dz : clamp(dz, -steepest, steepest);
        behind = behind && front < EMPTY;
        s.covered = behind ? 1.0 : s.covered;
        s.found = behind && sides.x && sides.y ? 1.0 : s.found;
        found = false;
    }
    return s;
}

// Eye-space vectors of the surface from a pixel to the next.
void surface_tangents(Surface s, vec2 slope, out vec3 px, out vec3 py) {
    vec2 slope_step = frame.slope.xy;
    px = vec3(slope_step.x * s.z + slope.x * s.dz.x, slope.y * s.dz.x, -s.dz.x);
    py = vec3(slope.x * s.dz.y, slope_step.y * s.z + slope.y * s.dz.y, -s.dz.y);
}

// Position and normal (towards the eye) in eye space.
void surface_frame(Surface s, vec2 slope, out vec3 position, out vec3 normal) {
    position = vec3(slope, -1.0) * s.z;
    vec3 px;
    vec3 py;
    surface_tangents(s, slope, px, py);
    normal = normalize(cross(px, py));
    normal = dot(normal, position) > 0.0 ? -normal : normal;
}
