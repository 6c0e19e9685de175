// Shading of a water pixel (thesis Sec. 3.2.3 and 4.9.2, Listings A.19, A.20), for both paths of `composite` (raster
// and compute). One or two layers of water, called sheets, lie over the scene. A sheet refracts what lies behind it
// in screen space, absorbs light by Beer's law along the ray, reflects the environment and, by a screen-space march,
// the scene, both weighted by Fresnel, and has a highlight of the sun. Two sheets are not in the thesis (its
// limitation, Fig. 5.13). Whitewater behind the water's surface is composited inside the water, the rest of it over
// the water.
// Reads: smoothed, levels, depth, thickness, sheets, boundaries, noise, scene colour and depth, environment, depth,
// thickness and drift of foam, spray, depth, thickness and light of whitewater particles, depth and colour of bubble
// foam, contact foam, inputs of sunlight.glsl.
// Needs frame.glsl, medium.glsl, level.glsl, sheets.glsl, surface.glsl, panes.glsl, surface_foam_texels.glsl,
// beside.glsl, sunlight.glsl, shore_light.glsl, surface_noise.glsl, intensity.glsl, scene_color.glsl, random.glsl,
// gradient_noise.glsl.

// Resolution of the thickness: 0: full, 1: that of the smoothing, 2: another.
layout(constant_id = 0) const uint THICKNESS = 1;
// 1: coarser levels of the smoothing may show. It is a specialization constant, because a CPU driver would run both
// sides of a branch.
layout(constant_id = 2) const uint NEAR = 0;
// Steps of the screen-space march that finds which part of the scene the front surface reflects; 0: reflect
// the environment only.
layout(constant_id = 25) const uint MIRROR = 0;
// Steps of the screen-space march that finds where the refracted ray meets the scene; 0: no march, the scene is
// looked up at an offset that follows from the front surface's slope.
layout(constant_id = 26) const uint EXIT = 0;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D thickness;
layout(set = 0, binding = 5) uniform sampler2D scene_depth;
layout(set = 0, binding = 6) uniform samplerCube environment;
layout(set = 0, binding = 12) uniform sampler2D sheets;
layout(set = 0, binding = 14) uniform sampler2D foam_thickness;
layout(set = 0, binding = 22) uniform sampler2D whitewater_thickness;
layout(set = 0, binding = 23) uniform sampler2D whitewater_light;
layout(set = 0, binding = 26) uniform sampler2D soap;

#include "ripples.glsl"
#include "surface_foam_drift.glsl"
#include "lace.glsl"
#include "march.glsl"
#include "wavelets.glsl"

// Slope of the unsmoothed depth, per pixel, limited to RIM_SLOPE.
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

// Thickness of the water at a pixel, upsampled from the texels that lie on the pixel's own surface. x: all water, y:
// the part before the frontmost foam. Also returns the first of the four texels around the pixel, and the weights of
// the four.
vec2 thickness_at(Surface s, Level level, vec2 pixel, float threshold, out ivec2 base, out vec4 weights) {
    base = s.base;
    weights = s.weights;
    if (THICKNESS == 0u) {
        base = ivec2(pixel);
        weights = vec4(1.0, 0.0, 0.0, 0.0);
        return texelFetch(thickness, base, 0).xy;
    }
    ivec2 last = ivec2(frame.thick_extent.xy) - 1;
    if (THICKNESS == 2u || (NEAR == 1u && level.texel.z != frame.thick_extent.z)) {
        vec2 h = pixel / frame.thick_extent.z - 0.5;
        base = ivec2(floor(h));
        vec2 f = h - vec2(base);
        weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
        // The surface at the centre of each thickness texel.
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
    // The mean of the water's thickness omits texels without water: the scene hides the water at the texel's centre,
    // but need not hide it at this pixel.
    vec2 sum = vec2(0.0);
    vec4 wet = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        if (weights[i] > 0.0) {
            ivec2 t = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), last);
            vec2 there = texelFetch(thickness, t, 0).xy;
            sum += weights[i] * there;
            wet[i] = there.x > 0.0 ? weights[i] : 0.0;
        }
    }
    float share = wet.x + wet.y + wet.z + wet.w;
    weights = share > 0.0 ? wet / share : weights;
    return share > 0.0 ? sum / share : vec2(0.0);
}

// Amount of air between two sheets (layers of water), from 0 (water) to 1 (air). `window`: thickness of the water in
// the window, a range of depth around the boundary between the two sheets.
float air(float window) {
    return 1.0 - smoothstep(0.1 * frame.particle.y, 0.6 * frame.particle.y, window);
}

// x: thickness of the sheet (layer of water) that the surface at depth `front` belongs to; without air between the
// two sheets, of both together. y: amount of air between the sheets, 0 to 1. z, w: thickness of the back and of the
// front sheet, times y. `boundary`, the depth that separates the sheets, becomes that of the texel with the largest
// weight, because the pixel's own texel may show another surface.
vec4 sheet_thickness(ivec2 base, vec4 weights, float front, inout float boundary) {
    ivec2 last = ivec2(frame.thick_extent.xy) - 1;
    vec4 sum = vec4(0.0);
    float most = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), last);
        vec3 t = texelFetch(sheets, texel, 0).xyz;
        float between = boundary_of(texel);
        boundary = weights[i] > most ? between : boundary;
        most = max(most, weights[i]);
        vec2 own = front < between ? t.xy : t.yx;
        float apart = air(t.z);
        sum += weights[i] * vec4(own.x + (1.0 - apart) * own.y, apart, apart * t.y, apart * t.x);
    }
    return sum;
}

// Whether one of the four scene-depth texels around the point `at`, in pixels, is nearer to the eye than z.
bool stands_before(vec2 at, float z) {
    // Stay inside the view: its image may hold other views beside it.
    vec2 size = frame.scene_depth.zw;
    vec2 texel = clamp(at * frame.scene_depth.xy, min(vec2(1.0), 0.5 * size), max(size - 1.0, 0.5 * size));
    texel = (texel + frame.scene_origin.xy) / vec2(textureSize(scene_depth, 0));
    vec4 scene = frame.depth.x / (textureGather(scene_depth, texel) + frame.depth.y);
    // With a reversed depth, infinity may come out negative.
    return any(lessThan(mix(vec4(EMPTY), scene, greaterThan(scene, vec4(0.0))), vec4(z)));
}

// Whether the scene behind the water cannot be looked up at a point: it is outside the view, or a texel of the scene's
// depth near it lies in front of z. The texels examined include those that filtering reads of a scene colour that has
// the view's resolution. Loops instead of branches, for CPU drivers (docs/performance.md).
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

// Largest refraction offset, in heights of the picture. On torn water neighbouring pixels look in very
// different directions, and large offsets would make a mosaic.
const float MOST_BENT = 1.0 / 16.0;

// Max number of looks at the scene in `refracted`, which searches for the end of the free offset: two at whole
// offsets, then bisection of the largest offset (1/16 of a picture height of 16384 pixels, 1024 pixels) down to half
// a pixel.
const int MOST_LOOKS = 14;

// Objects before the water up to about this wide, in heights of the picture, are looked past: a rail, a rope, the edge
// of a pane. Otherwise each would be framed by two bands in which the scene behind is shifted.
const float THIN = 1.0 / 60.0;

// Limits an offset in pixels smoothly to MOST_BENT.
vec2 bent(vec2 offset) {
    vec2 share = offset / (MOST_BENT * frame.extent.y);
    return offset * inversesqrt(1.0 + dot(share, share));
}

// Scene colour behind the water at an offset in pixels; never that of an object in front of the water. If such an
// object, wider than THIN, or the edge of the view lies within twice the offset, the offset is shortened to half of the
// free length before it. So the offset shrinks gradually towards an obstacle. An offset that dropped to 0 there would
// leave a seam, and the whole free length would lead all pixels nearby to the obstacle's edge and smear it.
vec3 refracted(vec2 pixel, vec2 offset, float z) {
    float far = length(offset);
    // THIN as a multiple of the offset.
    float thin = THIN * frame.extent.y / max(far, 1.0);
    // Multiples of the offset: `free` is the farthest known to be free of obstacles, `blocked` the nearest known to
    // be blocked (3: none yet).
    float free = 0.0;
    float blocked = 3.0;
    bool covered = false; // whether the scene at the whole offset is hidden
    int looks = 0;
    do {
        float part = blocked == 3.0 ? free + 1.0 : 0.5 * (free + blocked);
        bool hidden = hidden_at(pixel + offset * part, z);
        covered = looks == 0 ? hidden : covered;
        // A loop instead of a branch, for CPU drivers.
        for (bool go = hidden; go; go = false) {
            hidden = hidden_at(pixel + offset * (part + thin), z);
        }
        free = hidden ? free : part;
        blocked = hidden ? part : blocked;
        ++looks;
    } while (free < 2.0 && (blocked - free) * far >= 0.5 && looks < MOST_LOOKS);
    // The look-up stays a pixel and a half away from the obstacle: antialiasing may have blended the obstacle's edge
    // into its neighbours.
    float margin = 1.5 / max(far, 1.0);
    float part = free < 2.0 ? clamp(0.5 * (free - margin), 0.0, 1.0) : 1.0;
    // A look-up on a thin object goes to the object's far side. Loops instead of branches, as above.
    for (bool go = covered && free >= 2.0; go; go = false) {
        float past = thin;
        for (float step = 0.5 * thin; step * far >= 0.5; step *= 0.5) {
            past -= hidden_at(pixel + offset * (1.0 + past - step), z) ? 0.0 : step;
        }
        part += past + margin;
    }
    return scene_at(pixel + offset * part);
}

// Whether to follow Listing A.20 of the thesis: reflection and highlight are added with a weight (`with_mirrored`),
// and all foam lies at the depth of the frontmost foam.
bool by_source() {
    return frame.ambient.w > 0.5;
}

// Fresnel reflectance. It computes the fifth power and the general power and selects one: a specialization constant
// for so little would double the number of pipelines.
float fresnel(float cosine) {
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    float x2 = x * x;
    float power = frame.fresnel.z == 5.0 ? x2 * x2 * x : (x > 0.0 ? pow(x, frame.fresnel.z) : float(frame.fresnel.z == 0.0));
    return clamp(frame.fresnel.x + frame.fresnel.y * power, 0.0, 1.0);
}

// The effect of a sheet of water on the light from behind it.
struct Sheet {
    float path;    // length of the view ray in the water, scene units
    vec2 offset;   // of the refraction, pixels
    float mirror;  // reflectance
    vec3 mirrored;
    vec3 shine;    // sun highlight
    float wet;     // whether the scene behind touches the water: 1 it does, 0 air between
    float down;    // depth of the water above that scene, vertically, scene units
    float sun;     // visibility of the sun at the surface
    vec3 at;       // surface position, eye space
    vec3 normal;   // towards the eye
    float thick;   // thickness along z, scene units
};

const Sheet NO_SHEET = Sheet(0.0, vec2(0.0), 0.0, vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, vec3(0.0), vec3(0.0), 0.0);

// Ratio of the thickness of a sheet (layer of water) to the distance from its surface to the scene. Below the first
// value there is air behind the sheet, above the second the sheet touches the scene. The second is less than 1,
// because a thickness from particles is accurate only to about a quarter.
const vec2 FILLED = vec2(0.5, 0.7);

// Least cosine between the view axis and a ray through a sheet.
const float FLATTEST = 0.25;

// Length of the refracted ray from the surface to the scene, divided by the length of the unrefracted ray to the same
// depth below the surface. That holds for a level surface; as the surface becomes vertical, the ratio goes to 1.
float bent_way(vec3 n, vec3 v, vec3 up) {
    float ratio = frame.bed.w;
    float facing = max(dot(n, v), 0.0);
    float inside = sqrt(1.0 - ratio * ratio * (1.0 - facing * facing));
    float level = max(dot(n, up), 0.0);
    float rise = dot(v, up);
    float steep = ratio * rise + (inside - ratio * facing) * level;
    return mix(1.0, clamp(rise / max(steep, 1.0e-6), 0.0, 1.0), level);
}

#include "bed.glsl"
#include "met_water.glsl"

// The sheet (layer of water) with this front surface and the thickness `t` along z. `ripple` is the surface noise and
// its slope per pixel. `at_pane`: the surface is flush with a pane, and has neither waves nor a reflection of its
// own. `marched` allows a march for reflections of the scene, if MIRROR enables it.
Sheet sheet_of(Surface surface, vec2 pixel, float t, vec3 ripple, bool at_pane, bool marched) {
    vec2 slope = ray_slope(pixel, frame.slope);
    vec3 position;
    vec3 n;
    surface_frame(surface, slope, position, n);

    // Thickness is limited to the room before the scene, because sprites are wider than the particles that
    // they stand for. So water ends where it meets the scene, and does not refract what it touches.
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    // A mean of EMPTY may round to a little less.
    bool ends = scene > 0.0 && surface.z < 0.5 * EMPTY;
    float room = max(scene - surface.z, 0.0);
    t = ends ? min(t, room) : t;

    // Fraction to which the scene behind is under this water.
    float filled = t / max(room, 1.0e-6 * frame.particle.y);
    float wet = ends && frame.bed.w > 0.0 ? smoothstep(FILLED.x, FILLED.y, filled) : 0.0;
    if (NOISE == 1u) {
        vec3 px;
        vec3 py;
        surface_tangents(surface, slope, px, py);
        n = rippled(n, px, py, (1.0 - frame.noise_color.w * wet) * ripple.yz);
    }

    n = at_pane ? n : with_wavelets(n, position, t);

    Sheet sheet;
    sheet.at = position;
    sheet.normal = n;
    sheet.thick = t;
    float away = length(position);
    vec3 v = -position / away;
    sheet.path = t * away / surface.z;
    sheet.wet = wet;
    vec3 up = frame.up.xyz * mat3(frame.world);
    sheet.down = sheet.path * max(dot(v, up), 0.0);
    sheet.path *= mix(1.0, bent_way(n, v, up), sheet.wet);
    // Light bends towards the water's normal, so the look-up moves in the direction opposite to the normal's on the
    // screen. (The thesis' program moves it along the normal, which makes things under a bump look smaller.) A torn
    // surface refracts like a thin sheet: particles without neighbours are no lens.
    float lens = frame.surface.x * mix(min(t, 2.0 * frame.particle.y), t, surface.found);
    sheet.offset = -n.xy * sign(frame.projection.xy) * lens / (frame.texel.xy * surface.z);

    // Reflection and highlight fade out where the water is thin, because at the rims of drops they would outline
    // every drop.
    float w = at_pane ? 0.0 : by_source() ? 1.0 : smoothstep(0.0, 0.25 * frame.particle.x, t);
    vec3 to = reflect(-v, n);
    vec3 reflected = mat3(frame.world) * to;
    // A reflected ray that points below the horizon would meet more water, not the environment's ground. So the
    // reflection fades out, and what is behind the surface shows instead.
    float sky = by_source() ? 1.0 : smoothstep(-0.3, 0.0, dot(reflected, frame.up.xyz));
    sheet.mirror = w * fresnel(dot(n, v));
    sheet.mirrored = textureLod(environment, reflected, 0.0).rgb;
    if (MIRROR > 0u && marched) {
        // A march finds the scene along the reflected ray. What it finds is reflected even if the ray points below
        // the horizon.
        bool asked = sheet.mirror > 0.0 && surface.z < 0.5 * EMPTY && !by_source();
        Met met = march(position, to, asked ? int(MIRROR) : 0);
        float free = (1.0 - met.share) * sky;
        // A loop instead of a branch, for CPU drivers (docs/performance.md).
        bool any = met.share > 0.0;
        while (any) {
            sky = free + met.share;
            sheet.mirrored = (met.share * met_scene(met.at, to) + free * sheet.mirrored) / sky;
            any = false;
        }
    }
    sheet.mirror *= sky;
    // Where the view ray points straight at the sun, the half vector is 0 and there is no highlight.
    vec3 h = v + frame.sun_direction.xyz;
    h *= inversesqrt(max(dot(h, h), 1.0e-12));
    // pow() written out: for tiny bases it is NaN with some drivers.
    float lobe = frame.surface.z * log2(max(dot(n, h), 1.0e-6));
    float sun = SHADOW > 0u ? past_scene(position, pixel) : 1.0;
    sheet.sun = sun;
    sun = WITH_WHITEWATER == 1u ? sun * past_whitewater(light_texels(position)) : sun;
    sheet.shine = sun * w * frame.surface.y * exp2(max(lobe, -100.0)) * frame.sun_color.rgb;
    if (NOISE == 1u) {
        // Foam of the noise, lit like the particles' foam.
        vec3 light = SHADOW + CAST > 0u ? under(sunlight(position, pixel)) : vec3(1.0);
        sheet.shine += w * light * ripple_foam(ripple.x);
    }
    return sheet;
}

// Returns the sheet (layer of water). Its reflection and highlight are set to 0, unless the debug view contains
// all layers.
Sheet in_view(Sheet sheet) {
    float whole = frame.target.z >= WHOLE ? 1.0 : 0.0;
    sheet.mirror *= whole;
    sheet.shine *= whole;
    return sheet;
}

// Adds a surface's reflection and highlight to the light from below. `through`: transmittance of the water before the
// foam, and of the foam; only the thesis' rule (by_source) uses it.
vec3 with_mirrored(Sheet sheet, vec3 c, vec2 through) {
    float weight = clamp(1.0 - through.x + through.y, 0.0, 1.0) * (1.0 - through.x);
    float kept = by_source() ? 1.0 : 1.0 - sheet.mirror;
    return c * kept + (sheet.mirrored * sheet.mirror + sheet.shine) * (by_source() ? weight : 1.0);
}

// Factor on the light that a turbid medium scatters inside a sheet.
vec3 lit_in(Sheet sheet) {
    return lit_on(sheet.normal, frame.up.xyz * mat3(frame.world), sheet.sun);
}

// The light from behind after a sheet (layer of water): the part that the sheet transmits, plus what it adds and
// reflects.
vec3 over(Sheet sheet, vec3 background) {
    vec4 c = through_medium(background, sheet.path, lit_in(sheet));
    return with_mirrored(sheet, c.rgb, vec2(c.a, 1.0));
}

// The back sheet (layer of water) where the front sheet covers it. Its refraction, reflection, highlight and contact
// with the scene fade near its edge, all but the refraction also where little air separates the sheets. Its thickness
// `t` has already been scaled by the amount of air.
Sheet behind(Surface surface, vec2 pixel, float t, float apart) {
    Sheet sheet = sheet_of(surface, pixel, t, vec3(0.0), false, false);
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    bool there = surface.covered > 0.0 && !(scene > 0.0 && surface.z >= scene);
    float share = there ? surface.found : 0.0;
    sheet.offset *= share;
    sheet.mirror *= share * apart;
    sheet.shine *= share * apart;
    sheet.wet *= share * apart;
    return sheet;
}

// The foam at a pixel.
struct Foam {
    float depth;  // of the frontmost foam; EMPTY where only its thickness is known
    float kept;   // transmittance
    float behind; // distance from the frontmost foam back to the middle of the visible foam, scene units
    vec3 color;
    float t;      // its thickness, scene units
    vec2 water;   // without a water sphere at the pixel: thickness of the water, in all and before the frontmost foam
    float sunk;   // eye depth of the submerged whitewater
    float own;    // share of the surface foam in what is hidden; the rest is the submerged whitewater's
};

// Slope per texel, to the right and down, of the quadratic B-spline of nine texels (three rows, top to bottom), at
// the offset f from the middle one. Plain differences would be constant in each texel, which would show because the
// texels stay in place on the screen while the water moves.
vec2 spline_slope(vec2 f, vec3 low, vec3 mid, vec3 high) {
    vec3 weights = vec3(0.5 * (0.5 - f.x) * (0.5 - f.x), 0.75 - f.x * f.x, 0.5 * (0.5 + f.x) * (0.5 + f.x));
    vec3 slopes = vec3(f.x - 0.5, -2.0 * f.x, f.x + 0.5);
    vec3 down = vec3(0.5 * (0.5 - f.y) * (0.5 - f.y), 0.75 - f.y * f.y, 0.5 * (0.5 + f.y) * (0.5 + f.y));
    vec3 falls = vec3(f.y - 0.5, -2.0 * f.y, f.y + 0.5);
    return vec2(dot(low, slopes), dot(low, weights)) * vec2(down.x, falls.x)
         + vec2(dot(mid, slopes), dot(mid, weights)) * vec2(down.y, falls.y)
         + vec2(dot(high, slopes), dot(high, weights)) * vec2(down.z, falls.z);
}

// The slope of `spline_slope`, from four gathers around the middle texel. Texels outside the frame are replaced by
// those at its edge, because the image may be larger than the frame.
vec2 spline_rise(vec2 middle, vec2 f, vec4 before, vec4 right, vec4 below, vec4 after) {
    bvec2 ends = greaterThanEqual(middle, frame.thick_extent.xy - 1.0);
    vec3 low = vec3(before.wz, ends.x ? before.z : right.z);
    vec3 mid = vec3(before.xy, ends.x ? before.y : right.y);
    vec3 high = ends.y ? mid : vec3(below.xy, ends.x ? below.y : after.y);
    return spline_slope(f, low, mid, high);
}

// Factor that shades the foam as a relief, whose height is the thickness of the front layer of foam. The factor is
// over 1 where the relief is turned to the sun, under 1 where it is turned away. Not in the thesis, whose foam is
// flat.
float relief(vec2 pixel, float z, float sun) {
    vec2 h = pixel / frame.thick_extent.z - 0.5;
    vec2 middle = floor(h + 0.5);
    vec2 texel = 1.0 / vec2(textureSize(foam_thickness, 0));
    vec4 before = textureGather(foam_thickness, middle * texel, 1);
    vec4 right = textureGather(foam_thickness, (middle + vec2(1.0, 0.0)) * texel, 1);
    vec4 below = textureGather(foam_thickness, (middle + vec2(0.0, 1.0)) * texel, 1);
    vec4 after = textureGather(foam_thickness, (middle + 1.0) * texel, 1);
    vec2 rise = spline_rise(middle, h - middle, before, right, below, after);
    vec2 slope = rise / (frame.thick_slope.xy * min(z, 0.5 * EMPTY));
    vec3 normal = normalize(vec3(-slope, 1.0));
    float turned = dot(normal, frame.sun_direction.xyz) - frame.sun_direction.z;
    return clamp(1.0 + sun * frame.foam_noise.z * turned, 0.3, 1.3);
}

// The foam texels around a pixel.
FoamTexels foam_seen(vec2 pixel) {
    return foam_texels(foam_depth, pixel, eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x));
}

// Whether a pixel without water shows foam, spray, whitewater particles or bubble foam.
bool beside(vec2 pixel) {
    return FOAM == 1u && foam_seen(pixel).depth < EMPTY || spray_at(ivec2(pixel));
}

// Mean of the depths of the frontmost foam in the four texels around the pixel, with the weights `foam.shown`. The
// least of the four depths would change in steps from pixel to pixel.
float foam_middle(FoamTexels foam) {
    vec4 w = mix(vec4(0.0), foam.shown, lessThan(foam.z, vec4(EMPTY)));
    float sum = w.x + w.y + w.z + w.w;
    return sum > 0.0 ? dot(w, mix(vec4(0.0), foam.z, greaterThan(w, vec4(0.0)))) / sum : foam.depth;
}

// Factor on the lace's strength for foam behind a pane of glass. There it is a cloud of bubbles in the water, and no
// layer of bubbles on its surface.
const float LACE_AT_PANE = 0.35;
// Range of the factor by which lace brightens its threads and darkens its holes.
const vec2 LACE_LIGHT = vec2(0.5, 1.2);

// Transmittance of foam with the lace pattern. `kept` is the transmittance of smooth foam; the mean over the pattern
// is close to it. Foam stays smooth where the largest cells of the pattern are less than two pixels wide. `much`
// becomes the density relative to smooth foam, which is more than 1 in a thread and less than 1 in a hole. `light`
// becomes the factor on the foam's colour, so that dense foam, which has no holes, still shows its bubbles.
// `strength`: factor on the pattern's strength.
float through_lace(vec2 pixel, float z, float strength, float kept, out float much, out float light) {
    vec3 at = (frame.world * vec4(z * vec3(ray_slope(pixel, frame.slope), -1.0), 1.0)).xyz / frame.foam_pattern.z;
    at -= LACE_WRAP * floor(at / LACE_WRAP + 0.5);
    float pixels = frame.foam_pattern.z / (z * frame.texel.x);
    float told = strength * frame.foam_pattern.y * smoothstep(2.0, 6.0, pixels);
    vec3 way = drift_at(pixel) * (frame.foam_pattern.w / frame.foam_pattern.z);
    float pore;
    float covered = laced(1.0 - kept, at, way, pixels, pore);
    light = clamp(1.0 - frame.foam_lace.x * told * pore, LACE_LIGHT.x, LACE_LIGHT.y);
    much = mix(1.0, covered / max(1.0 - kept, 0.05), told);
    return 1.0 - mix(1.0 - kept, covered, told);
}

// Distance from a pixel at which `shape_light` samples the depth of the foam around: in particle spacings, and its
// max in foam texels.
const vec2 SHAPE_REACH = vec2(6.0, 32.0);
const vec2 SHAPE_WAYS[4] = vec2[](vec2(1.0, 0.0), vec2(0.70710678), vec2(0.0, 1.0), vec2(-0.70710678, 0.70710678));
// Cosine of the angle between the foam's normal and the sun: at the first value foam is unlit, at the second fully
// lit. The range is wide because light scatters in foam.
const vec2 SHAPE_LIT = vec2(-0.5, 0.6);
// Fraction of its light that foam loses in the deepest hollow, where all eight samples around it are nearer to the eye
// by SHAPE_REACH.x particle spacings or more. In other hollows it loses less, in proportion.
const float SHAPE_HOLLOW = 0.6;

// By how much the foam at a point between texels is farther from the eye than depth z, clamped to ±reach. Texels
// without foam count as `reach`.
float foam_beyond(vec2 h, float z, float reach) {
    h = clamp(h, vec2(0.0), frame.thick_extent.xy - 1.0);
    vec2 base = min(floor(h), frame.thick_extent.xy - 2.0);
    vec2 f = h - base;
    vec4 near = textureGather(foam_depth, (base + 1.0) / vec2(textureSize(foam_depth, 0))).wzxy;
    vec4 beyond = clamp(near - z, -reach, reach);
    return mix(mix(beyond.x, beyond.y, f.x), mix(beyond.z, beyond.w, f.x), f.y);
}

// Factors on sunlight (x) and on all light (y), estimated from the shape of the foam around a pixel, so that a splash
// has a shaded side and dark hollows. Not in the thesis.
vec2 shape_light(vec2 pixel, float z) {
    float reach = SHAPE_REACH.x * frame.particle.y;
    vec2 texels = min(reach / (z * abs(frame.thick_slope.xy)), vec2(SHAPE_REACH.y));
    vec2 metres = texels * frame.thick_slope.xy * z;
    vec2 middle = pixel / frame.thick_extent.z - 0.5;
    vec2 slope = vec2(0.0);
    float hollow = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec2 way = SHAPE_WAYS[i & 3] * (i < 4 ? 1.0 : -1.0);
        float beyond = foam_beyond(middle + way * texels, z, reach);
        slope += way * beyond;
        hollow += max(-beyond, 0.0);
    }
    // The squares of either coordinate of eight points on the unit circle sum to 4: hence a quarter of the sum.
    vec3 normal = normalize(vec3(0.25 * slope / metres, 1.0));
    return vec2(smoothstep(SHAPE_LIT.x, SHAPE_LIT.y, dot(normal, frame.sun_direction.xyz)),
                1.0 - SHAPE_HOLLOW * hollow / (8.0 * reach));
}

// The surface foam at a pixel (thesis Sec. 3.2.3). Its colour goes from the back colour to the front colour as the
// foam in the front layer, a range of depth right behind the frontmost foam, becomes thicker (Listing A.20; Eq. 3.9
// swaps the two colours). Each sprite of foam has the visibility of the sun at its centre, and the pixel takes the
// mean over the sprites of the front layer. (The thesis evaluates the visibility at the mean of nine depths.) A
// shadow with an edge inside a sprite would show the sprite's outline. `pane`: depth of the pane of glass that the water
// is flush with, 0 without one, and distance from its plane per depth.
Foam foam_of(vec2 pixel, FoamTexels texels, bool dry, vec2 pane) {
    Foam foam;
    vec4 t = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        t += texels.weights[i] * texelFetch(foam_thickness, foam_texel(texels, i), 0);
    }
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    int shown = dry ? 4 : 0;
    foam.water = vec2(0.0);
    for (int i = 0; i < shown; ++i) {
        foam.water += texels.shown[i] * texelFetch(thickness, foam_texel(texels, i), 0).xy;
    }
    foam.sunk = 0.0;
    foam.own = 1.0;
    foam.t = t.x;
    foam.depth = texels.depth;
    // In the thesis all foam lies at the depth of the frontmost.
    float far = by_source() || frame.medium_a.w > 0.5 || t.x == 0.0 ? 0.0 : min(t.w / t.x, 0.999);
    // Converts lengths along z to lengths along the ray, as for water.
    float along = length(vec3(ray_slope(pixel, frame.slope), 1.0));
    // Very thin foam counts as none: a veil would look like steam.
    foam.kept = exp(-frame.foam.x * along * t.x * smoothstep(0.0, frame.foam_noise.w, t.x));
    float local = 1.0; // density relative to smooth foam
    float light = 1.0;
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool there = t.x > 0.0 && texels.depth < EMPTY;
    float z = foam_middle(texels);
    float aerated = frame.foam_aerated.w * (1.0 - foam.kept);
    bool torn = frame.foam_pattern.y > 0.0 && there;
    // Foam of particles that stick out through a pane is behind it, too. The pattern lies in the pane's plane: the
    // foam's depth varies from pixel to pixel.
    bool glazed = pane.x > 0.0 && (pane.x - z) * pane.y < FLUSH.y * frame.particle.y;
    while (torn) {
        float strength = glazed ? LACE_AT_PANE : 1.0;
        foam.kept = through_lace(pixel, glazed ? pane.x : z, strength, foam.kept, local, light);
        torn = false;
    }
    // `middle`: distance of the foam's middle behind the frontmost foam. `far / (1 − far)` is this distance in
    // spacings, less its first spacing. The factor adds that spacing to distant foam (`far` near 1), so that foam
    // keeps its depth when it becomes the frontmost. Dense foam is seen at its front, which lies before its middle by
    // the thickness of the foam.
    float middle = frame.particle.y * far * (1.0 + 1.0 / (1.0 - far));
    foam.behind = max(middle - t.x * (1.0 - foam.kept), 0.0);
    // Weight of the front colour. `power` above 0 selects the thesis program's other rule: this power of the front
    // layer's relative thickness.
    float power = frame.foam_front.w;
    float part = clamp(t.y / max(frame.foam.w, 1.0e-9), 1.0e-6, 1.0);
    float much = power > 0.0 ? pow(part, power) : 1.0 - exp(-frame.foam.y * along * t.y * local);
    foam.color = mix(frame.foam_back.rgb, frame.foam_front.rgb, much);
    float sun = SHADOW == 1u ? past_scene(vec3(0.0), pixel) : 1.0;
    sun *= (SHADOW > 1u || CAST == 1u) && t.y > 0.0 ? clamp(t.z / t.y, 0.0, 1.0) : 1.0;
    vec2 shape = vec2(1.0);
    bool shaped = frame.foam_octaves.w > 0.0 && there;
    while (shaped) {
        shape = mix(shape, shape_light(pixel, z), frame.foam_octaves.w);
        shaped = false;
    }
    vec3 lit = under(vec3(sun * shape.x));
    foam.color *= lit * (shape.y * light * relief(pixel, foam.depth, sun));
    // Water under foam is milky with bubbles, also where the lace is open.
    float covered = 1.0 - foam.kept;
    foam.kept *= 1.0 - aerated;
    foam.color = mix(frame.foam_aerated.rgb * lit, foam.color, covered / max(1.0 - foam.kept, 1.0e-6));
    return foam;
}

// Returns the radiance of whitewater particles (Akinci et al. 2013, Sec. 2.5). `light`: rgb the light that reaches
// them, w the strength of the shadow on them.
vec3 whitewater_color(vec4 light) {
    vec3 shadow = clamp(light.w * frame.whitewater_shadow.rgb, 0.0, 1.0);
    vec3 whole = frame.whitewater_color.rgb * light.rgb;
    return frame.whitewater_light.z > 0.5 ? max(min(whole, 1.0) - shadow, 0.0) : whole * (1.0 - shadow);
}

// Adds the whitewater particles behind the water's surface, at their mean depth.
Foam with_submerged(Foam foam, ivec2 pixel, float front) {
    vec3 thick = texelFetch(whitewater_thickness, pixel, 0).xyz;
    float kept = 1.0 - intensity_of(thick.y);
    float far = thick.y > 0.0 ? min(thick.z / thick.y, 0.999) : 0.0;
    vec3 color = whitewater_color(texelFetch(whitewater_light, pixel, 0));
    // The two kinds of foam are mixed by their opacities.
    foam.own = kept < 1.0 ? (1.0 - foam.kept) / (2.0 - foam.kept - kept) : 1.0;
    foam.sunk = front + frame.particle.y * far / (1.0 - far);
    foam.color = mix(color, foam.color, foam.own);
    foam.kept *= kept;
    return foam;
}

// Light after a sheet (layer of water) that contains foam. `z` is the depth of the sheet's surface. Along z the sheet
// has a thickness of `t`, of which the part `before` lies in front of the frontmost foam. Only where there is such
// water does the surface reflect over the foam. All foam is placed at its middle depth, with the water before that
// over it. If it were placed at the frontmost foam, a thin veil at the surface would lift foam from deep below to the
// surface, within the veil's outline. In the thesis all foam lies at the depth of the frontmost.
vec3 over_with(Sheet sheet, float z, float before, float t, Foam foam, vec3 background) {
    // Particle foam in front of the surface lies over it.
    float first = FOAM == 0u || before >= t ? 1.0 : smoothstep(0.0, 0.25 * frame.particle.x, before);
    first = by_source() ? 1.0 : first;
    // `apart`: gap by which the frontmost foam lies before the water's surface. The gap holds no water, so it is
    // subtracted from the foam's distance `behind`. Its first four spacings do not count: within the width of a drop
    // a pixel may show no sphere of the drop.
    float apart = max(z - foam.depth - 4.0 * frame.particle.y, 0.0);
    before += max(foam.behind - apart, 0.0);
    if (WHITEWATER == 1u) {
        before = mix(max(foam.sunk - z, 0.0), before, foam.own);
    }
    float share = t > 0.0 ? clamp(before / t, 0.0, 1.0) : 0.0;
    vec3 lit = lit_in(sheet);
    vec3 c = through_medium(background, sheet.path * (frame.target.z >= BACK_WATER ? 1.0 - share : 0.0), lit).rgb;
    c = mix(c, sheet.mirrored, sheet.mirror * (1.0 - first)) + sheet.shine * (1.0 - first);
    c = mix(foam.color, c, foam.kept);
    vec4 all = through_medium(c, sheet.path * (frame.target.z >= FRONT_WATER ? share : 0.0), lit);
    sheet.mirror *= first;
    sheet.shine *= first;
    return with_mirrored(sheet, all.rgb, vec2(all.a, foam.kept));
}

// A sheet (layer of water) with foam in it: the larger the share of foam, the weaker the refraction, reflection and
// highlight of its surface. The water that is left of a particle that turns into foam is no drop, and its reflections
// would flicker in single pixels.
Sheet among(Foam foam, float t, Sheet sheet) {
    float whole = by_source() ? 1.0 : smoothstep(0.5, 1.0, t / max(t + foam.t, 1.0e-9));
    sheet.offset *= whole;
    sheet.mirror *= whole;
    sheet.shine *= whole;
    return sheet;
}

// Water around foam at a pixel that shows no sphere of water: it has no surface and only absorbs. It ends at the
// scene.
Sheet between(Foam foam, vec2 pixel, float t) {
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    t = scene > 0.0 && foam.depth < 0.5 * EMPTY ? min(t, max(scene - foam.depth, 0.0)) : t;
    Sheet sheet = NO_SHEET;
    sheet.path = t * length(vec3(ray_slope(pixel, frame.slope), 1.0));
    return sheet;
}

#include "exit.glsl"

// Blends a surface with that of the next coarser level.
Surface towards(Surface surface, Surface other, float fade) {
    surface.z = mix(surface.z, other.z, fade);
    surface.dz = mix(surface.dz, other.dz, fade);
    surface.found = mix(surface.found, other.found, fade);
    surface.widened = surface.widened || other.widened;
    return surface;
}

// The front water surface at a pixel, and the light that this surface itself sends to the eye: its reflection and the
// sun's highlight.
struct Face {
    float z;      // depth
    float mirror; // reflectance: the rest of the light comes from below
    vec3 light;   // reflection times reflectance, plus the sun highlight
};

// Colour of scene, water and foam at the position `pixel` in pixels (the centre of a pixel is at +0.5), and the water
// surface there.
vec3 layers_at(vec2 pixel, float front, out Face face) {
    float threshold = frame.surface.w;
    vec2 slope = ray_slope(pixel, frame.slope);
    float fade = 0.0;
    uint shown = NEAR == 1u ? shown_level(nearness(front, slope), fade) : 0u;
    Level level = levels.level[shown];
    Surface surface = surface_at(level, pixel, front, threshold);
    ivec2 base;
    vec4 weights;
    vec2 all = thickness_at(surface, level, pixel, threshold, base, weights);
    float t = all.x;
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool fading = NEAR == 1u && fade > 0.0;
    while (fading) {
        surface = towards(surface, surface_at(levels.level[shown + 1u], pixel, front, threshold), fade);
        fading = false;
    }

    Sheet back = NO_SHEET;
    float beyond = 0.0; // depth of the back sheet
    float boundary = SHEETS == 2u ? boundary_at(ivec2(pixel)) : EMPTY;
    bool covers = false;
    vec2 share = vec2(0.0);
    if (boundary < EMPTY) {
        vec4 thick = sheet_thickness(base, weights, front, boundary);
        t = thick.x;
        covers = front < boundary && thick.z > 0.0;
        share = covers ? thick.yz : thick.yw;
    }
    if (SHEETS == 2u) {
        // The back sheet (farther layer of water) is smoothed at half resolution, so its first level corresponds to
        // the front sheet's second.
        uint behind_shown = NEAR == 1u ? shown_level(nearness(covers ? boundary : front, slope), fade) : 0u;
        fade = behind_shown > 0u ? fade : 0.0;
        behind_shown = BACK + max(behind_shown, 1u) - 1u;
        Surface other = surface_at(levels.level[behind_shown], pixel, covers ? -boundary : front, threshold);
        bool fading = NEAR == 1u && fade > 0.0;
        while (fading) {
            Surface next = surface_at(levels.level[behind_shown + 1u], pixel, covers ? -boundary : front, threshold);
            other.covered = mix(other.covered, next.covered, fade);
            other = towards(other, next, fade);
            fading = false;
        }
        if (covers) {
            // Where the air between the two sheets (layers of water) is thinner than four spacings they become one
            // gradually, so that the coarse cells from which their boundary is found do not show.
            float open = smoothstep(1.0, 4.0, (other.z - surface.z - t) / frame.particle.y);
            open = other.covered > 0.0 ? open : 1.0;
            t += (1.0 - open) * share.y;
            share *= open;
            back = behind(other, pixel, share.y, share.x);
            beyond = other.covered > 0.0 ? mix(surface.z, other.z, share.x) : 0.0;
        }
        // The reduction widens a near surface by one texel over the surface behind it. The pixel shows the one behind
        // again; otherwise it leaves rims. Between the spheres of a front sheet it shows the back sheet only as far
        // as there is air: where both are one, the gap is closed.
        float lost = covers || !surface.widened ? 0.0 : (1.0 - surface.found) * other.found;
        lost *= boundary < EMPTY ? share.x : 1.0;
        surface.z = mix(surface.z, other.z, lost);
        surface.dz = mix(surface.dz, other.dz, lost);
        surface.found += lost;
    }

    // Water thinner than one layer of particles is a drop: it has the slope of its particle's sphere, unsmoothed.
    float drop = 1.0 - smoothstep(0.6 * frame.particle.y, 0.9 * frame.particle.y, t);
    surface.dz = mix(surface.dz, drop_slope(ivec2(pixel), front, threshold), drop);
    Surface particles = surface;
    float across;
    bool at_pane = flush(surface, slope, across);
    // The water's far surface stays where it is.
    float filled = max(particles.z - surface.z, -t);
    t += filled;
    face = Face(surface.z, 0.0, vec3(0.0));
    // `ripple`, the surface noise, is only for the front sheet (layer of water): it belongs to the particles there.
    vec3 ripple = NOISE == 1u && !at_pane ? ripple_at(pixel, front, threshold) : vec3(0.0);
    Sheet sheet = sheet_of(surface, pixel, t, ripple, at_pane, true);
    Foam foam;
    bool past = false;
    bool behind_boundary = false;
    if (FOAM == 1u) {
        foam = foam_of(pixel, foam_seen(pixel), front >= EMPTY, vec2(at_pane ? surface.z : 0.0, across));
        behind_boundary = foam.depth >= boundary;
        // `past`: the pixel lies between the spheres of the front sheet (the nearer layer of water) and shows the
        // back sheet. Of the front sheet only the foam is then drawn, with the water in this foam. With SHEETS = 1
        // `past` is false at compile time, so a CPU driver skips the code that depends on it.
        past = SHEETS == 2u && !behind_boundary && front >= boundary && front < EMPTY;
        // Of the water that fills the gap to a pane, foam has that part before it which lies before its own depth.
        float before = filled > 0.0 ? clamp(foam.depth - surface.z, 0.0, filled) : filled;
        all.y = past ? all.y : max(all.y + before, 0.0);
        // Foam behind the air between two sheets belongs to the back sheet.
        if (covers && behind_boundary) {
            back = among(foam, share.y, back);
        } else if (!past) {
            sheet = among(foam, t, sheet);
        }
    } else if (WHITEWATER == 1u) {
        foam = Foam(front, 1.0, 0.0, vec3(0.0), 0.0, vec2(0.0), front, 1.0);
    }
    if (WHITEWATER == 1u) {
        foam = with_submerged(foam, ivec2(pixel), front);
    }
    vec2 offset = bent(sheet.offset + back.offset);
    // Loops instead of branches, for CPU drivers (docs/performance.md).
    bool submerged = EXIT > 0u && max(sheet.wet, back.wet) > 0.0 && surface.z < 0.5 * EMPTY && !by_source();
    while (submerged) {
        Sheet last = sheet;
        if (back.wet > 0.0) {
            last = back;
        }
        float touches;
        vec2 bed = bed_offset(last, pixel, touches);
        sheet.wet *= touches;
        back.wet *= touches;
        offset = mix(offset, bed, last.wet * touches);
        submerged = false;
    }
    bool prism = EXIT > 0u && SHEETS == 2u && covers && back.wet > 0.0 && !by_source();
    while (prism) {
        offset = bent(offset + back.wet * prism_offset(pixel, particles.z, beyond));
        prism = false;
    }
    vec3 c = refracted(pixel, offset, max(surface.z, beyond));
    c = under_water(back, under_water(sheet, c));
    Exit way = Exit(1.0, vec3(0.0), c, sheet.path);
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool open = EXIT > 0u && sheet.thick > 0.0 && surface.z < 0.5 * EMPTY && sheet.wet < 1.0 && !by_source();
    while (open) {
        way = exit_of(sheet, particles, pixel, c, covers, covers ? back.wet : 0.0);
        c = way.scene;
        sheet.path = way.path;
        open = false;
    }
    sheet = in_view(sheet);
    back = in_view(back);
    face.mirror = front < EMPTY && !by_source() ? sheet.mirror : 0.0;
    face.light = front < EMPTY ? sheet.mirror * sheet.mirrored + sheet.shine : vec3(0.0);
    if (FOAM + WHITEWATER == 0u) {
        sheet.path *= frame.target.z >= FRONT_WATER ? 1.0 : 0.0;
        back.path *= frame.target.z >= BACK_WATER ? 1.0 : 0.0;
        if (front >= EMPTY) {
            return scene_at(pixel);
        }
        if (back.path > 0.0) {
            c = over(back, c);
        }
        return over(sheet, opened(way, c));
    }
    foam.kept = frame.target.z >= FOAM_TOO ? foam.kept : 1.0;
    bool dry = front >= EMPTY;
    if (dry && FOAM == 0u) {
        return scene_at(pixel);
    }
    if (dry) {
        c = scene_at(pixel);
        way = Exit(1.0, vec3(0.0), c, 0.0);
        all = foam.water;
        t = all.x;
        sheet = between(foam, pixel, t);
        surface.z = foam.depth;
    }
    // Weighted by the amount of air: without air both sheets are one.
    float behind_air = covers && behind_boundary ? share.x : 0.0;
    vec3 apart = c;
    if (past && share.y > 0.0) {
        behind_air = share.x;
        Sheet behind = sheet;
        behind.path *= frame.target.z >= BACK_WATER ? 1.0 : 0.0;
        Sheet first = between(foam, pixel, share.y);
        apart = over_with(first, foam.depth, min(all.y, share.y), share.y, foam, over(behind, opened(way, c)));
    } else if (behind_air > 0.0) {
        Sheet whole = sheet;
        whole.path *= frame.target.z >= FRONT_WATER ? 1.0 : 0.0;
        apart = over(whole, opened(way, over_with(back, beyond, max(all.y - t, 0.0), share.y, foam, c)));
    }
    back.path *= frame.target.z >= BACK_WATER ? 1.0 : 0.0;
    c = opened(way, back.path > 0.0 ? over(back, c) : c);
    vec3 seen = mix(over_with(sheet, surface.z, min(all.y, t), t, foam, c), apart, behind_air);
    return dry && foam.depth >= EMPTY ? c : seen;
}

// Adds bubble foam that lies in the water. Pass `soap` has already dimmed the foam by the water before it and added
// that water's light. Where no foam covers, `c` is left; where it covers, the light of the front surface itself is
// kept. (`shade` adds bubble foam before the water.)
vec3 with_soap(vec3 c, vec4 over, Face face) {
    return c * (1.0 - over.a) + over.a * face.light + (1.0 - face.mirror) * over.rgb;
}

// Self-shadowing of spray on the screen: distance of the nearest sample in picture heights, number of samples at
// doubling distances, bias that is added to the optical depth before its logarithm, and ratio of the loss of skylight
// to that of sunlight.
const float RELIEF_NEAR = 1.0 / 360.0;
const int RELIEF_OCTAVES = 5;
const float RELIEF_THIN = 0.3;
const float RELIEF_OF_SKY = 0.19;
// Largest half float.
const float MOST_HALF = 65504.0;

// Light on spray, relative to that in full sun: the factor on `frame.spray_color`. `droplets`: x the optical depth, y
// the same weighted by sunlight (spray.frag). Spray is darker where the spray next to it on the screen, in the sun's
// direction, is denser, and brighter where that spray is thinner.
vec3 light_of_spray(vec2 pixel, vec2 droplets) {
    // Half floats may have overflowed to infinity, which would give NaN.
    droplets = min(droplets, MOST_HALF);
    float lit = droplets.x > 0.0 ? droplets.y / droplets.x : 1.0;
    float relief = frame.spray_mist.w;
    for (bool go = relief > 0.0 && droplets.x > 0.0; go; go = false) {
        vec2 to = frame.sun_direction.xy / frame.slope.xy;
        to *= RELIEF_NEAR * frame.extent.y * inversesqrt(max(dot(to, to), 1.0e-12));
        float denser = 0.0;
        for (int i = 0; i < RELIEF_OCTAVES; ++i) {
            ivec2 there = clamp(ivec2(pixel + to * float(1 << i)), ivec2(0), ivec2(frame.extent.xy) - 1);
            denser += log(RELIEF_THIN + min(texelFetch(spray, there, 0).x, MOST_HALF));
        }
        denser = denser / float(RELIEF_OCTAVES) - log(RELIEF_THIN + droplets.x);
        // Relief brightens spray up to full sunlight; only glints are brighter.
        lit = clamp(lit * exp(-relief * denser), 0.0, max(lit, 1.0));
    }
    return under(vec3(lit)) * (1.0 - RELIEF_OF_SKY * relief * max(1.0 - lit, 0.0));
}

// All layers at a pixel that shows water, foam or spray. Spray lies over the other layers, except that bubble foam
// before the water lies over the spray.
vec3 shade(vec2 pixel, float front) {
    Face face;
    vec3 c = layers_at(pixel, front, face);
    vec4 over = vec4(0.0);
    bool sunk = false;
    if (SOAP == 1u) {
        over = frame.target.z >= FOAM_TOO ? texelFetch(soap, ivec2(pixel), 0) : vec4(0.0);
        sunk = texelFetch(soap_depth, ivec2(pixel), 0).x > face.z;
        c = sunk ? with_soap(c, over, face) : c;
    }
    if (SHORE == 1u && frame.target.z >= FOAM_TOO) {
        float amount = texelFetch(shore_foam, ivec2(pixel), 0).w;
        // The visibility of the sun in the foam's image belongs to the host's water surface behind. Contact foam on
        // the particles' water needs that at its own surface, computed here.
        float lost = 0.0;
        for (bool go = SHADOW + CAST > 0u && amount > 0.0; go; go = false) {
            lost = sun_lost(face.z * vec3(ray_slope(pixel, frame.slope), -1.0), pixel);
        }
        c = with_contact(c, amount, lost, coat_light());
    }
    if (WHITEWATER == 1u && frame.target.z >= FOAM_TOO) {
        float over = intensity_of(texelFetch(whitewater_thickness, ivec2(pixel), 0).x);
        c = mix(c, whitewater_color(texelFetch(whitewater_light, ivec2(pixel), 0)), over);
    }
    if (SPRAY == 1u) {
        vec2 droplets = texelFetch(spray, ivec2(pixel), 0).xy;
        float kept = frame.target.z >= WHOLE ? exp(-droplets.x) : 1.0;
        vec3 light = light_of_spray(pixel, droplets) * frame.spray_color.rgb;
        c = c * mix(kept, 1.0, frame.spray_color.w) + light * (1.0 - kept);
    }
    return SOAP == 1u && !sunk ? c * (1.0 - over.a) + over.rgb : c;
}
