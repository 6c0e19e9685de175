// Screen-space ray march against the scene's depth (McGuire and Mara 2014, "Efficient GPU Screen-Space Ray Tracing";
// not in the thesis). Unlike in that paper, each step multiplies the distance from the start by a constant factor: from
// a fraction of the picture's height after the first step to the point where the ray leaves the view. Bisection and a
// secant step then refine the hit. No parameter is an absolute length: steps are fractions of the picture, and the
// scene is assumed to be as thick as twice the ray's change of depth in a step plus a fraction of the scene's depth.
// Needs frame.glsl. Reads: scene depth (the includer's).

struct Met {
    vec2 at;     // pixels
    float share; // visible fraction: 0 for no hit, fading near the view's edge
};

// MARCH_FIRST is the length of the first step in heights of the picture, MARCH_FAR the max length of a ray in
// multiples of the eye depth at its start. A ray towards the eye ends after three quarters of the way to the eye's
// plane, or earlier.
const float MARCH_FIRST = 1.0 / 128.0;
const float MARCH_FAR = 64.0;
// A point of the ray hits the scene if it is behind the scene's visible front by at most this distance: the change of
// the ray's depth in the step times MARCH_STEEP, plus the scene's depth times MARCH_DEEP. This is tested with the
// whole step, and again with the short part of it that bisection leaves. If the ray only passes behind an object, its
// distance behind the front does not shrink with the step, so the second test rejects the hit.
const float MARCH_STEEP = 2.0;
const float MARCH_DEEP = 1.0 / 32.0;
// Bisections of the step that hits.
const int MARCH_HALVES = 6;
// Distance from the view's edge over which hits fade, in heights of the picture.
const float MARCH_FADE = 1.0 / 16.0;

// Eye depth of the scene at a pixel; EMPTY without a scene.
float met_depth(vec2 pixel) {
    float z = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    // A cleared depth lies at the far plane, up to rounding.
    return z > 0.0 && z < 0.9999 * frame.depth.w ? z : EMPTY;
}

// Projects an eye-space point: pixels, and 1/depth.
vec3 on_screen(vec3 eye) {
    return vec3((eye.xy / -eye.z - frame.slope.zw) / frame.slope.xy, -1.0 / eye.z);
}

// Most texels that `on_plane` moves a point.
const float MOST_MOVED = 4.0;

// Pixel at which a ray meets the scene near the point `b` of the ray. The scene's texel there is taken as part of a
// plane; with the texel's depth alone, results would jump from texel to texel. `a` is the ray's start. `a` and `b`
// hold pixels, and 1/depth, which is linear in the picture both along the ray and over the plane. On each axis the
// plane's slope is the smaller of the differences to the two neighbouring texels, so that no edge of an object tilts
// the plane.
vec2 on_plane(vec3 a, vec3 b) {
    vec2 size = 1.0 / frame.scene_depth.xy; // of a texel, pixels
    vec2 centre = (floor(b.xy / size) + 0.5) * size;
    float here = 1.0 / met_depth(centre);
    vec2 after = 1.0 / vec2(met_depth(centre + vec2(size.x, 0.0)), met_depth(centre + vec2(0.0, size.y))) - here;
    vec2 before = here - 1.0 / vec2(met_depth(centre - vec2(size.x, 0.0)), met_depth(centre - vec2(0.0, size.y)));
    vec2 rise = mix(before, after, lessThan(abs(after), abs(before))) / size;
    vec3 way = b - a;
    float gap = here + dot(rise, b.xy - centre) - b.z;
    float closes = way.z - dot(rise, way.xy);
    float most = MOST_MOVED * size.y * abs(closes);
    vec2 moved = way.xy * (gap * sign(closes));
    // The max avoids a division by 0: `closes` is 0 for a ray parallel to the plane.
    float far = length(moved);
    return b.xy + moved * (most < far ? MOST_MOVED * size.y / far : 1.0 / max(abs(closes), 1.0e-30));
}

// Marches from the eye-space point `from`, in front of the scene, along a unit vector; returns the pixel where the
// ray meets the scene, and share 0 if it does not. With 0 steps there is no hit.
Met march(vec3 from, vec3 along, int steps) {
    float reach = MARCH_FAR * -from.z;
    reach = min(reach, along.z > 0.0 ? 0.75 * -from.z / along.z : reach);
    vec3 a = on_screen(from);
    vec3 way = on_screen(from + along * reach) - a;
    // Clip the ray to the view.
    vec2 edge = mix(vec2(0.5), frame.extent.xy - 0.5, greaterThan(way.xy, vec2(-1.0e-6)));
    vec2 ends = (edge - a.xy) / mix(way.xy, vec2(1.0e-6), lessThan(abs(way.xy), vec2(1.0e-6)));
    float whole = clamp(min(ends.x, ends.y), 0.0, 1.0);
    float first = min(MARCH_FIRST * frame.extent.y / max(whole * length(way.xy), 1.0e-6), 1.0);
    float growth = exp2(-log2(first) / max(float(steps) - 1.0, 1.0));
    float low = 0.0;
    float before = -from.z;
    float low_gap = -1.0;
    float next = whole * first;
    float high = 0.0;
    float high_gap = 0.0;
    bool front = true;
    bool met = false;
    for (int i = 0; i < steps && !met; ++i) {
        vec3 p = a + way * next;
        float z = 1.0 / p.z;
        float scene = met_depth(p.xy);
        float gap = z - scene;
        met = front && gap > 0.0 && gap <= MARCH_STEEP * abs(z - before) + MARCH_DEEP * scene;
        high = next;
        high_gap = gap;
        front = gap <= 0.0;
        low = met ? low : next;
        low_gap = met ? low_gap : gap;
        before = z;
        next = min(next * growth, whole);
    }
    // The step in which the march hits the scene may be half of the picture wide. This loop bisects it; below, a
    // secant step follows.
    for (int i = 0; i < MARCH_HALVES && met; ++i) {
        float middle = 0.5 * (low + high);
        vec3 p = a + way * middle;
        float gap = 1.0 / p.z - met_depth(p.xy);
        bool behind = gap > 0.0;
        high = behind ? middle : high;
        high_gap = behind ? gap : high_gap;
        low = behind ? low : middle;
        low_gap = behind ? low_gap : gap;
    }
    float scene = 1.0 / (a.z + way.z * high) - high_gap;
    float deep = abs(1.0 / (a.z + way.z * high) - 1.0 / (a.z + way.z * low));
    met = met && high_gap <= MARCH_STEEP * deep + MARCH_DEEP * scene;
    // The secant needs a sampled point of the ray in front of the scene. If there is none (`low` is still 0), or if
    // the scene's depth is empty there, take the hit itself.
    float part = low > 0.0 && low_gap > -0.5 * EMPTY ? low_gap / (low_gap - high_gap) : 1.0;
    Met result;
    result.at = a.xy + way.xy * mix(low, high, part);
    vec2 inside = min(result.at, frame.extent.xy - result.at) / (MARCH_FADE * frame.extent.y);
    result.share = met ? clamp(min(inside.x, inside.y), 0.0, 1.0) : 0.0;
    return result;
}
