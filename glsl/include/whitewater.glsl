// Screen footprint of a whitewater particle (spray, foam or bubble), for every path (Akinci et al. 2013, Sec. 2.1 and
// 2.2): a disc that faces the camera, with the depth of a sphere. Not in the paper: small discs are widened so that
// they always cover a pixel centre. Their total light is preserved exactly at any sub-pixel position, so that far
// foam does not sparkle. Needs frame.glsl, falloff.glsl.

const uint FOAM = 0u;
const uint SPRAY = 1u;
const uint BUBBLE = 2u;

// 1: shapes, lifetimes and sizes of whitewater particles, and the paper's falloff below the water surface, follow the
// settings in `frame`. 0: shapes, lifetimes and sizes are the paper's, and that falloff is off. It is a
// specialization constant because a CPU driver runs both sides of a branch.
layout(constant_id = 3) const uint SHAPED = 1;

// Fraction of its light that a whitewater particle still has at an age in lifetimes (1: its end): the falloff of Eq.
// 1, (1 - age^n)^m, with n = 2 and m = 0.4 in the paper.
float life_of(float age) {
    float x = max(age, 0.0);
    if (SHAPED == 1u) {
        return falloff(x, 1.0, frame.whitewater_life.x, frame.whitewater_life.y);
    }
    return x < 1.0 ? pow(1.0 - x * x, 0.4) : 0.0;
}

struct Whitewater {
    vec3 centre;  // eye space
    float radius;
    uint kind;
    float life;   // 1 to 0 with the age; 0 is not drawn
};

// Makes a whitewater particle from its attributes: world position, kind, radius, age in lifetimes, and id. A radius
// that is 0, negative or not finite is replaced by the default radius.
Whitewater whitewater_of(vec3 position, uint kind, float radius, float age, uint id) {
    Whitewater p;
    p.centre = (frame.view * vec4(position, 1.0)).xyz;
    // A particle whose centre is not finite is moved behind the eye, where neither the compute nor the raster path
    // draws it.
    p.centre = all(lessThan(abs(p.centre), vec3(EMPTY))) ? p.centre : vec3(0.0, 0.0, EMPTY);
    p.kind = kind;
    // For an irregular look the radius is divided by id mod n + 1, in the paper with n = 5, so by 1 to 5. Radii of
    // bubbles are also multiplied by a factor, in the paper by 0.5.
    uint size = (SHAPED == 1u ? id % uint(frame.whitewater_life.z) : id % 5u) + 1u;
    float bubble = SHAPED == 1u ? frame.whitewater_life.w : 0.5;
    p.radius = (radius > 0.0 && radius < EMPTY ? radius : frame.whitewater.x) / float(size) * (kind == BUBBLE ? bubble : 1.0);
    bool drawn = age < 1.0 && -p.centre.z > frame.depth.z;
    p.life = drawn ? life_of(age) : 0.0;
    return p;
}

// Parameters of a kind.
vec4 shape_of(uint kind) {
    return frame.whitewater_shapes[kind == SPRAY ? 1 : kind == BUBBLE ? 2 : 0];
}

// Thickness, 0 to 1, of a whitewater particle at a point of its disc (Fig. 5). `rr` is the square of the distance x
// from the centre in radii. The paper's profiles are 1 - x^1.5 for spray, x^2 for bubbles and 1 - x^2.25 for foam;
// here roots compute these powers, because they are faster than pow().
float whitewater_shape(uint kind, float rr) {
    if (SHAPED == 1u) {
        vec4 shape = shape_of(kind);
        float part = falloff(sqrt(rr), 1.0, shape.x, shape.y);
        return kind == BUBBLE ? 1.0 - part : part;
    }
    float root = sqrt(rr);
    float fourth = sqrt(root);
    return kind == BUBBLE ? rr : 1.0 - (kind == SPRAY ? root * fourth : rr * sqrt(fourth));
}

// Mean of the profile over the disc.
float whitewater_mean(uint kind) {
    if (SHAPED == 1u) {
        return shape_of(kind).z;
    }
    return kind == SPRAY ? 1.0 - 2.0 / 3.5 : kind == BUBBLE ? 0.5 : 1.0 - 2.0 / 4.25;
}

// Min half-axis in pixels: more than half a pixel's diagonal.
const float LEAST_REACH = 0.75;

// Weight of a particle's own profile, by its radius in pixels.
float told_of(float pixels) {
    return smoothstep(1.0, 2.0, pixels);
}

struct Footprint {
    vec2 middle;  // in pixels
    vec2 scale;   // 1 / half-axes in pixels, along the eye's axes
    ivec4 box;    // pixels whose centres may lie in it, also outside the frame
    uint covered; // of 4x4 pixels from the box's first on, a bit for each that it covers; 0 for a larger box
    float own;    // weight of its own profile; the rest is q = 1 - rr
    float even;   // factor of q
};

// Largest side in pixels of a box that `covered` describes.
const int COVERED = 4;
const vec4 MIDDLES = vec4(0.5, 1.5, 2.5, 3.5);

// Max number of blocks of 4x4 pixels in which the weights of a footprint's pixels are summed, to normalise its light.
// The sum is needed only if the shorter half-axis is less than two pixels, so there are many blocks only where pixels
// are far from square: then they form a row or two.
const int MOST_BLOCKS = 8192;

bool is_small(ivec4 box) {
    return all(lessThan(box.zw - box.xy, ivec2(COVERED)));
}

// Squared distance of a pixel's centre from the middle of a particle's disc, in units in which the rim is at 1.
// `place` returns the position of the pixel's centre in the disc in these units, along the eye's x and y axes.
float whitewater_place(Footprint f, ivec2 pixel, out vec2 place) {
    place = (vec2(pixel) + 0.5 - f.middle) * f.scale;
    return dot(place, place);
}

uvec4 bits_of(bvec4 which, uint first) {
    return mix(uvec4(0u), uvec4(1u, 2u, 4u, 8u) << first, which);
}

// The footprint of a disc with this centre and half-axes in pixels.
Footprint footprint_at(vec2 middle, vec2 reach, uint kind) {
    Footprint f;
    reach = max(reach, vec2(1.0e-12)); // far away, nothing is left of the tiniest
    vec2 wide = reach * max(1.0, LEAST_REACH / min(reach.x, reach.y));
    f.middle = clamp(middle, vec2(-1.0e6), vec2(1.0e6));
    f.scale = sign(frame.slope.xy) / wide;
    vec2 room = min(wide, vec2(1.0e6));
    f.box = ivec4(ceil(f.middle - room - 0.5), floor(f.middle + room - 0.5));
    f.own = told_of(min(wide.x, wide.y));
    f.covered = 0u;
    bool small = is_small(f.box);
    // The loop counts down a number of blocks of 4x4 pixels that is computed before it and is bounded; a loop whose
    // condition is the end of the box would not end for some values of the box.
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
    float energy = 3.14159265 * reach.x * reach.y * whitewater_mean(kind);
    f.even = f.own < 1.0 ? (1.0 - f.own) * energy / max(sum, 1.0e-6) : 0.0;
    return f;
}

Footprint footprint_of(Whitewater p) {
    float depth = -p.centre.z;
    vec2 middle = (p.centre.xy / depth - frame.slope.zw) / frame.slope.xy;
    return footprint_at(middle, p.radius / (depth * frame.texel.xy), p.kind);
}

// Thickness that a pixel gets, at this squared distance.
float whitewater_amount(Whitewater p, Footprint f, float rr) {
    return p.life * (f.even * (1.0 - rr) + f.own * whitewater_shape(p.kind, rr));
}

// Splits a particle's thickness by the fluid's surface; d is the particle's distance behind the surface along z. x:
// the part in front of the surface. y: the part behind it, which rises from 0 at d = 0 to all at d = spacing. z: y
// times d / (d + spacing). With the paper's falloff x is the attenuated thickness, y and z are 0.
vec3 whitewater_shares(float amount, float depth, float fluid) {
    float behind = fluid < EMPTY ? depth - fluid : 0.0;
    // The paper's falloff, used where our water does not absorb the light.
    if (SHAPED == 1u && frame.whitewater.w > 0.0) {
        return vec3(amount * falloff(behind, frame.whitewater_below.x, frame.whitewater_below.y, frame.whitewater_below.z), 0.0, 0.0);
    }
    float spacing = frame.particle.y;
    float far = max(behind, 0.0);
    // smoothstep with a division that is the same in all pixels.
    float t = min(far * (1.0 / spacing), 1.0);
    float under = amount * t * t * (3.0 - 2.0 * t);
    return vec3(amount - under, under, under * far / (far + spacing));
}
