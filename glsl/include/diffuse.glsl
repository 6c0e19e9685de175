// Screen footprint of a whitewater particle, for every path (Akinci et al. 2013, Sec. 2.1 and 2.2): a disc that faces
// the camera, with the depth of a sphere. Not in the paper: small ones are widened until no pixel centre can miss
// them, with their total light preserved exactly at any sub-pixel position, so that far foam does not sparkle.
// Needs frame.glsl, falloff.glsl.

const uint FOAM = 0u;
const uint SPRAY = 1u;
const uint BUBBLE = 2u;

// 0: shapes, lives and sizes are the source's, and its falloff below the surface is not asked for. A CPU goes through what
// a branch passes over.
layout(constant_id = 3) const uint SHAPED = 1;

// What is left of its light at an age (Eq. 1 with b = 1; the source: n = 2, m = 0.4).
float life_of(float age) {
    float x = max(age, 0.0);
    if (SHAPED == 1u) {
        return falloff(x, 1.0, frame.diffuse_life.x, frame.diffuse_life.y);
    }
    return x < 1.0 ? pow(1.0 - x * x, 0.4) : 0.0;
}

struct Diffuse {
    vec3 centre;  // eye space
    float radius;
    uint kind;
    float life;   // 1 to 0 with its age; 0 is not drawn
};

// Of a particle with such attributes; a radius that is none is the default one.
Diffuse diffuse_of(vec3 position, uint kind, float radius, float age, uint id) {
    Diffuse p;
    p.centre = (frame.view * vec4(position, 1.0)).xyz;
    // NaN and infinity reach no footprint: what is not finite lies behind the eye, and is drawn by none.
    p.centre = all(lessThan(abs(p.centre), vec3(EMPTY))) ? p.centre : vec3(0.0, 0.0, EMPTY);
    p.kind = kind;
    // The source: between a fifth and the whole, so that they look irregular, and of bubbles half of it.
    uint size = (SHAPED == 1u ? id % uint(frame.diffuse_life.z) : id % 5u) + 1u;
    float bubble = SHAPED == 1u ? frame.diffuse_life.w : 0.5;
    p.radius = (radius > 0.0 && radius < EMPTY ? radius : frame.diffuse.x) / float(size) * (kind == BUBBLE ? bubble : 1.0);
    bool drawn = age < 1.0 && -p.centre.z > frame.depth.z;
    p.life = drawn ? life_of(age) : 0.0;
    return p;
}

// The numbers of a kind.
vec4 shape_of(uint kind) {
    return frame.diffuse_shapes[kind == SPRAY ? 1 : kind == BUBBLE ? 2 : 0];
}

// By the square of the distance from the middle, 0 to 1 (Fig. 5). The source: 1 - x^1.5, x^2 or 1 - x^2.25, by roots, which
// cost less than a power.
float diffuse_shape(uint kind, float rr) {
    if (SHAPED == 1u) {
        vec4 shape = shape_of(kind);
        float part = falloff(sqrt(rr), 1.0, shape.x, shape.y);
        return kind == BUBBLE ? 1.0 - part : part;
    }
    float root = sqrt(rr);
    float fourth = sqrt(root);
    return kind == BUBBLE ? rr : 1.0 - (kind == SPRAY ? root * fourth : rr * sqrt(fourth));
}

// Its mean over the disc.
float diffuse_mean(uint kind) {
    if (SHAPED == 1u) {
        return shape_of(kind).z;
    }
    return kind == SPRAY ? 1.0 - 2.0 / 3.5 : kind == BUBBLE ? 0.5 : 1.0 - 2.0 / 4.25;
}

// Least half-axis in pixels: over half a pixel's diagonal.
const float LEAST_REACH = 0.75;

// How much of a particle so many pixels wide is told by its shape.
float told_of(float pixels) {
    return smoothstep(1.0, 2.0, pixels);
}

struct Footprint {
    vec2 middle;  // in pixels
    vec2 scale;   // 1 over its half-axes in pixels, along the eye's axes
    ivec4 box;    // pixels whose middles may lie in it, also beside the frame
    uint covered; // a bit for each of four by four pixels from the box's first on: which do; of a larger one 0
    float own;    // part of it that is its own shape; the rest is q = 1 - rr
    float even;   // what q is multiplied by
};

// Pixels of a side of a box that `covered` tells of.
const int COVERED = 4;
const vec4 MIDDLES = vec4(0.5, 1.5, 2.5, 3.5);

// Blocks of so many by so many pixels that a footprint is summed over at most. Only one that is under two pixels high or
// wide has more than one: a row or two, of pixels that are far from square.
const int MOST_BLOCKS = 8192;

bool is_small(ivec4 box) {
    return all(lessThan(box.zw - box.xy, ivec2(COVERED)));
}

// Square of the distance from the middle to that of a pixel, 0 to 1; its place in the disc, along the eye's axes.
float diffuse_place(Footprint f, ivec2 pixel, out vec2 place) {
    place = (vec2(pixel) + 0.5 - f.middle) * f.scale;
    return dot(place, place);
}

uvec4 bits_of(bvec4 which, uint first) {
    return mix(uvec4(0u), uvec4(1u, 2u, 4u, 8u) << first, which);
}

// Of a kind, whose disc has a middle and half-axes in pixels.
Footprint footprint_at(vec2 middle, vec2 reach, uint kind) {
    Footprint f;
    reach = max(reach, vec2(1.0e-12)); // of the tiniest, far off, nothing is left
    vec2 wide = reach * max(1.0, LEAST_REACH / min(reach.x, reach.y));
    f.middle = clamp(middle, vec2(-1.0e6), vec2(1.0e6));
    f.scale = sign(frame.slope.xy) / wide;
    vec2 room = min(wide, vec2(1.0e6));
    f.box = ivec4(ceil(f.middle - room - 0.5), floor(f.middle + room - 0.5));
    f.own = told_of(min(wide.x, wide.y));
    f.covered = 0u;
    bool small = is_small(f.box);
    // Counted beforehand: a loop up to the box's end has none for some bits.
    ivec2 blocks = clamp(f.box.zw - f.box.xy, ivec2(0), ivec2(COVERED * MOST_BLOCKS - 1)) / COVERED + 1;
    int left = small ? 1 : f.own < 1.0 ? min(blocks.x * blocks.y, MOST_BLOCKS) : 0;
    float sum = 0.0;
    for (ivec2 at = f.box.xy; left > 0; --left) {
        vec4 x = (vec4(at.x) + MIDDLES - f.middle.x) * f.scale.x;
        vec4 y = (vec4(at.y) + MIDDLES - f.middle.y) * f.scale.y;
        vec4 rest = 1.0 - x * x;
        y *= y;
        vec4 a = rest - y.x, b = rest - y.y, c = rest - y.z, d = rest - y.w;
        sum += dot(max(a, 0.0) + max(b, 0.0) + max(c, 0.0) + max(d, 0.0), vec4(1.0));
        uvec4 rows = bits_of(greaterThan(a, vec4(0.0)), 0u) | bits_of(greaterThan(b, vec4(0.0)), 4u)
            | bits_of(greaterThan(c, vec4(0.0)), 8u) | bits_of(greaterThan(d, vec4(0.0)), 12u);
        f.covered = small ? rows.x | rows.y | rows.z | rows.w : 0u;
        at.x += COVERED;
        bool last = at.x > f.box.z;
        at = last ? ivec2(f.box.x, at.y + COVERED) : at;
    }
    float energy = 3.14159265 * reach.x * reach.y * diffuse_mean(kind);
    f.even = f.own < 1.0 ? (1.0 - f.own) * energy / max(sum, 1.0e-6) : 0.0;
    return f;
}

Footprint footprint_of(Diffuse p) {
    float depth = -p.centre.z;
    vec2 middle = (p.centre.xy / depth - frame.slope.zw) / frame.slope.xy;
    return footprint_at(middle, p.radius / (depth * frame.texel.xy), p.kind);
}

// What a pixel gets of its thickness, at such a square of the distance.
float diffuse_amount(Diffuse p, Footprint f, float rr) {
    return p.life * (f.even * (1.0 - rr) + f.own * diffuse_shape(p.kind, rr));
}

// Where that goes: before the fluid's surface, behind it, and that by how far. Depths along z.
vec3 diffuse_shares(float amount, float depth, float fluid) {
    float behind = fluid < EMPTY ? depth - fluid : 0.0;
    // The source's falloff, where no water of ours takes the light.
    if (SHAPED == 1u && frame.diffuse.w > 0.0) {
        return vec3(amount * falloff(behind, frame.diffuse_below.x, frame.diffuse_below.y, frame.diffuse_below.z), 0.0, 0.0);
    }
    float spacing = frame.particle.y;
    float far = max(behind, 0.0);
    // smoothstep, with a division that is the same in all pixels.
    float t = min(far * (1.0 / spacing), 1.0);
    float under = amount * t * t * (3.0 - 2.0 * t);
    return vec3(amount - under, under, under * far / (far + spacing));
}
