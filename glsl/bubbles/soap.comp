#version 460
// Pass `soap`: shades the blobs of a pixel, front to back (Huszar, Szecsi, Sec. 4.4 and 5). Each layer composites a
// bubble's front film, the wall to the next bubble, the blob's core and the back film. Water in front of a layer
// attenuates the layer and adds its own light in proportion to the layer's opacity, so the background behind all
// layers keeps its value, in water or not.
// Reads: blobs, layers, film, core, environment, irradiance, water depth, thickness, inputs of blob.glsl and
// sunlight.glsl. Writes: bubbles (RGBA16F), premultiplied.

#include "frame.glsl"
#include "medium.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "octahedral.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "bubbles.glsl"
#include "cube.glsl"
#include "blob.glsl"
#include "blob_ray.glsl"
#include "wall.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint LAYERS = 3;

layout(set = 0, binding = 2) uniform sampler2D water_depth;
layout(set = 0, binding = 3, std430) readonly buffer Blobs { Blob blobs[]; };
layout(set = 0, binding = 4, std430) readonly buffer Layers { uint layers[]; };
layout(set = 0, binding = 5) uniform sampler2D film_table;
layout(set = 0, binding = 6) uniform sampler2D core_map;
layout(set = 0, binding = 7) uniform samplerCube environment;
layout(set = 0, binding = 11) uniform sampler2D irradiance;
layout(set = 0, binding = 12, rgba16f) uniform writeonly image2D bubbles_image;
layout(set = 0, binding = 14) uniform sampler2D thickness;

// Reflectance of a film per colour channel.
vec3 film_at(float cosine, float thickness) {
    vec2 size = vec2(textureSize(film_table, 0));
    vec2 at = vec2(clamp(cosine, 0.0, 1.0), clamp(thickness, 1.0, bubbly.film.w) / bubbly.film.w);
    return textureLod(film_table, (at * (size - 1.0) + 0.5) / size, 0.0).rgb;
}

float fraction_of(uint hash) {
    return float(pcg(hash) >> 8) * (1.0 / 16777216.0);
}

// Film thickness in nm: different for each bubble, uneven, and thinner on top, where it drains (Sec. 3.1).
float film_thickness(uint number, vec3 place, float high) {
    float own = 2.0 * fraction_of(number) - 1.0;
    float uneven = gradient_noise(place + 64.0 * fraction_of(number + 1u));
    return bubbly.film.x * (1.0 + bubbly.film.y * (0.7 * own + 0.6 * uneven)) * (1.0 - bubbly.film.z * high);
}

struct Look {
    Blob blob;
    BlobRay ray;
    vec3 seen;     // direction of the ray, world
    float pixels;  // per radius of the blob
    vec3 sun;      // visibility of the sun
};

vec3 to_world(Look look, vec3 v) {
    return turned(turned_back(look.blob.turn), v);
}

// Light that a bubble's film reflects to the eye. `back` returns its reflectance, the fraction of light from behind
// that it withholds. The smaller the bubble's `radius` in pixels, the wider is the cone of directions that a pixel
// reflects. `open` is the fraction of the surroundings that is environment; the rest is foam with the light `foam`.
vec3 film_light(Look look, vec3 normal, float radius, float thickness, float open, vec3 foam, out vec3 back) {
    vec3 n = to_world(look, normal);
    float cosine = dot(n, look.seen);
    n = cosine > 0.0 ? -n : n;
    back = film_at(abs(cosine), thickness);
    vec3 mirrored = reflect(look.seen, n);
    float texels = 4.0 / max(radius, 0.5) * float(textureSize(environment, 0).x) / 1.5707963;
    vec3 light = textureLod(environment, mirrored, max(log2(texels), 0.0)).rgb;
    float glint = pow(max(dot(mirrored, mat3(frame.world) * frame.sun_direction.xyz), 0.0), bubbly.mirror.y);
    light += glint * bubbly.sun_mirror.rgb * look.sun;
    return bubbly.mirror.x * back * mix(foam, light, open);
}

// Light that the blob's opaque core sends to the eye at the point `past`, where the ray leaves the bubble that it
// hit. `normal` is that of the bubble's front, `round_` that of the blob as a ball; `fine` is 0 if the bubbles are
// too small to be seen, up to 1.
vec3 core_light(Look look, vec3 past, vec3 normal, vec3 round_, float fine) {
    vec3 at = normalize(mix(normalize(past), -normal, bubbly.core.z));
    vec4 pattern = textureLod(core_map, octahedral_texture_place(at, textureSize(core_map, 0)), 0.0);
    float shown = bubbly.albedo.w * fine;
    vec3 n = normalize(mix(normal, round_, bubbly.core.w) + shown * pattern.xyz);
    n = to_world(look, n);
    vec3 sky = textureLod(irradiance, octahedral_texture_place(n, textureSize(irradiance, 0)), 0.0).rgb;
    // Foam scatters light, so it is lit also where it is turned a little away from the sun.
    float facing = dot(n, mat3(frame.world) * frame.sun_direction.xyz);
    vec3 light = sky + bubbly.sun.rgb * look.sun * max((facing + 0.4) / 1.4, 0.0);
    // The core is darker near the blob's centre, in the creases between bubbles. Where bubbles are too small to be
    // seen, it has the mean brightness everywhere.
    float crease = mix(0.81, mix(0.77, 1.07, smoothstep(0.6, 1.0, length(past))), fine);
    return bubbly.albedo.rgb * light * mix(1.0, pattern.w, shown) * crease;
}

// Finds the first wall (film shared with a neighbour) that the ray meets on its path `way` through the bubble `a`.
// Returns the number of the neighbour, NO_BUBBLE without a wall, and in `at` the distance along the ray. The paper
// takes the next wall that its search finds, and can miss a nearer one.
uint second_bubble(Look look, uint id, vec4 a, vec2 way, out float at) {
    uint other = NO_BUBBLE;
    at = way.y;
    uvec4 words = neighbours_of(look.blob.template_, id);
    uint i = 0u;
    do {
        uint number = words.x & 0xffu;
        vec4 b = bubble_of(look.blob.template_, number);
        vec2 ends;
        // The wall lies in both bubbles.
        bool meets = ball_hits(look.ray.origin, look.ray.direction, b, ends) && ends.y > way.x && ends.x < at;
        if (meets && number != id) {
            float t = wall_hit(wall_between(a, b), a, b, look.ray.origin, look.ray.direction, way.x);
            bool nearer = t > 0.0 && t < at;
            at = nearer ? t : at;
            other = nearer ? number : other;
        }
        ++i;
        words = (i & 3u) == 0u ? words.yzwx : uvec4(words.x >> 8, words.yzw);
    } while (i < 16u);
    return other;
}

// Shades one layer of a pixel, a bubble of a blob. Returns its light, its transmittance `through`, the light `body`
// of the blob's core, and `opacity`: x is the core's where the ray leaves this bubble, as in pass `peel`; y is the
// core's where the ray leaves the next bubble, if it went on through a wall.
vec3 blob_light(Look look, uint id, out vec3 through, out vec3 body, out vec2 opacity) {
    BlobRay ray = look.ray;
    vec2 way = ray.span;
    vec3 middle = vec3(0.0);
    float radius = 1.0;
    if (BY_ID == 1u) {
        vec4 bubble = bubble_of(look.blob.template_, id);
        ball_hits(ray.origin, ray.direction, bubble, way);
        middle = bubble.xyz;
        radius = bubble.w;
    } else {
        BlobHit hit = blob_hit(look.blob.template_, ray.origin, ray.direction, ray.span);
        way = vec2(hit.t, hit.past);
        radius = mean_radius();
    }
    way.x = max(way.x, ray.span.x);
    vec3 met = ray.origin + way.x * ray.direction;
    vec3 past = ray.origin + way.y * ray.direction;
    vec3 round_ = normalize(met);
    vec3 normal;
    if (BY_ID == 1u) {
        normal = (met - middle) / radius;
    } else {
        // Normal of the blob's surface, which has the distance d(p / |p|) from the centre in the direction of p, from
        // finite differences of d in two tangent directions.
        uint which = look.blob.template_;
        vec3 axis = abs(round_.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
        vec3 side = 0.03 * normalize(cross(round_, axis));
        vec3 other = cross(round_, side);
        float a = distance_at(which, round_ + side) - distance_at(which, round_ - side);
        float b = distance_at(which, round_ + other) - distance_at(which, round_ - other);
        normal = normalize(round_ - (a * side + b * other) / (2.0 * 0.03 * 0.03 * length(met)));
    }
    // If a blob's bubbles are too small to be seen, it is shaded as one rough white ball. If the blob is too small
    // too, its normal is the mean over its visible side, which points to the eye, instead of the normal at one point.
    float pixels = radius * look.pixels;
    float fine = smoothstep(0.7, 3.0, pixels);
    vec3 ball = normalize(mix(-ray.direction, round_, smoothstep(0.7, 3.0, look.pixels)));
    normal = normalize(mix(ball, normal, fine));
    uint number = pcg(look.blob.id * 977u + id);
    float high = dot(to_world(look, normal), frame.up.xyz);
    // Where bubbles are too small to be seen, the film gets the greatest thickness of the table: the interference
    // colours of many bubbles mix to white, which is the colour of a thick film.
    float thick = mix(bubbly.film.w, film_thickness(number, 2.5 * met / radius, high), fine);

    vec3 core = core_light(look, past, normal, ball, fine);
    body = core;
    vec3 mirrored = reflect(ray.direction, normal);
    float open = smoothstep(-0.35, 0.45, dot(mirrored, round_));
    vec3 back;
    vec3 light = film_light(look, normal, pixels, thick, open, core, back);
    through = 1.0 - back;

    opacity.x = core_opacity(past);
    float at = way.y;
    uint other = NO_BUBBLE;
    if (BY_ID == 1u && bubbly.mirror.z > 0.5 && fine > 0.0) {
        other = second_bubble(look, id, vec4(middle, radius), way, at);
    }
    if (other != NO_BUBBLE) {
        vec4 b = bubble_of(look.blob.template_, other);
        vec3 on = ray.origin + at * ray.direction;
        float own = film_thickness(number ^ other, 2.5 * on / radius, 0.0);
        vec3 kept;
        vec3 across = wall_normal(wall_between(vec4(middle, radius), b), on);
        vec3 more = film_light(look, across, pixels, own, 0.4, core, kept);
        light += fine * through * more;
        through *= 1.0 - fine * kept;
        // Continue in the other bubble.
        vec2 ends;
        ball_hits(ray.origin, ray.direction, b, ends);
        middle = ends.y > way.y ? b.xyz : middle;
        way.y = max(way.y, ends.y);
        past = ray.origin + way.y * ray.direction;
    }
    float solid = core_opacity(past);
    opacity.y = solid;
    light += through * solid * core;
    through *= 1.0 - solid;
    // The film behind, seen from inside.
    vec3 behind = normalize(past - middle);
    vec3 kept;
    float far = film_thickness(number, 2.5 * past / radius, dot(to_world(look, behind), frame.up.xyz));
    light += fine * through * film_light(look, behind, pixels, far, 0.5, core, kept);
    through *= 1.0 - fine * kept;
    return light;
}

// Thickness of the water along z at a pixel in scene units, interpolated between the texels with water.
float water_at(vec2 pixel) {
    vec2 h = pixel / frame.thick_extent.z - 0.5;
    ivec2 last = ivec2(frame.thick_extent.xy) - 1;
    vec2 f = fract(h);
    float sum = 0.0;
    float wet = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 part = mix(1.0 - f, f, vec2(side));
        float there = texelFetch(thickness, clamp(ivec2(floor(h)) + side, ivec2(0), last), 0).x;
        sum += part.x * part.y * there;
        wet += there > 0.0 ? part.x * part.y : 0.0;
    }
    return wet > 0.0 ? sum / wet : 0.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.extent.xy)))) {
        return;
    }
    uint first = (uint(pixel.y) * uint(frame.extent.x) + uint(pixel.x)) * (LAYERS + 1u);
    float most = uintBitsToFloat(layers[first + LAYERS]);
    vec3 along = vec3(ray_slope(vec2(pixel) + 0.5, frame.slope), -1.0);
    float length_ = length(along);
    WorldRay world = world_ray(along.xy);
    vec3 color = vec3(0.0);
    vec3 left = vec3(1.0);
    vec3 body = vec3(0.0);
    // Eye depth of the water's surface at this pixel, and thickness of all water behind it along z, both in scene
    // units. Gaps of air between layers of water are ignored: the water counts as one piece.
    float surface = texelFetch(water_depth, pixel, 0).x;
    float room = surface < EMPTY && frame.target.z >= FRONT_WATER ? water_at(vec2(pixel) + 0.5) : 0.0;
    float metres = 0.0;
    vec3 sun = vec3(1.0);
    vec2 opacities = vec2(0.0);
    float behind = 1.0;
    uint i = 0u;
    bool more = layers[first] != NO_LAYER;
    while (more) {
        uint layer = layers[first + i];
        Look look;
        look.blob = blobs[layer >> 8];
        look.seen = world.direction;
        vec2 span;
        in_blob(look.blob, world, span);
        look.ray = blob_ray(look.blob, world, span);
        uint id = layer & 0xffu;
        vec4 ball = BY_ID == 1u ? bubble_of(look.blob.template_, id) : vec4(0.0, 0.0, 0.0, 1.0);
        vec2 way;
        ball_hits(look.ray.origin, look.ray.direction, ball, way);
        float depth = max(way.x, look.ray.span.x) * look.ray.scale;
        look.pixels = look.blob.ball.w / (depth * frame.texel.x);
        if (i == 0u) {
            sun = sunlight(along * depth, vec2(pixel) + 0.5);
        }
        look.sun = sun;
        metres = clamp(depth - surface, 0.0, room) * length_;
        vec3 through;
        vec3 own;
        vec2 opacity;
        vec3 light = blob_light(look, id, through, own, opacity);
        opacities = max(opacities, opacity);
        behind *= 1.0 - opacity.x;
        body = i == 0u ? own : mix(body, own, 0.5);
        color += through_medium(left * light, left * (1.0 - through), metres).rgb;
        left *= through;
        ++i;
        // Nothing is visible behind opaque layers.
        bool open = max(left.r, max(left.g, left.b)) > HIDDEN;
        more = open && i < LAYERS && layers[first + min(i, LAYERS - 1u)] != NO_LAYER;
    }
    float covered = 1.0 - dot(left, vec3(1.0 / 3.0));
    // Where a pixel's layers leave a hole, it is filled up to the maximum opacity (Sec. 5) of these layers, or of all
    // blobs if pass `peel` has found more opaque ones behind. The comparison allows 1/1024 because `peel` by
    // billboards blends opacities in half precision.
    most = most > opacities.x + 1.0 / 1024.0 && behind >= HIDDEN ? most : opacities.y;
    float plug = bubbly.mirror.w > 0.5 ? max(most - covered, 0.0) : 0.0;
    color += through_medium(plug * body, vec3(plug), metres).rgb;
    imageStore(bubbles_image, pixel, vec4(min(color, 65000.0), min(covered + plug, 1.0)));
}
