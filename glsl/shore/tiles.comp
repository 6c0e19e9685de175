#version 460
// Pass `shore-tiles`: lists the 8x8 tiles that may contain foam on the host's water surface, and computes the
// dispatches over the lists. There are three lists: for tiles with shoreline foam, with contact foam, and with both.
// Not in the sources: most of a picture has no such foam, and this test is much cheaper than shading.
// Reads: scene depth, surface depth, map of shore distances. Writes: lists, arguments.

#include "frame.glsl"
#include "shore.glsl"
#include "shore_place.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#include "shore_lists.glsl"
#include "shore_tiles.glsl"

const float NONE = -3.0e38;

// Two limits that decide by the scene's device depth whether a pixel of a tile may have foam. Device depths are
// compared without conversion to eye depth, which saves work per texel. They are negated if necessary, so that nearer
// depths are greater.
struct Range {
    vec4 seen;    // the surface is hidden where the scene's depth is greater
    vec4 contact; // no contact foam where it is less
};

// Converts the reciprocal of an eye depth to a device depth that is greater if it is nearer.
vec4 device(vec4 reciprocal) {
    return abs(frame.depth.x) * reciprocal - (frame.depth.x < 0.0 ? -frame.depth.y : frame.depth.y);
}

// Returns the limits of scene depth for a tile. `least` and `most` bound the reciprocal eye depth of the water's
// surface in the tile. `part` is the factor from a distance along the view axis to the distance that contact foam
// measures. The limits have a margin for rounding, because pixels are tested again.
Range range_of(vec4 least, vec4 most, vec4 part) {
    const float SPARE = 1.0e-5;
    float ulps = 2.5e-7 * (1.0 + abs(frame.depth.y));
    vec4 before = most / max(1.0 - shore.surface_part.w * most, SPARE);
    vec4 behind = least * part / max(part + least / shore.contact.x, 1.0e-20);
    Range range;
    range.seen = mix(vec4(NONE), device((1.0 + SPARE) * before) + ulps, greaterThan(most, vec4(0.0)));
    range.contact = shore.mask_part.z > 0.0 ? device((1.0 - SPARE) * behind) - ulps : vec4(EMPTY);
    return range;
}

// Returns the reciprocal of the eye depth at which a pixel's view ray, in eye space, meets the level water surface; 0
// if the ray misses it.
float level_on(vec3 ray) {
    return shore.height.w == 0.0 ? 0.0 : max(-dot(shore.height.xyz, ray) / shore.height.w, 0.0);
}

// Returns the limits of scene depth for the 2x2 pixels from pixel `first` on, from the depth of a water surface that
// need not be level.
Range range_at_four(vec2 first) {
    vec4 own, part;
    for (int i = 0; i < 4; ++i) {
        vec3 ray = vec3(ray_slope(pixel_of(first, i), frame.slope), -1.0);
        float z = surface_at(pixel_of(first, i), ray);
        own[i] = z > 0.0 && z < EMPTY ? 1.0 / z : 0.0;
        part[i] = counted(ray);
    }
    return range_of(own, own, part);
}

void main() {
    vec2 first = vec2(TILE * gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(first, frame.extent.xy));
    // On a level surface, the values of a tile's pixels lie between those at the tile's corners: the reciprocal of
    // the eye depth, the factor `part` of range_of, and the horizontal position p.
    float least = EMPTY, most = 0.0, part = EMPTY;
    vec2 low = vec2(EMPTY), high = vec2(-EMPTY);
    for (int i = 0; i < 4; ++i) {
        vec2 corner = first + 0.5 + float(TILE - 1u) * vec2(i & 1, i >> 1);
        vec3 ray = vec3(ray_slope(corner, frame.slope), -1.0);
        float own = level_on(ray);
        least = min(least, own);
        most = max(most, own);
        part = min(part, counted(ray));
        vec2 level = vec2(dot(shore.east.xyz, ray), dot(shore.north.xyz, ray));
        vec2 p = level / max(own, 1.0 / EMPTY) + vec2(shore.east.w, shore.north.w);
        low = min(low, p);
        high = max(high, p);
    }
    // The tile's bounds in texels of the map.
    low = clamp((low - shore.map.xy) * shore.map.z, vec2(-1.0), vec2(shore.map.w + 1.0));
    high = clamp((high - shore.map.xy) * shore.map.z, vec2(-1.0), vec2(shore.map.w + 1.0));
    bool over = all(lessThan(low, vec2(shore.map.w))) && all(greaterThan(high, vec2(0.0)));
    // Each quarter of these bounds is tested. `off` bounds, in scene units, by how much shore distances in a quarter
    // differ from the map's texel at its centre: half the quarter's diagonal, 1 texel to the centre of the nearest
    // texel, 1.5 texels to the four texels around a point, and 1.5 texels for the errors of both distances.
    float off = (0.25 * length(high - low) + 4.0) / max(shore.map.z, 1.0e-9);
    // Far from the shore a texel of the map may hold a larger number instead of its distance. It then tells only that
    // the shore is farther away than the map computes distances (`FARTHER` and `SPARE` in src/shore/distance.rs);
    // `sure` is 2 texels less, because of rounding and because a seed lies between the centres of texels.
    float sure = 1.25 / min(shore.reach.x, shore.reach.y) + 6.0 / max(shore.map.z, 1.0e-9);
    bool band = false;
    for (int i = 0; i < 4; ++i) {
        vec2 middle = mix(low, high, 0.25 + 0.5 * vec2(i & 1, i >> 1));
        middle = clamp(middle, vec2(0.5), vec2(max(shore.map.w - 0.5, 0.5)));
        float distance = clamp(texelFetch(map, ivec2(middle), 0).x, -sure, sure);
        band = band || (distance - off) * shore.reach.y < 1.0 && (distance + off) * shore.reach.x > -1.0;
    }
    bool by_map = shore.reach.w == 2.0, by_depth = shore.reach.w > 2.5;
    bool in_band = over && band || shore.surface_part.z > 1.5;
    bool lines = by_depth || by_map && in_band;
    bool contacts = shore.mask_part.z > 0.0;
    // Read depths only where the surface is in view and they matter.
    bool in_view = inside && (most > 0.0 || GENERAL == 1u);
    bool asked = in_view && (lines || contacts);
    Range range = range_of(vec4(least), vec4(most), vec4(part));
    float side = sign(frame.depth.x);
    vec2 texel = 1.0 / vec2(textureSize(scene_depth, 0));
    // `nearest` is the scene's greatest, so nearest, device depth among the texels that do not hide the water's
    // surface. If the surface need not be level, the depth at which contact foam begins is subtracted. Texels outside
    // the picture may be included, because pixels are tested again.
    vec4 nearest = vec4(NONE);
    for (int row = 0; row < (asked ? HALF : 0); ++row) {
        for (int column = 0; column < HALF; ++column) {
            vec2 four = first + 2.0 * vec2(column, row);
            vec4 scene = side * scene_at_four(four, texel);
            if (GENERAL == 1u) {
                range = range_at_four(four);
            }
            vec4 over = GENERAL == 1u ? scene - range.contact : scene;
            nearest = max(nearest, mix(vec4(NONE), over, lessThanEqual(scene, range.seen)));
        }
    }
    float found = max(max(nearest.x, nearest.y), max(nearest.z, nearest.w));
    lines = asked && lines && found > NONE;
    contacts = asked && contacts && found > (GENERAL == 1u ? 0.0 : range.contact.x);
    // Each call of `adds` has a constant as list number: with one call and a variable number, NVIDIA 580.159 listed
    // no tile that has both kinds of foam.
    if (lines && contacts) {
        adds(3u);
    } else if (lines) {
        adds(1u);
    } else if (contacts) {
        adds(2u);
    }
}
