// A blob on the ray of a pixel. Needs frame.glsl, bubbles.glsl, blob.glsl.

// Transmittance below which the light behind does not matter.
const float HIDDEN = 1.0 / 256.0;

// No layer. A layer names what a ray meets: the number of a blob, and of a bubble in this blob (low 8 bits).
const uint NO_LAYER = 0xffffffffu;

uint layer_of(uint blob, uint bubble) {
    return blob << 8 | (bubble & 0xffu);
}

// A ray with unit direction in the blob's space.
struct BlobRay {
    vec3 origin;
    vec3 direction;
    float scale;    // eye depth per length along the ray
    vec2 span;      // the part in the bounding ball, not before the near plane
};

// A pixel's ray along the world's axes.
struct WorldRay {
    vec3 direction; // unit vector
    float scale;    // eye depth per length along the ray
};

WorldRay world_ray(vec2 slope) {
    vec3 along = mat3(frame.world) * vec3(slope, -1.0);
    float inverse = inversesqrt(dot(along, along));
    return WorldRay(along * inverse, inverse);
}

// Whether the ray meets a blob's bounding ball; `span` is the part of the ray in the ball, not before the near plane.
bool in_blob(Blob blob, WorldRay ray, out vec2 span) {
    bool meets = ball_hits(vec3(0.0), ray.direction, blob.ball, span);
    span.x = max(span.x, frame.depth.z / ray.scale);
    return meets && span.y > span.x;
}

BlobRay blob_ray(Blob blob, WorldRay ray, vec2 span) {
    float inverse = 1.0 / blob.ball.w;
    return BlobRay(turned(blob.turn, -blob.ball.xyz) * inverse, turned(blob.turn, ray.direction),
                   blob.ball.w * ray.scale, span * inverse);
}

// Returns the opacity of the blob's core, the foam behind its outer bubbles (Sec. 4.4). `past` is the point, in the
// blob's space, where the ray leaves the bubble that it hit.
float core_opacity(vec3 past) {
    return 1.0 - smoothstep(bubbly.core.x, bubbly.core.y, length(past));
}

// What a pixel shows of a blob.
struct Seen {
    float depth;   // EMPTY: nothing
    float opacity; // of the core
    uint id;       // of the bubble
};

Seen blob_seen(Blob blob, WorldRay world) {
    Seen seen = Seen(EMPTY, 0.0, NO_BUBBLE);
    vec2 span;
    bool meets = in_blob(blob, world, span);
    // Loops with one iteration instead of branches, for CPU drivers (docs/performance.md).
    while (meets) {
        BlobRay ray = blob_ray(blob, world, span);
        BlobHit hit = blob_hit(blob.template_, ray.origin, ray.direction, ray.span);
        bool met = hit.t >= 0.0;
        seen.depth = met ? hit.t * ray.scale : EMPTY;
        seen.opacity = met ? core_opacity(ray.origin + hit.past * ray.direction) : 0.0;
        seen.id = hit.id;
        meets = false;
    }
    return seen;
}

// Corrects an approximate hit, a `layer` (blob and bubble) at `depth`: returns the layer with the bubble of this blob
// that the pixel's ray `world` hits, and sets `depth` to that bubble's exact depth.
uint exact_layer(Blob blob, WorldRay world, uint layer, inout float depth) {
    vec2 span;
    in_blob(blob, world, span);
    BlobRay ray = blob_ray(blob, world, span);
    BlobHit hit = BlobHit(depth / ray.scale, 0.0, layer & 0xffu);
    hit = among_neighbours(blob.template_, ray.origin, ray.direction, hit, ray.span.x);
    depth = hit.t * ray.scale;
    return layer_of(layer >> 8, hit.id);
}
