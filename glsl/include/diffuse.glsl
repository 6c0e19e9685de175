// What a diffuse particle is on the screen, for every way to draw it (Akinci et al. 2013, Sec. 2.1 and 2.2): a disc
// that faces the eye with the depth of a sphere. Small ones are widened to where no pixel's middle can miss them, and
// their light is kept exactly: what all pixels get together does not depend on where between them the particle
// lies, so that far foam does not sparkle. Not in the source.
// Needs frame.glsl, falloff.glsl.

const uint FOAM = 0u;
const uint SPRAY = 1u;
const uint BUBBLE = 2u;

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
    p.kind = kind;
    // Between a fifth and the whole, so that they look irregular.
    p.radius = (radius > 0.0 && radius < EMPTY ? radius : frame.diffuse.x) / float(id % 5u + 1u) * (kind == BUBBLE ? 0.5 : 1.0);
    bool drawn = age < 1.0 && -p.centre.z > frame.depth.z && -p.centre.z < EMPTY
        && all(lessThan(abs(p.centre.xy), vec2(EMPTY)));
    p.life = drawn ? falloff(max(age, 0.0), 1.0, 2.0, 0.4) : 0.0;
    return p;
}

// By the distance from the middle, 0 to 1 (Fig. 5).
float diffuse_shape(uint kind, float x) {
    float power = kind == SPRAY ? 1.5 : kind == BUBBLE ? 2.0 : 2.25;
    float rest = 1.0 - pow(max(x, 1.0e-20), power);
    return kind == BUBBLE ? 1.0 - rest : rest;
}

// Its mean over the disc.
float diffuse_mean(uint kind) {
    return kind == SPRAY ? 1.0 - 2.0 / 3.5 : kind == BUBBLE ? 0.5 : 1.0 - 2.0 / 4.25;
}

// Least half-axis in pixels: over half a pixel's diagonal.
const float LEAST_REACH = 0.75;

// How much of a particle so many pixels wide is told by its shape.
float told_of(float pixels) {
    return smoothstep(1.0, 2.0, pixels);
}

struct Footprint {
    vec2 middle; // in pixels
    vec2 reach;  // half-axes in pixels
    ivec4 box;   // pixels whose middles may lie in it, also beside the frame
    float own;   // part of it that is its own shape; the rest is q = 1 - rr
    float even;  // what q is multiplied by
};

// Square of the distance from the middle to that of a pixel, 0 to 1; its place in the disc, along the eye's axes.
float diffuse_place(Footprint f, ivec2 pixel, out vec2 place) {
    place = (vec2(pixel) + 0.5 - f.middle) / f.reach;
    place *= sign(frame.slope.xy);
    return dot(place, place);
}

// Of a kind, whose disc has a middle and half-axes in pixels.
Footprint footprint_at(vec2 middle, vec2 reach, uint kind) {
    Footprint f;
    f.reach = reach * max(1.0, LEAST_REACH / min(reach.x, reach.y));
    f.middle = clamp(middle, vec2(-1.0e6), vec2(1.0e6));
    vec2 room = min(f.reach, vec2(1.0e6));
    f.box = ivec4(ceil(f.middle - room - 0.5), floor(f.middle + room - 0.5));
    f.own = told_of(min(f.reach.x, f.reach.y));
    f.even = 0.0;
    if (f.own < 1.0) {
        float sum = 0.0;
        vec2 place;
        for (int y = f.box.y; y <= f.box.w; ++y) {
            for (int x = f.box.x; x <= f.box.z; ++x) {
                sum += max(1.0 - diffuse_place(f, ivec2(x, y), place), 0.0);
            }
        }
        float energy = 3.14159265 * reach.x * reach.y * diffuse_mean(kind);
        f.even = (1.0 - f.own) * energy / max(sum, 1.0e-6);
    }
    return f;
}

Footprint footprint_of(Diffuse p) {
    float depth = -p.centre.z;
    vec2 middle = (p.centre.xy / depth - frame.slope.zw) / frame.slope.xy;
    return footprint_at(middle, p.radius / (depth * frame.texel.xy), p.kind);
}

// What a pixel gets of its thickness, at such a square of the distance.
float diffuse_amount(Diffuse p, Footprint f, float rr) {
    return p.life * (f.even * (1.0 - rr) + f.own * diffuse_shape(p.kind, sqrt(rr)));
}

// Where that goes: before the fluid's surface, behind it, and that by how far. Depths along z.
vec3 diffuse_shares(float amount, float depth, float fluid) {
    float behind = fluid < EMPTY ? depth - fluid : 0.0;
    // The source's falloff, where no water of ours takes the light.
    if (frame.diffuse.w > 0.0) {
        return vec3(amount * falloff(behind, frame.diffuse_below.x, frame.diffuse_below.y, frame.diffuse_below.z), 0.0, 0.0);
    }
    float spacing = frame.particle.y;
    float under = amount * smoothstep(0.0, spacing, behind);
    float far = max(behind, 0.0);
    return vec3(amount - under, under, under * far / (far + spacing));
}
