// A blob on the ray of a pixel. Needs frame.glsl, bubbles.glsl, blob.glsl.

// What of the light behind is too little to matter.
const float HIDDEN = 1.0 / 256.0;

// Number of a blob and of its bubble, for a later look; of none.
const uint NO_LAYER = 0xffffffffu;

uint layer_of(uint blob, uint bubble) {
    return blob << 8 | (bubble & 0xffu);
}

// A ray in the blob's space, of unit direction.
struct BlobRay {
    vec3 origin;
    vec3 direction;
    float scale;    // of a way along it to eye depth
    vec2 span;      // where it is in the bounding ball, not behind the near plane
};

// A pixel's ray along the world's axes.
struct WorldRay {
    vec3 direction; // unit
    float scale;    // of a way along it to eye depth
};

WorldRay world_ray(vec2 slope) {
    vec3 along = mat3(frame.world) * vec3(slope, -1.0);
    float inverse = inversesqrt(dot(along, along));
    return WorldRay(along * inverse, inverse);
}

// Where it is in a blob's bounding ball, not behind the near plane; false where it is not.
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

// How opaque the core is behind a point where the ray leaves its bubble (Sec. 4.4).
float core_opacity(vec3 past) {
    return 1.0 - smoothstep(bubbly.core.x, bubbly.core.y, length(past));
}

// What a pixel sees of a blob.
struct Seen {
    float depth;   // EMPTY: nothing
    float opacity; // of its core
    uint id;       // of the bubble
};

Seen blob_seen(Blob blob, WorldRay world) {
    Seen seen = Seen(EMPTY, 0.0, NO_BUBBLE);
    vec2 span;
    bool meets = in_blob(blob, world, span);
    // Loops of one turn: a CPU goes through what a branch skips.
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

// The layer with the bubble that is there to the last pixel, and its depth.
uint exact_layer(Blob blob, WorldRay world, uint layer, inout float depth) {
    vec2 span;
    in_blob(blob, world, span);
    BlobRay ray = blob_ray(blob, world, span);
    BlobHit hit = BlobHit(depth / ray.scale, 0.0, layer & 0xffu);
    hit = among_neighbours(blob.template_, ray.origin, ray.direction, hit, ray.span.x);
    depth = hit.t * ray.scale;
    return layer_of(layer >> 8, hit.id);
}
