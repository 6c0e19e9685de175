// What a pixel of water looks like (thesis Sec. 3.3 and 4.10, Listing A.20), for every way to reach
// its pixels. Layers so far: water over the scene. Refraction in screen space, Beer's law along the
// ray, Fresnel reflection of the environment, the sun's highlight.
// Reads: smoothed, levels, depth, thickness, scene colour and depth, environment.
// Needs frame.glsl, level.glsl, surface.glsl.

// Where the thickness lies: 0 at full resolution, 1 at the smoothing's, 2 elsewhere.
layout(constant_id = 0) const uint THICKNESS = 1;
layout(constant_id = 1) const uint SCHLICK = 1;
// 1: the surface is smoothed at the configured level alone. A pipeline each, not a branch: a CPU
// would run both sides.
layout(constant_id = 2) const uint CONFIGURED = 1;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D thickness;
layout(set = 0, binding = 4) uniform sampler2D scene_color;
layout(set = 0, binding = 5) uniform sampler2D scene_depth;
layout(set = 0, binding = 6) uniform samplerCube environment;

// Derivatives of the unsmoothed depth, per pixel; never steep.
vec2 drop_slope(ivec2 pixel, float front, float threshold) {
    vec2 texel = 1.0 / vec2(textureSize(depth, 0));
    vec4 before = textureGather(depth, vec2(pixel) * texel);
    vec4 after = textureGather(depth, vec2(pixel + 1) * texel);
    ivec2 last = ivec2(frame.extent.xy) - 1;
    vec2 low = vec2(pixel.x < 1 ? EMPTY : before.x, pixel.y < 1 ? EMPTY : before.z);
    vec2 high = vec2(pixel.x >= last.x ? EMPTY : after.z, pixel.y >= last.y ? EMPTY : after.x);
    bvec4 whole = bvec4(true);
    vec2 dz = differences(low.xyxy, vec4(front), high.xyxy, threshold, whole).xy;
    vec2 steepest = frame.texel.xy * front * RIM_SLOPE;
    return clamp(dz, -steepest, steepest);
}

// Upsampled with the weights of texels on the same surface.
float thickness_at(Surface s, Level level, vec2 pixel, float threshold) {
    if (THICKNESS == 0u) {
        return texelFetch(thickness, ivec2(pixel), 0).x;
    }
    ivec2 last = ivec2(frame.thick_extent.xy) - 1;
    ivec2 base = s.base;
    vec4 weights = s.weights;
    if (THICKNESS == 2u || (CONFIGURED == 0u && level.texel.z != frame.thick_extent.z)) {
        vec2 h = pixel / frame.thick_extent.z - 0.5;
        base = ivec2(floor(h));
        vec2 f = h - vec2(base);
        weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
        // The surface at the middle of each coarse texel.
        vec4 same;
        float ratio = frame.thick_extent.z / level.texel.z;
        for (int i = 0; i < 4; ++i) {
            vec2 middle = (vec2(base + ivec2(i & 1, i >> 1)) + 0.5) * ratio;
            ivec2 at = clamp(ivec2(middle), ivec2(0), level.rect.zw - 1);
            float z = texelFetch(smoothed, level.rect.xy + at, 0).x;
            same[i] = abs(z - s.z) <= threshold ? weights[i] : 0.0;
        }
        float sum = same.x + same.y + same.z + same.w;
        weights = sum > 1.0e-3 ? same / sum : weights;
    }
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (weights[i] > 0.0) {
            ivec2 t = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), last);
            sum += weights[i] * texelFetch(thickness, t, 0).x;
        }
    }
    return sum;
}

// Whether any of the four texels of the scene's depth round a point stands before a depth.
bool stands_before(vec2 at, float z) {
    // No texel of what lies beside the view in the same image.
    vec2 size = frame.scene_depth.zw;
    vec2 texel = clamp(at * frame.scene_depth.xy, min(vec2(1.0), 0.5 * size), max(size - 1.0, 0.5 * size));
    texel = (texel + frame.scene_origin.xy) / vec2(textureSize(scene_depth, 0));
    vec4 scene = frame.depth.x / (textureGather(scene_depth, texel) + frame.depth.y);
    // Infinity of a reversed depth may come out negative.
    return any(lessThan(mix(vec4(EMPTY), scene, greaterThan(scene, vec4(0.0))), vec4(z)));
}

// Whether nothing can be seen of what is behind the water at a point: it is beyond the view, or
// scene stands before it in or next to what filtering of its colour will touch. Loops here, not
// branches: a CPU runs branches whole.
bool hidden_at(vec2 q, float z) {
    bool same = all(equal(frame.scene_depth.xy, vec2(1.0)));
    int corners = same ? 1 : 4;
    vec2 inside = clamp(q, vec2(0.5), frame.extent.xy - 0.5);
    bool hidden;
    int i = 0;
    do {
        vec2 corner = same ? vec2(0.0) : vec2(i & 1, i >> 1) - 0.5;
        hidden = stands_before(q + corner, z);
        ++i;
    } while (i < corners && !hidden);
    return hidden || any(notEqual(inside, q));
}

// Scene colour behind the water at an offset in pixels; never scene that stands in front of it.
// The look-up goes half the way to where that begins or the view ends, and no farther: dropping
// the offset there would leave a seam, going all the way would smear what lies at the edge.
vec3 refracted(vec2 pixel, vec2 offset, float z) {
    float far = length(offset);
    // In offsets: the farthest place known to be free, and the nearest that is not.
    float free = 0.0;
    float blocked = 3.0;
    do {
        float part = blocked == 3.0 ? free + 1.0 : 0.5 * (free + blocked);
        bool hidden = hidden_at(pixel + offset * part, z);
        free = hidden ? free : part;
        blocked = hidden ? part : blocked;
    } while (free < 2.0 && (blocked - free) * far >= 0.5);
    // A pixel and a half less: the edge may be smoothed into its neighbours.
    float part = free < 2.0 ? clamp(0.5 * (free - 1.5 / max(far, 1.0)), 0.0, 1.0) : 1.0;
    vec2 q = pixel + offset * part;
    vec2 texel = clamp(q * frame.scene_color.xy, vec2(0.5), frame.scene_color.zw - 0.5);
    texel = (texel + frame.scene_origin.zw) / vec2(textureSize(scene_color, 0));
    return textureLod(scene_color, texel, 0.0).rgb;
}

vec3 through_medium(vec3 background, float path) {
    if (frame.medium_a.w > 0.5) {
        vec3 tint = frame.medium_a.rgb * exp(-frame.medium_b.rgb * path);
        return mix(tint, background, exp(-frame.medium_b.a * path));
    }
    vec3 extinction = frame.medium_a.rgb + frame.medium_b.rgb;
    vec3 kept = exp(-extinction * path);
    vec3 albedo = frame.medium_b.rgb / max(extinction, vec3(1.0e-9));
    return background * kept + frame.ambient.rgb * albedo * (1.0 - kept);
}

float fresnel(float cosine) {
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    if (SCHLICK == 1u) {
        float x2 = x * x;
        return frame.fresnel.x + frame.fresnel.y * x2 * x2 * x;
    }
    return clamp(frame.fresnel.x + frame.fresnel.y * pow(x, frame.fresnel.z), 0.0, 1.0);
}

// Colour of the water at a pixel (its centre, at +0.5) whose depth is not empty.
vec3 shade(vec2 pixel, float front) {
    float threshold = frame.surface.w;
    uint finer = CONFIGURED == 1u ? 0u : finer_level();
    Level level = levels.level[finer];
    Surface surface = surface_at(level, pixel, front, threshold);
    float t = thickness_at(surface, level, pixel, threshold);
    Level coarser = levels.level[1u - finer];
    if (CONFIGURED == 0u && coarser.texel.w > 0.0) {
        Surface other = surface_at(coarser, pixel, front, threshold);
        surface.z = mix(surface.z, other.z, coarser.texel.w);
        surface.dz = mix(surface.dz, other.dz, coarser.texel.w);
    }
    // Where there is less than a layer of water it is a drop: it keeps the shape of its sphere.
    float drop = 1.0 - smoothstep(0.6 * frame.particle.y, 0.9 * frame.particle.y, t);
    surface.dz = mix(surface.dz, drop_slope(ivec2(pixel), front, threshold), drop);
    vec2 slope = ray_slope(pixel, frame.slope);
    vec3 position;
    vec3 n;
    surface_frame(surface, slope, position, n);

    float away = length(position);
    vec3 v = -position / away;
    float path = t * away / surface.z;
    // Light bends towards the water's normal: the look-up moves against it (the source has it the
    // other way, which shows things smaller under a bump).
    vec2 offset = -n.xy * sign(frame.projection.xy) * t * frame.surface.x / (frame.texel.xy * surface.z);
    vec3 c = through_medium(refracted(pixel, offset, surface.z), path);

    // Thin films at the rim of a drop neither reflect nor shine: no outlines.
    float w = smoothstep(0.0, 0.25 * frame.particle.x, t);
    vec3 reflected = mat3(frame.world) * reflect(-v, n);
    // What is mirrored from below the horizon is more water, not the environment's ground.
    float sky = smoothstep(-0.3, 0.0, reflected.y);
    c = mix(c, textureLod(environment, reflected, 0.0).rgb, w * sky * fresnel(dot(n, v)));
    vec3 h = normalize(v + frame.sun_direction.xyz);
    // pow() by hand: of tiny bases some drivers make NaN.
    float lobe = frame.surface.z * log2(max(dot(n, h), 1.0e-6));
    float shine = exp2(max(lobe, -100.0));
    c += w * frame.surface.y * shine * frame.sun_color.rgb;
    return c;
}
