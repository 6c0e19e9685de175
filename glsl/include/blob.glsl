// Intersection of a ray with a blob, a ball of soap bubbles (Huszar, Szecsi, Sec. 4.2, 4.3). All is in the blob's
// space, in which its bounding ball is the unit ball.
// Needs cube.glsl. Reads: bubbles, their neighbours, distances, ids.

// 0: by the distance impostor, 1: by bubble ids.
layout(constant_id = 30) const uint BY_ID = 1;
// Steps of the search along a ray.
layout(constant_id = 31) const uint STEPS = 10;
// Number of bubbles per blob.
layout(constant_id = 32) const uint BUBBLES = 227;
// Edge of a face of the id map, in texels.
layout(constant_id = 33) const uint ID_EDGE = 128;

layout(set = 0, binding = 8, std430) readonly buffer Bubbles { vec4 bubbles[]; };
layout(set = 0, binding = 9) uniform sampler2DArray blob_distances;
// Four texels per word.
layout(set = 0, binding = 10, std430) readonly buffer BlobIds { uint blob_ids[]; };
// For each bubble, the indices of sixteen bubbles that it intersects, a byte each. If there are fewer, its own index
// fills the rest.
layout(set = 0, binding = 13, std430) readonly buffer Neighbours { uvec4 neighbours[]; };

const uint NO_BUBBLE = 0xffffffffu;

// Intersects a ray with unit direction with a ball. `hits`: distances along the ray; false if it misses.
bool ball_hits(vec3 origin, vec3 direction, vec4 ball, out vec2 hits) {
    vec3 to = ball.xyz - origin;
    float along = dot(to, direction);
    vec3 off = to - along * direction;
    float left = ball.w * ball.w - dot(off, off);
    float reach = sqrt(max(left, 0.0));
    hits = vec2(along - reach, along + reach);
    return left >= 0.0;
}

uint bubble_at(uint template_, vec3 direction) {
    uvec3 texel = uvec3(cube_texel(direction, int(ID_EDGE)));
    uint at = ((texel.z + 6u * template_) * ID_EDGE + texel.y) * ID_EDGE + texel.x;
    return blob_ids[at >> 2] >> (8u * (at & 3u)) & 0xffu;
}

vec4 bubble_of(uint template_, uint id) {
    return bubbles[template_ * BUBBLES + id];
}

// Mean radius of the bubbles of a generated blob (blob.rs), in radii of its bounding ball. The bubbles' centres lie
// on a shell, of which each bubble takes the area of a hexagon, and the bounding ball also contains the part of the
// bubbles outside this shell.
float mean_radius() {
    return 1.0 / (0.2625 * sqrt(float(BUBBLES)) + 1.45);
}

// Distance of the blob's surface from its centre in a direction, interpolated within a face of the cube map. Between
// a face's outermost texel centres and its edge the value of the outermost texels is used.
float distance_at(uint template_, vec3 direction) {
    int size = textureSize(blob_distances, 0).x;
    vec3 place = cube_place(direction);
    vec2 at = clamp(place.xy * float(size) - 0.5, 0.0, float(size) - 1.0);
    ivec2 base = ivec2(min(at, float(size) - 2.0));
    vec2 f = at - vec2(base);
    int layer = int(place.z) + 6 * int(template_);
    vec4 d;
    for (int i = 0; i < 4; ++i) {
        d[i] = texelFetch(blob_distances, ivec3(base + ivec2(i & 1, i >> 1), layer), 0).x;
    }
    vec2 rows = mix(d.xz, d.yw, f.x);
    return mix(rows.x, rows.y, f.y);
}

// First hit of a ray with a blob.
struct BlobHit {
    float t;    // less than 0: no hit
    float past; // where the ray leaves that bubble
    uint id;    // of the bubble; NO_BUBBLE if not known
};

// Intersection by the map of bubble ids. For each of several points along the ray, the map gives the bubble that is
// visible from outside in the point's direction from the blob's centre, and the ray is tested against this bubble.
// The nearest hit is kept; the search ends when the points have passed it.
BlobHit blob_by_ids(uint template_, vec3 origin, vec3 direction, vec2 span) {
    BlobHit hit = BlobHit(-1.0, -1.0, NO_BUBBLE);
    float step = (span.y - span.x) / float(STEPS);
    uint last = NO_BUBBLE;
    uint i = 0u;
    // This loop tests its condition at the top. If a loop tests it at the end, one driver gives all lanes of a
    // subgroup the values of the iteration in which the last lane ends.
    bool more = true;
    while (more) {
        float t = span.x + (float(i) + 0.5) * step;
        uint id = bubble_at(template_, origin + t * direction);
        vec2 hits;
        bool met = id != last && ball_hits(origin, direction, bubble_of(template_, id), hits);
        if (met && hits.y > 0.0 && (hit.t < 0.0 || hits.x < hit.t)) {
            hit = BlobHit(max(hits.x, 0.0), hits.y, id);
        }
        last = id;
        ++i;
        more = i < STEPS && (hit.t < 0.0 || span.x + float(i) * step < hit.t);
    }
    return hit;
}

uvec4 neighbours_of(uint template_, uint id) {
    return neighbours[template_ * BUBBLES + id];
}

// Tests the neighbours of the bubble that was hit, and returns the nearest hit among them. The map of ids locates the
// edge between two bubbles only to a texel, so the ray may hit a neighbour first.
BlobHit among_neighbours(uint template_, vec3 origin, vec3 direction, BlobHit hit, float from) {
    BlobHit best = hit;
    uvec4 words = neighbours_of(template_, hit.id);
    uint i = 0u;
    do {
        uint id = words.x & 0xffu;
        vec2 hits;
        bool met = ball_hits(origin, direction, bubble_of(template_, id), hits) && hits.y > from;
        float t = max(hits.x, from);
        best = met && t < best.t ? BlobHit(t, hits.y, id) : best;
        ++i;
        words = (i & 3u) == 0u ? words.yzwx : uvec4(words.x >> 8, words.yzw);
    } while (i < 16u);
    return best;
}

// Intersection by the map of distances: the first point where the ray enters the blob's surface. The search takes
// uniform steps from the near side to a little beyond the ray's point nearest to the centre. When a step ends inside,
// regula falsi (Illinois variant) refines between this step and the one before. The paper instead reverses the ray,
// so that its search (Szirmay-Kalos et al. 2005) ends on the near side.
BlobHit blob_by_distance(uint template_, vec3 origin, vec3 direction, vec2 span) {
    const uint COARSE = 8u;
    float middle = clamp(-dot(origin, direction), span.x, span.y);
    float from = span.x;
    vec3 p = origin + from * direction;
    float outside = length(p) - distance_at(template_, p);
    float inside = outside;
    float to = from;
    uint i = 0u;
    do {
        ++i;
        // A little beyond the centre, for rays that only graze the blob.
        to = mix(span.x, 0.5 * (middle + span.y) , float(i) / float(COARSE));
        p = origin + to * direction;
        inside = length(p) - distance_at(template_, p);
        from = inside > 0.0 ? to : from;
        outside = inside > 0.0 ? inside : outside;
    } while (i < COARSE && inside > 0.0);
    BlobHit hit = BlobHit(-1.0, -1.0, NO_BUBBLE);
    if (inside > 0.0) {
        return hit;
    }
    if (outside > 0.0) {
        bool was = false;
        bool again = false;
        do {
            float at = mix(from, to, clamp(outside / (outside - inside), 0.02, 0.98));
            p = origin + at * direction;
            float here = length(p) - distance_at(template_, p);
            bool still = here > 0.0;
            again = i > COARSE && still == was;
            was = still;
            from = still ? at : from;
            to = still ? to : at;
            // An end that stays twice is weighted by half (Illinois).
            outside = still ? here : (again ? 0.5 * outside : outside);
            inside = still ? (again ? 0.5 * inside : inside) : here;
            ++i;
        } while (i < max(STEPS, COARSE + 1u));
    }
    hit.t = max(0.5 * (from + to), 0.0);
    // The exit lies behind the hit by the mean chord of a bubble of mean size, because the bubble is not known.
    hit.past = hit.t + 4.0 / 3.0 * mean_radius();
    return hit;
}

BlobHit blob_hit(uint template_, vec3 origin, vec3 direction, vec2 span) {
    return BY_ID == 1u ? blob_by_ids(template_, origin, direction, span)
                       : blob_by_distance(template_, origin, direction, span);
}
