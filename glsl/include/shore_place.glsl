// Intersection of a pixel's ray with the host's water surface, and the shore coordinate v at this point: 0 where the
// foam ends at sea, 1 at the shore, 2 where it ends inland. Needs frame.glsl, shore.glsl.
// Reads: surface depth, map of distances.

layout(set = 0, binding = 3) uniform sampler2D surface_depth;
layout(set = 0, binding = 6) uniform sampler2D map;

// Eye depth of the host's surface, from its level or its depth image.
float surface_at(vec2 pixel, vec3 ray) {
    float fall = dot(shore.height.xyz, ray);
    float z = -shore.height.w / (abs(fall) < 1.0e-9 ? 1.0e-9 : fall);
    if (GENERAL == 1u) {
        ivec2 texel = clamp(ivec2(pixel * shore.surface.xy), ivec2(0), ivec2(shore.surface.zw) - 1);
        float depth = eye_depth(texelFetch(surface_depth, texel + ivec2(shore.surface_part.xy), 0).x);
        z = shore.surface_part.z > 1.5 ? depth : z;
    }
    return clamp(z, -EMPTY, EMPTY);
}

float v_of(float distance) {
    return 1.0 + distance * (distance < 0.0 ? shore.reach.x : shore.reach.y);
}

// v from the map (0 outside) and its change per pixel.
float mapped(Water w, out vec2 dv) {
    vec2 texel = (w.p - shore.map.xy) * shore.map.z - 0.5;
    float last = shore.map.w - 1.0;
    bool inside = all(greaterThanEqual(texel, vec2(0.0))) && all(lessThanEqual(texel, vec2(last)));
    vec2 base = clamp(floor(texel), 0.0, last - 1.0);
    vec2 f = clamp(texel - base, 0.0, 1.0);
    vec4 four = textureGather(map, (base + 1.0) / shore.map.w);
    vec2 rows = mix(four.wx, four.zy, f.x);
    float distance = mix(rows.x, rows.y, f.y);
    vec2 slope = vec2(mix(four.z - four.w, four.y - four.x, f.y), rows.y - rows.x) * shore.map.z;
    dv = (slope * w.across) * (distance < 0.0 ? shore.reach.x : shore.reach.y);
    return inside ? v_of(distance) : 0.0;
}
