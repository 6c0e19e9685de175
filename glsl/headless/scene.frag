#version 460
// Pass `scene`: shades opaque meshes under sky and sun. Materials are Lambert and GGX (Walter et al. 2007, visibility
// of Hammon 2017). The visibility of the sun comes from a shadow map. The sky's irradiance, from spherical harmonics,
// is multiplied by the baked visibility of the sky. Light from other surfaces is baked per vertex. Patterns are
// procedural in the mesh's own frame, or in the world's if the mesh is not rotated, and filtered by the footprint of
// the pixel: lines by the exact fraction that they cover, noise by omitting octaves that are too fine.
// Reads: the scene's block, shadow map, environment, irradiance, texture. Writes: scene colour.

#include "../headless/scene.glsl"
#include "../headless/noise.glsl"
#include "../headless/light.glsl"
#include "../headless/sea.glsl"

const uint PLAIN = 0;
const uint TILES = 1;
const uint PLANKS = 2;
const uint CONCRETE = 3;
const uint STONE = 4;
const uint SAND = 5;
const uint PAVING = 6;
const uint ISLAND = 7;
const uint ROCK = 8;
const uint LEAVES = 9;
const uint FOLIAGE = 10;
const uint LAWN = 11;
const uint RIPPLES = 12;

// Parts of the scene.
const uint MESH = 0;
const uint GROUND = 1;   // fades into the sky

layout(constant_id = 0) const uint PATTERN = PLAIN;
layout(constant_id = 1) const uint PART = MESH;
layout(constant_id = 2) const uint TEXTURED = 0;

layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;
layout(set = 0, binding = 6) uniform sampler2D shadow_depth; // the same, without comparison
layout(set = 0, binding = 4) uniform sampler2D base_texture;
layout(push_constant, std430) uniform Push {
    vec4 turn;      // rotation of the mesh's frame (quaternion); identity for a mesh that is not rotated
    vec4 origin;    // origin of the mesh's frame (world); 0 for a mesh that is not rotated
    vec4 color;     // base colour, roughness
    vec4 pattern;   // x: size, or height of the beach above the sea (m). y: height of the tiles' band (m), -1e6: none.
                    // z is 1 for meshes of the backdrop, whose visibility of the sun is baked per vertex, else 0.
                    // w is 1 for stone in blocks, else 0.
} push;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 light;  // visible fraction of the sky; sunlight bounced off other surfaces
layout(location = 4) in vec4 around; // albedo of the visible other surfaces; bulge, or the backdrop's visibility of the sun

layout(location = 0) out vec4 color;

struct Surface {
    vec3 albedo;
    float roughness;
    vec3 tilt; // added to the normal, in the mesh's frame
};

// The inverse of the rotation by a quaternion.
vec3 unturn(vec3 v) {
    vec3 q = -push.turn.xyz;
    return v + 2.0 * cross(q, cross(q, v) + push.turn.w * v);
}

vec3 turn(vec3 v) {
    vec3 q = push.turn.xyz;
    return v + 2.0 * cross(q, cross(q, v) + push.turn.w * v);
}

// Fraction of a footprint around x that is covered by lines of this width, one centred on each integer.
float lines(float x, float width, float footprint) {
    footprint = max(footprint, 1.0e-4);
    vec2 ends = x + 0.5 * width + vec2(-0.5, 0.5) * footprint;
    vec2 covered = floor(ends) * width + min(fract(ends), width);
    return clamp((covered.y - covered.x) / footprint, 0.0, 1.0);
}

// Glazed tiles with grout, each with its own shade; one row is a darker band.
Surface tiles(vec2 q, vec2 footprint, float height) {
    float size = push.pattern.x;
    q /= size;
    footprint /= size;
    const float joint = 0.055;
    float grout = 1.0 - (1.0 - lines(q.x, joint, footprint.x)) * (1.0 - lines(q.y, joint, footprint.y));
    ivec2 id = ivec2(floor(q));
    float wide = max(footprint.x, footprint.y);
    float one = kept(wide, 0.8);
    float shade = hash(ivec3(id, 7)) - 0.5;
    float hue = hash(ivec3(id, 31)) - 0.5;
    vec3 tile = push.color.rgb * (1.0 + one * (0.34 * shade + vec3(-0.14, 0.0, 0.09) * hue));
    // The glaze is thin at the edges and thick in the middle.
    vec2 in_tile = abs(fract(q) - 0.5) * 2.0;
    tile *= 1.0 - one * 0.10 * pow(max(in_tile.x, in_tile.y), 4.0);
    if (floor(height / size) == floor(push.pattern.y / size)) {
        tile *= vec3(0.45, 0.56, 0.60);
    }
    Surface s;
    s.albedo = mix(tile, vec3(0.50, 0.48, 0.43), grout);
    s.roughness = mix(push.color.a, 0.85, grout);
    vec2 tip = vec2(hash(ivec3(id, 3)), hash(ivec3(id, 5))) - 0.5;
    s.tilt = vec3(0.03 * one * (1.0 - grout) * tip, 0.0);
    return s;
}

// Sawn boards along x: fibres, swirls around knots, a dark gap between boards.
Surface planks(vec3 p, vec3 n, vec2 footprint, float width) {
    float size = push.pattern.x;
    bool end = n.x > max(n.y, n.z);
    float across = n.y > n.z ? p.z : p.y;
    float step_across = footprint.y;
    float gap = end ? 0.0 : lines(across / size, 0.035, step_across / size);
    float board = floor(across / size);
    float seed = hash(ivec3(int(board), 11, n.y > n.z ? 1 : 2));
    vec3 q = vec3(p.x * 0.06, p.y, p.z) + 3.7 * seed;
    float bend = octaves(p * vec3(0.35, 1.0, 1.0) + 9.0 * seed, 2.2, 2, width);
    float fibre = octaves(q + vec3(0.0, 0.05, 0.05) * bend, 38.0, 3, step_across);
    float wear = octaves(p, 2.5, 2, width);
    vec3 tone = push.color.rgb * (1.0 + 0.32 * (seed - 0.5) + 0.55 * fibre + 0.22 * wear);
    // Weathered wood goes grey.
    tone = mix(tone, vec3(dot(tone, vec3(0.3, 0.5, 0.2))), clamp(0.30 + 0.5 * wear + 0.3 * (seed - 0.5), 0.0, 0.8));
    Surface s;
    s.albedo = mix(tone, tone * 0.22, gap);
    s.roughness = push.color.a;
    s.tilt = vec3(0.0);
    return s;
}

// Cast concrete: clouds, grain, pores; on upright faces also streaks, and damp at the foot.
Surface concrete(vec3 p, vec3 n, float width) {
    float cloud = octaves(p, 1.7, 4, width);
    float grain = octaves(p + 31.0, 55.0, 2, width);
    float streak = n.y < 0.5 ? octaves(vec3(p.x, 0.12 * p.y, p.z) + 7.0, 9.0, 2, width) : 0.0;
    // Air bubbles at the formwork: one in some of the 4 cm cells.
    ivec3 cell = ivec3(floor(p * 25.0));
    vec3 place = vec3(hash(cell), hash(cell + 101), hash(cell + 211));
    float size = 0.02 + 0.14 * place.x * place.x;
    float pore = 1.0 - smoothstep(size, size + 0.04 + 25.0 * width, distance(fract(p * 25.0), 0.2 + 0.6 * place));
    pore *= step(place.y, 0.6) * min(1.0, size / (25.0 * width + 1.0e-4));
    float damp = exp(-max(position.y - scene.shadow_texel.w, 0.0) * scene.air.y / 0.10) * (n.y < 0.5 ? 1.0 : 0.0);
    Surface s;
    s.albedo = push.color.rgb * (1.0 + 0.30 * cloud + 0.16 * grain + 0.20 * streak) * (1.0 - 0.45 * pore);
    s.albedo *= 1.0 - damp * vec3(0.30, 0.27, 0.32) * (0.8 + cloud);
    s.roughness = push.color.a;
    s.tilt = 0.05 * vec3(grain, 0.0, -grain);
    return s;
}

// Dressed stone in courses, warm and cool veins.
Surface stone(vec3 p, vec3 n, vec2 footprint, float width) {
    float size = push.pattern.x;
    // If the stone is in blocks, they lie in courses (level rows) that begin at the ground, and the vertical joints
    // of each course are offset from those of the next.
    bool blocks = push.pattern.w > 0.5;
    float row = p.y - (blocks && scene.shadow_texel.w > -1.0e8 ? scene.air.y * scene.shadow_texel.w : 0.0);
    float course = floor(row / size);
    float joint = n.y < 0.6 ? lines(row / size, 0.012 / size, footprint.y / size) : 0.0;
    float seed = hash(ivec3(int(course), 3, 9)) - 0.5;
    if (blocks && n.y < 0.6) {
        float wide = size * (1.9 + 0.5 * seed);
        float along = (n.x > n.z ? p.z : p.x) / wide + 0.5 * course + 0.4 * seed;
        joint = max(joint, lines(along, 0.009 / wide, footprint.x / wide));
        seed = 0.75 * (hash(ivec3(int(floor(along)), int(course), n.x > n.z ? 11 : 12)) - 0.5);
    }
    float cloud = octaves(p + 5.0 * seed, 2.3, 4, width);
    float strata = octaves(vec3(p.x, 5.0 * p.y, p.z) + 11.0 * seed, 5.0, 3, width);
    float grain = octaves(p, 70.0, 2, width);
    vec3 tone = push.color.rgb * (1.0 + 0.18 * seed + 0.30 * cloud + 0.22 * strata + 0.22 * grain);
    tone *= 1.0 + vec3(0.07, 0.0, -0.09) * (cloud + seed);
    Surface s;
    s.albedo = mix(tone, tone * (blocks ? 0.55 : 0.35), joint);
    s.roughness = push.color.a;
    s.tilt = 0.08 * vec3(grain, 0.0, cloud);
    return s;
}

Surface sand(vec3 p, float width) {
    float large = octaves(p, 0.35, 3, width);
    float small = octaves(p + 17.0, 9.0, 2, width);
    float grain = kept(width, 130.0) * noise(p * 130.0);
    Surface s;
    s.albedo = push.color.rgb * (1.0 + 0.22 * large + 0.14 * small + 0.16 * grain);
    s.albedo *= 1.0 + vec3(0.03, 0.0, -0.05) * large;
    s.roughness = push.color.a;
    s.tilt = vec3(0.04 * small, 0.0, 0.04 * large);
    return s;
}

// How wet stone or paving is at a place in the world: 0 dry, 1 under a film of water. There are wet patches, fewer
// the farther they are from the basin that splashes, and single splashes.
float wetness(vec3 at, float width) {
    vec4 box = scene.splashed;
    vec2 out_of = max(max(box.xy - at.xz, at.xz - box.zw), 0.0);
    float away = scene.air.y * length(out_of);
    int near = box.x <= box.z && away < 3.0 ? 1 : 0;
    float wet = 0.0;
    for (int k = 0; k < near; ++k) {
        vec3 p = scene.air.y * at;
        float patchy = octaves(p + 13.0, 0.55, 3, width) + 0.5 * octaves(p + 29.0, 2.7, 3, width);
        wet = smoothstep(0.0, 0.45, 0.45 - 0.8 * away + 1.15 * patchy);
        // A splash in some of the cells.
        vec2 q = p.xz * 7.0;
        ivec3 cell = ivec3(floor(q), 5);
        vec2 middle = 0.3 + 0.4 * vec2(hash(cell), hash(cell + 57));
        float size = 0.04 + 0.22 * pow(hash(cell + 91), 4.0);
        float round = distance(fract(q), middle) + 0.12 * noise(q * 5.0, 3);
        float drop = step(hash(cell + 131), 0.30 * exp(-1.1 * away)) * (1.0 - smoothstep(size - 0.05, size + 0.03 + 7.0 * width, round));
        wet = max(wet, 0.5 * drop);
    }
    return wet;
}

// Changes a stone's albedo and roughness by its wetness `wet`, 0 to 1. It gets darker, because light is reflected
// back inside the film of water (Lekner and Dorf 1988: 0.07 of the light is reflected going in, 0.47 of the diffuse
// light coming out), and shinier, because a film is smooth; on slopes (`level` below 1) the film runs off.
Surface wetted(Surface s, float wet, float level) {
    vec3 under = 0.93 * 0.53 * s.albedo / (1.0 - 0.47 * s.albedo);
    float damp = min(1.1 * wet, 0.75);
    // Water runs off from edges.
    float film = smoothstep(0.55, 1.0, wet) * smoothstep(0.96, 0.99, level);
    s.albedo = mix(s.albedo, under, damp);
    s.roughness = mix(mix(s.roughness, 0.5, damp), 0.16, film);
    s.tilt *= 1.0 - 0.85 * film;
    return s;
}

// Slabs in a running bond, worn, with sandy joints.
Surface paving(vec2 q, vec2 footprint, vec3 p, float width) {
    float size = push.pattern.x;
    q /= size;
    footprint /= size;
    const float joint = 0.022;
    float row = floor(q.y);
    q.x = q.x / 1.5 + 0.5 * row + 0.23 * hash(ivec3(int(row), 1, 2));
    footprint.x /= 1.5;
    float gap = 1.0 - (1.0 - lines(q.x, joint / 1.5, footprint.x)) * (1.0 - lines(q.y, joint, footprint.y));
    float one = kept(max(footprint.x, footprint.y), 0.7);
    ivec3 slab = ivec3(int(floor(q.x)), int(row), 13);
    float seed = hash(slab) - 0.5;
    float warm = hash(slab + ivec3(0, 0, 4)) - 0.5;
    float large = octaves(p, 0.22, 4, width);
    float cloud = octaves(p + 9.0 * seed, 6.0, 3, width);
    float grain = octaves(p, 90.0, 2, width);
    // Some slabs were laid later, or come from another bed of rock. Veins run through each slab in its own direction.
    // Drips and trodden dirt leave stains, and there is dirt in the joints and beside them.
    float other = step(0.84, hash(slab + ivec3(0, 0, 10)));
    float turn = 6.28 * hash(slab + ivec3(0, 0, 21));
    vec2 along = vec2(cos(turn) * p.x + sin(turn) * p.z, cos(turn) * p.z - sin(turn) * p.x);
    float veins = one * octaves(vec3(1.3 * along.x, 7.0 * along.y, 30.0 * seed), 1.0, 3, width);
    float stain = smoothstep(0.0, 0.5, octaves(p + 71.0, 0.8, 4, width));
    vec2 rim = abs(fract(q) - 0.5) * 2.0;
    float worn = pow(max(rim.x, rim.y), 12.0);
    vec3 tone = push.color.rgb * (1.0 + one * (0.34 * seed - 0.16 * other) + 0.30 * large + 0.18 * cloud + 0.12 * veins + 0.18 * grain);
    tone *= 1.0 - vec3(0.24, 0.25, 0.27) * stain - 0.22 * one * worn * (0.6 + cloud);
    tone *= 1.0 + one * vec3(0.09, 0.0, -0.12) * warm;
    Surface s;
    s.albedo = mix(tone, push.color.rgb * vec3(0.46, 0.43, 0.38), 0.8 * gap);
    s.roughness = mix(push.color.a - 0.12 * one * hash(slab + ivec3(0, 0, 33)), 0.95, gap);
    s.tilt = vec3(0.02 * one * seed + 0.03 * grain, 0.0, 0.02 * one * warm + 0.03 * cloud);
    return s;
}

// Natural rock: soft light and dark spots, strata, clefts, and lichen on surfaces that face up. It is darker up to
// some height above the sea, where waves wet it. `height`: metres above the sea.
Surface rock(vec3 p, vec3 n, float width, float height) {
    float cloud = octaves(p, 0.45, 4, width);
    float cleft = octaves(p + 3.0 * cloud, 1.1, 3, width);
    float grain = octaves(p + 53.0, 14.0, 3, width);
    vec3 relief = vec3(octaves(p, 2.6, 4, width), octaves(p + 17.0, 2.6, 4, width), octaves(p + 43.0, 2.6, 4, width));
    float strata = octaves(vec3(0.25 * p.x, 1.6 * p.y + 0.5 * cloud, 0.25 * p.z) + 37.0, 1.1, 4, width);
    vec3 tone = push.color.rgb * (1.0 + 0.25 * cloud + 0.45 * grain + 0.55 * strata + 0.6 * relief.x);
    tone *= 1.0 + vec3(0.08, 0.0, -0.10) * cleft;
    float lichen = smoothstep(0.15, 0.5, octaves(p + 71.0, 1.7, 3, width)) * smoothstep(0.3, 0.8, n.y);
    tone = mix(tone, push.color.rgb * vec3(1.15, 1.2, 0.85), 0.5 * lichen);
    if (SEA == WATER) {
        float damp = 1.0 - smoothstep(0.05, 0.35, height + 0.15 * cloud);
        tone *= mix(vec3(1.0), vec3(0.40, 0.38, 0.33), damp);
    }
    Surface s;
    s.albedo = tone;
    s.roughness = push.color.a;
    s.tilt = 0.9 * relief + 0.25 * vec3(grain, 0.0, -grain);
    return s;
}

// Leaves: light tips and dark gaps between them.
Surface leaves(vec3 p, vec3 n, float width) {
    float clump = octaves(p + 3.0, 1.6, 3, width);
    vec3 leaf = vec3(octaves(p, 9.0, 3, width), octaves(p + 41.0, 9.0, 3, width), octaves(p + 83.0, 9.0, 3, width));
    float gap = 1.0 - 0.75 * smoothstep(0.0, 0.4, -leaf.x - 0.3 * clump);
    Surface s;
    s.albedo = push.color.rgb * (1.0 + 0.5 * clump + 0.8 * leaf.y) * gap * mix(0.55, 1.1, smoothstep(-0.8, 0.8, n.y));
    s.albedo *= 1.0 + vec3(0.35, 0.10, -0.2) * leaf.z;
    s.roughness = push.color.a;
    s.tilt = 1.3 * leaf;
    return s;
}

// Leaves of trees and hedges from afar: twigs in all directions, dark gaps between them, and a green that varies over
// lengths of a few metres, as from bush to bush.
Surface foliage(vec3 p, vec3 n, float width) {
    float mass = octaves(p + 3.0, 0.35, 2, width);
    float twig = octaves(p + 61.0, 2.6, 3, width);
    vec3 leaf = vec3(octaves(p, 11.0, 2, width), octaves(p + 41.0, 11.0, 2, width), octaves(p + 83.0, 11.0, 2, width));
    // Gaps finer than a pixel average to a darker, uniform green.
    float deep = smoothstep(0.0, 0.5, -1.1 * leaf.x - 0.8 * twig + 0.12 * (1.0 - kept(width, 11.0)));
    Surface s;
    s.albedo = push.color.rgb * (1.0 + 0.35 * mass + 0.6 * twig + 1.3 * leaf.y);
    s.albedo *= 1.0 + vec3(0.55, 0.15, -0.25) * (0.5 * mass + leaf.z);
    s.albedo *= (1.0 - 0.85 * deep) * mix(0.7, 1.05, smoothstep(-0.9, 0.6, n.y));
    s.roughness = push.color.a;
    s.tilt = 2.2 * leaf + 0.9 * vec3(twig, 0.4 * leaf.z, leaf.x - twig);
    return s;
}

// Grass: stripes from mowing to and fro, patches that are dry or lush, tufts.
Surface lawn(vec3 p, float width) {
    float broad = octaves(p + 5.0, 0.09, 3, width);
    float patches = octaves(p + 29.0, 0.9, 3, width);
    // Seen at a low angle, tufts of grass hide one another instead of averaging out, so their noise is filtered with
    // 0.6 of the pixel's footprint width.
    float tuft = octaves(vec3(p.x, 0.0, p.z), 9.0, 3, 0.6 * width);
    float laid = lines(p.x / (2.0 * push.pattern.x) + 0.04 * broad, 0.5, width / (2.0 * push.pattern.x)) - 0.5;
    vec3 lush = push.color.rgb;
    vec3 dry = dot(lush, vec3(0.4, 0.6, 0.0)) * vec3(1.35, 1.18, 0.50);
    Surface s;
    s.albedo = mix(lush, dry, clamp(0.2 + 0.55 * patches + 0.4 * broad, 0.0, 0.55));
    s.albedo *= 1.0 + 0.30 * laid + 0.12 * broad + 0.22 * patches + 1.2 * tuft;
    s.roughness = push.color.a;
    s.tilt = vec3(0.9 * tuft + 0.10 * laid, 0.0, 0.5 * tuft);
    return s;
}

// Sand with bent and broken ripples, coarser sand in their troughs, a pebble in some cells.
Surface ripples(vec3 p, float width) {
    Surface s = sand(p, width);
    float size = push.pattern.x;
    vec2 bend = vec2(octaves(p, 0.35 / size, 2, width), octaves(p + 37.0, 0.35 / size, 2, width));
    float phase = 6.2832 * ((0.35 * p.x + p.z) / size + 1.6 * bend.x);
    float height = kept(width, 1.0 / size) * smoothstep(-0.35, 0.25, octaves(p + 91.0, 0.13 / size, 2, width) + 0.1);
    // Steeper on the lee side.
    float slope = cos(phase + 0.5 * sin(phase));
    s.albedo *= 1.0 - 0.10 * height * (1.0 - sin(phase));
    s.tilt += 0.38 * height * slope * vec3(0.35, 0.0, 1.0) + vec3(0.2 * bend.y, 0.0, 0.0);
    ivec3 cell = ivec3(floor(vec3(p.x, 0.0, p.z) * 3.0));
    vec2 at = vec2(hash(cell + 17), hash(cell + 29)) * 0.6 + 0.2;
    float radius = 0.04 + 0.12 * pow(hash(cell + 43), 3.0);
    vec2 off = (fract(p.xz * 3.0) - at) / radius;
    float pebble = step(hash(cell + 71), 0.13) * kept(width, 8.0) * (1.0 - smoothstep(0.8, 1.0, length(off)));
    vec3 stone = mix(vec3(0.16, 0.15, 0.14), vec3(0.42, 0.38, 0.33), hash(cell + 97));
    s.albedo = mix(s.albedo, stone, pebble);
    s.tilt = mix(s.tilt, 0.9 * vec3(off.x, 0.0, off.y), pebble);
    return s;
}

// Ground of an island: sand up to a height above the sea, grass above it, and rock where it is steep; dark sand where
// it is wet, and weed on the sea bed.
Surface island(vec3 p, vec3 n, float width, float height) {
    float beach = push.pattern.x;
    Surface s = sand(p, width);
    float broad = octaves(p + 5.0, 0.06, 4, width);
    float patches = octaves(p + 29.0, 0.22, 4, width);
    float fine = octaves(p + 47.0, 1.3, 3, width);
    // Sand wetted by the sea.
    float damp = SEA == WATER ? 1.0 - smoothstep(0.08, 0.30, height + 0.12 * broad + 0.05 * patches) : 0.0;
    s.albedo *= mix(vec3(1.0), vec3(0.66, 0.62, 0.57), damp);
    vec3 weed = vec3(0.060, 0.070, 0.035) * (1.0 + 0.8 * fine);
    s.albedo = mix(s.albedo, s.albedo * vec3(1.05, 1.13, 1.32), 1.0 - smoothstep(-0.8, 0.0, height));
    float deep = 1.0 - smoothstep(-3.0, -1.3, height);
    s.albedo = mix(s.albedo, weed, 0.85 * deep * smoothstep(0.08, 0.34, patches + 0.6 * broad));

    vec3 grass = mix(vec3(0.115, 0.150, 0.040), vec3(0.060, 0.105, 0.025), smoothstep(-0.3, 0.3, patches));
    grass = mix(grass, vec3(0.23, 0.20, 0.09), smoothstep(0.1, 0.5, broad + 0.3 * fine));
    grass *= 1.0 + 0.7 * fine + 0.4 * octaves(p, 7.0, 2, width);
    float green = smoothstep(0.75, 1.15, height / beach + 0.9 * patches + 0.35 * fine);
    s.albedo = mix(s.albedo, grass, green);
    float steep = 1.0 - smoothstep(0.70, 0.82, n.y + 0.16 * fine + 0.12 * patches);
    steep *= smoothstep(-0.5, 0.3, height - 0.5 * beach);
    float clouds = octaves(p + 83.0, 0.5, 4, width);
    float strata = octaves(vec3(0.3 * p.x, 2.2 * p.y, 0.3 * p.z), 0.8, 3, width);
    vec3 relief = vec3(octaves(p, 0.9, 4, width), octaves(p + 17.0, 0.9, 4, width), octaves(p + 43.0, 0.9, 4, width));
    vec3 stone = vec3(0.25, 0.22, 0.19) * (1.0 + 0.35 * clouds + 0.6 * strata + 0.3 * fine + 0.2 * relief.y);
    s.albedo = mix(s.albedo, stone, steep);
    s.roughness = mix(s.roughness, 0.9, max(green, steep));
    s.tilt += mix(0.5 * green, 1.0, steep) * relief;
    return s;
}

// Fraction of the sunlight through thin clouds that comes from a glow around the sun's disc, and the angular radius
// of that glow in radians (Buie, Monger and Dey 2003: circumsolar ratios reach 0.5 and more; the glow's radius is
// 43.6 mrad).
const float GLOWING = 0.5;
const float GLOW = 0.0436;
// Maximum radius, in texels of the shadow map, and number of samples of the filter that softens shadows by the glow
// around the sun.
const float WIDEST = 12.0;
const int TAPS = 16;

// Sample positions, evenly distributed over a unit disc (Vogel 1979).
vec2 tap(int i) {
    float turn = 2.3999632 * float(i);
    return sqrt((float(i) + 0.5) / float(TAPS)) * vec2(cos(turn), sin(turn));
}

// Visibility of the sun: a 5×5 tent filter with nine bilinear comparisons (Castaño 2013, as in The Witness). It is
// smooth and needs no noise. Its width is that of five texels of the shadow map, whatever the distance of the blockers.
// Behind thin clouds a part of the sun's light comes from a glow around the disc. The radius of this glow's penumbra
// follows from the mean distance of the blockers (Fernando 2005), from 1 to WIDEST texels.
float sunlight(vec3 at, vec3 facing) {
    float slope = 1.0 - max(dot(facing, scene.sun_direction.xyz), 0.0);
    vec3 lifted = at + facing * scene.shadow_texel.z * (1.0 + 2.5 * slope);
    vec4 s = scene.shadow * vec4(lifted, 1.0);
    // The shadow map's depth range ends just behind the farthest caster, so receivers behind it are clamped to the
    // range's end. Outside the map's borders everything is lit.
    float depth = min(s.z, 1.0);
    vec2 uv = s.xy / scene.shadow_texel.xy;
    vec2 middle = s.xy;
    vec2 base = floor(uv + 0.5);
    vec2 st = uv + 0.5 - base;
    base = (base - 0.5) * scene.shadow_texel.xy;
    vec2 w0 = 4.0 - 3.0 * st;
    const float w1 = 7.0;
    vec2 w2 = 1.0 + 3.0 * st;
    vec2 o0 = ((3.0 - 2.0 * st) / w0 - 2.0) * scene.shadow_texel.xy;
    vec2 o1 = (3.0 + st) / w1 * scene.shadow_texel.xy;
    vec2 o2 = (st / w2 + 2.0) * scene.shadow_texel.xy;
    float sum = w0.x * w0.y * texture(shadow_map, vec3(base + o0, depth))
              + w1 * w0.y * texture(shadow_map, vec3(base + vec2(o1.x, o0.y), depth))
              + w2.x * w0.y * texture(shadow_map, vec3(base + vec2(o2.x, o0.y), depth))
              + w0.x * w1 * texture(shadow_map, vec3(base + vec2(o0.x, o1.y), depth))
              + w1 * w1 * texture(shadow_map, vec3(base + o1, depth))
              + w2.x * w1 * texture(shadow_map, vec3(base + vec2(o2.x, o1.y), depth))
              + w0.x * w2.y * texture(shadow_map, vec3(base + vec2(o0.x, o2.y), depth))
              + w1 * w2.y * texture(shadow_map, vec3(base + vec2(o1.x, o2.y), depth))
              + w2.x * w2.y * texture(shadow_map, vec3(base + o2, depth));
    float lit = sum / 144.0;

    // `rise` is the gradient, over the shadow map, of the depth of the surface's plane. Each sample of the filter is
    // compared with the plane's depth at that sample, so that the surface does not shadow itself.
    vec3 along_x = cross(facing, abs(facing.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0));
    vec3 a = mat3(scene.shadow) * along_x;
    vec3 b = mat3(scene.shadow) * cross(facing, along_x);
    float determinant = a.x * b.y - a.y * b.x;
    vec2 rise = vec2(a.z * b.y - b.z * a.y, a.x * b.z - b.x * a.z) / (abs(determinant) > 1.0e-12 ? determinant : 1.0e-12);
    float deep = 1.0 / length(vec3(scene.shadow[0].z, scene.shadow[1].z, scene.shadow[2].z));
    // A surface nearly parallel to the sun's rays has no usable gradient.
    int glows = scene.air.z > 0.0 && slope < 0.95 && all(greaterThan(middle, vec2(0.0))) && all(lessThan(middle, vec2(1.0))) ? 1 : 0;
    ivec2 last = textureSize(shadow_depth, 0) - 1;
    for (int k = 0; k < glows; ++k) {
        float gaps = 0.0;
        float count = 0.0;
        for (int i = 0; i < TAPS; ++i) {
            vec2 off = WIDEST * tap(i) * scene.shadow_texel.xy;
            float there = texelFetch(shadow_depth, clamp(ivec2((middle + off) / scene.shadow_texel.xy), ivec2(0), last), 0).x;
            float gap = depth + dot(rise, off) - there;
            count += gap > 0.0 ? 1.0 : 0.0;
            gaps += max(gap, 0.0);
        }
        int partly = count > 0.0 ? 1 : 0;
        for (int j = 0; j < partly; ++j) {
            float wide = clamp(gaps / count * deep * GLOW / scene.shadow_texel.z, 1.0, WIDEST);
            float open = 0.0;
            for (int i = 0; i < TAPS; ++i) {
                vec2 off = wide * tap(i) * scene.shadow_texel.xy;
                open += texture(shadow_map, vec3(middle + off, min(depth + dot(rise, off), 1.0)));
            }
            lit = mix(lit, open / float(TAPS), GLOWING * scene.air.z);
        }
    }
    return lit;
}

// Irradiance on the level surface of a sea of lava at `place` (world x and z): the sun's with shadows, and the
// fraction `sky_seen` of the sky's.
vec3 lava_light(vec2 place, float sky_seen) {
    vec3 at = vec3(place.x, scene.sea.x, place.y);
    vec3 up = vec3(0.0, 1.0, 0.0);
    float sun = max(scene.sun_direction.y, 0.0) * sunlight(at, up);
    return scene.sun_color.rgb * sun + sky_seen * sky_irradiance(up);
}

void main() {
    vec3 to_eye = scene.eye.xyz - position;
    vec3 v = normalize(to_eye);
    // Screen-space derivatives are taken before any branch, because inside one they would be undefined. The winding of
    // triangles is not reliable, so the normals of face and vertex are turned towards the eye.
    vec3 px = dFdx(position);
    vec3 py = dFdy(position);
    vec3 face = cross(px, py);
    face = dot(face, face) > 0.0 ? normalize(face) : v;
    face = dot(face, v) < 0.0 ? -face : face;
    vec3 n = normalize(normal);
    // Leaves keep the normal of their crown.
    n = PATTERN != FOLIAGE && dot(n, face) < 0.0 ? -n : n;
    // Depth of the shaded point below the level of the sea (world units, 0 above it), and the fraction of the pixel's
    // footprint that is below that level.
    float depth = SEA != 0u ? max(scene.sea.x - position.y, 0.0) : 0.0;
    float under = SEA != 0u ? clamp((scene.sea.x - position.y) / max(fwidth(position.y), 1.0e-6) + 0.5, 0.0, 1.0) : 0.0;

    // Loops instead of branches, for CPU drivers (docs/performance.md).
    int wet = under > 0.0 && over_sea() ? 1 : 0;
    Surf sea;
    vec3 shown_at = position;
    for (int i = 0; i < wet; ++i) {
        sea = surf();
        vec3 aside = wobble(sea, depth);
        shown_at += aside - n * dot(aside, n);
    }
    vec3 p = scene.air.y * unturn(shown_at - push.origin.xyz);
    vec3 step_x = scene.air.y * unturn(px);
    vec3 step_y = scene.air.y * unturn(py);
    vec3 footprint3 = abs(step_x) + abs(step_y);
    // Width by which procedural noise is filtered: the geometric mean of the pixel footprint's two axes, times 1.2.
    // The short axis alone would leave aliasing, the long one would blur.
    float width = 1.2 * sqrt(length(step_x) * length(step_y));
    vec3 axis = abs(unturn(face));

    bool top = axis.y >= max(axis.x, axis.z);
    bool side = !top && axis.x >= axis.z;
    vec2 q = top ? p.xz : side ? p.zy : p.xy;
    vec2 footprint = top ? footprint3.xz : side ? footprint3.zy : footprint3.xy;

    Surface s = Surface(push.color.rgb, push.color.a, vec3(0.0));
    if (PATTERN == TILES) {
        s = tiles(q, footprint, top ? -1.0e9 : scene.air.y * position.y);
        s.tilt = top ? s.tilt.xzy : side ? s.tilt.zyx : s.tilt;
    } else if (PATTERN == PLANKS) {
        s = planks(p, axis, vec2(footprint3.x, axis.y > axis.z ? footprint3.z : footprint3.y), width);
    } else if (PATTERN == CONCRETE) {
        s = concrete(p, abs(n), width);
    } else if (PATTERN == STONE) {
        s = stone(p, abs(n), vec2(footprint.x, footprint3.y), width);
    } else if (PATTERN == SAND) {
        s = sand(p, width);
    } else if (PATTERN == PAVING) {
        s = paving(q, footprint, p, width);
    } else if (PATTERN == ISLAND) {
        s = island(p, n, width, scene.air.y * (shown_at.y - scene.sea.x));
    } else if (PATTERN == LEAVES) {
        s = leaves(p, n, width);
    } else if (PATTERN == ROCK) {
        s = rock(p, n, width, scene.air.y * (position.y - scene.sea.x));
    } else if (PATTERN == FOLIAGE) {
        s = foliage(p, n, width);
    } else if (PATTERN == LAWN) {
        s = lawn(p, width);
    } else if (PATTERN == RIPPLES) {
        s = ripples(p, width);
    }
    if (PATTERN == PAVING || PATTERN == STONE) {
        s.albedo = clamp(s.albedo, 0.0, 0.95);
        s = wetted(s, n.y > 0.5 ? wetness(position, width) : 0.0, n.y);
    }
    if (TEXTURED == 1u) {
        s.albedo *= texture(base_texture, uv).rgb;
    }
    s.albedo = clamp(s.albedo, 0.0, 0.95);
    n = normalize(n + turn(s.tilt));

    vec3 l = scene.sun_direction.xyz;
    float n_l = max(dot(n, l), 0.0);
    if (PATTERN == FOLIAGE || PATTERN == LAWN) {
        // Leaves and blades face all directions and transmit light.
        n_l = max(0.30 + 0.70 * dot(n, l), 0.0);
    }
    float n_v = max(dot(n, v), 1.0e-3);
    vec3 sun = vec3(0.0);
    if (n_l > 0.0) {
        // The shadow map is sampled at the position lifted along the normal to the curved surface that the flat
        // facets of the mesh approximate, so that facets do not shadow one another.
        bool backdrop = push.pattern.z > 0.5;
        vec3 lifted = position + n * 1.5 * (backdrop ? 0.0 : max(around.w, 0.0));
        sun = scene.sun_color.rgb * n_l * sunlight(lifted, face);
        float open = clamp(around.w, 0.0, 1.0);
        // Crowns let some light through, between the leaves and through them: yellow-green.
        vec3 through = PATTERN == FOLIAGE ? mix(vec3(0.36, 0.42, 0.20), vec3(1.0), open) : vec3(open);
        sun *= backdrop ? through : vec3(1.0);
    }
    vec3 up = sky_irradiance(vec3(0.0, 1.0, 0.0));
    // The baked light is clamped at 0, because where a multisampled pixel's centre lies outside of its triangle,
    // interpolation may extrapolate it below 0.
    float sky_seen = clamp(light.x, 0.0, 1.0);
    // Thin clouds scatter some of the sun's light down.
    vec3 cloudy = 0.16 * scene.air.z * scene.sun_color.rgb;
    vec3 clouds = (0.5 + 0.5 * n.y) * cloudy;
    vec3 sky = sky_seen * (sky_irradiance(n) + clouds);
    // Surrounding surfaces see about half of the sky themselves.
    vec3 bounced = max(light.yzw, 0.0) * scene.sun_color.rgb + 0.5 * max(around.rgb, 0.0) * (up + cloudy);
    for (int i = 0; SEA == WATER && i < wet; ++i) {
        sun *= sun_under(position, depth);
        sky *= sky_under(depth);
        bounced *= sky_under(depth);
    }
    vec3 c = s.albedo / PI * (sun + sky + bounced);
    if (SEA == LAVA && over_sea()) {
        c += s.albedo / PI * lava_glow(position.y - scene.sea.x, n);
    }

    vec3 matt = c;

    // Specular reflection of sun and sky.
    float alpha = max(s.roughness * s.roughness, 0.02);
    vec3 h = normalize(v + l);
    float n_h = max(dot(n, h), 0.0);
    float v_h = max(dot(v, h), 0.0);
    float a2 = alpha * alpha;
    float d = a2 / (PI * pow(n_h * n_h * (a2 - 1.0) + 1.0, 2.0));
    float vis = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, alpha);
    c += sun * d * vis * (0.04 + 0.96 * pow(max(1.0 - v_h, 0.0), 5.0));
    float lod = s.roughness * (log2(float(textureSize(environment, 0).x)) - 2.0);
    float f = 0.04 + (max(1.0 - s.roughness, 0.04) - 0.04) * pow(max(1.0 - n_v, 0.0), 5.0);
    vec3 mirrored = reflect(-v, n);
    vec3 seen = mix(c, with_band(textureLod(environment, mirrored, lod).rgb, mirrored.y), sky_seen * sky_seen);
    // At grazing angles leaves and blades turn away and hide one another.
    float gloss = PATTERN == FOLIAGE || PATTERN == LAWN ? 0.2 : 1.0;
    c += gloss * f * (1.0 - 0.5 * s.roughness) * seen;

    if ((PART == GROUND || push.pattern.z > 0.5) && scene.air.x > 0.0) {
        // The horizon's colour in the direction of the ray.
        vec3 level = normalize(vec3(-v.x, max(-v.y, 0.02), -v.z));
        vec3 clear = clear_air(length(to_eye));
        vec3 air = with_band(textureLod(environment, level, 2.0).rgb, level.y);
        // Light that the air scatters is bluer than light from the horizon.
        air *= SEA == WATER ? mix(vec3(1.0), vec3(0.90, 0.90, 1.15), clear) : vec3(1.0);
        c = mix(air, c, clear);
    }
    if (PART == GROUND) {
        float away = distance(position.xz, scene.ground.xy);
        c = mix(c, textureLod(environment, -v, 2.0).rgb, smoothstep(scene.ground.z, scene.ground.w, away));
    }
    for (int i = 0; i < wet; ++i) {
        // Under water there is little specular reflection.
        vec3 lit = SEA == LAVA ? lava_light(sea.place.at, sky_seen) : up;
        c = mix(c, sea_over(matt, depth, lit, sea), under);
    }
    color = vec4(clamp(c, 0.0, 60000.0), 1.0);
}
