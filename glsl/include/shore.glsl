// Shared by the passes of shoreline and contact foam: position of the host's water surface, values of the uniform
// block. Horizontal positions p are in scene units along the two level axes of the world. Needs frame.glsl.
// Reads: the block of shoreline and contact foam.

// GENERAL is 0 in the usual case: the water's surface is level, the shore coordinate v comes from a map of distances
// or a strip, there are at most two look-ups in the noise and two in the foam texture, and the scene's depth has the
// frame's size. It is 1 in the general case. The two are separate pipelines, because a CPU driver executes both sides
// of branches and evaluates loop counts one lane at a time.
layout(constant_id = 3) const uint GENERAL = 1;
const int LOOKS = GENERAL == 1u ? 6 : 2;
const int LAYERS = GENERAL == 1u ? 4 : 2;

layout(set = 0, binding = 1, std140) uniform ShoreFrame {
    vec4 east;          // maps eye space to the first axis of the level
    vec4 north;         // and to the second
    vec4 height;        // eye space to height above the water's level
    vec4 surface;       // texels of the host's surface per pixel, its size
    vec4 surface_part;  // its first texel; 1: level, 2: depth, 0: neither; distance in scene units by which solids before it still count as behind
    vec4 map;           // corner of the map in p, texels per scene unit, texels on each axis
    vec4 reach;         // 1 / width of the foam to sea and inland in scene units; v where it ends; 0: no shoreline, 1: strip, 2: map, 3: screen
    vec4 waves;         // frequency, phase, a, b
    vec4 mixed;         // floor, ratio of waves and of the web, threshold
    vec4 web;           // a', b'; texels of the web and of the noise
    vec4 counts;        // look-ups in the noise, layers of the web; 0 0
    vec4 look[6];       // for each: repetitions per scene unit; scene units by which xy displaces points and zw the web; 0
    vec4 look_moved[6]; // how far it has moved, scene units; 0 0
    vec4 noise[6];      // weights with which its xyzw change frequency, phase, offset and threshold
    vec4 layer[4];      // web at p: (x p.x - y p.y, y p.x + x p.y) + zw
    vec4 layer_weight;
    vec4 contact;       // 1 / distance at which foam ends, scene units (host's surface, particles'); weight of the mask; 0: distance, 1: view, 2: vertical
    vec4 contact_mask;  // repetitions of the web per scene unit, how far it has moved; 1: the host has a mask
    vec4 mask;          // texels of the mask per pixel, its size
    vec4 mask_part;     // its first texel; opacity on the host's surface and on the particles'
} shore;

// The point of the host's water surface that a pixel shows, with its derivatives per pixel; p is its horizontal
// position.
struct Water {
    float z;     // eye depth; 0 or less without a surface
    vec3 ray;    // eye space, at depth 1
    vec2 p;
    mat2 across; // change of p per pixel to the right and down
};

// The point of a ray at a depth, on a level surface.
Water water_point(vec3 ray, float z) {
    Water w;
    w.z = z;
    w.ray = ray;
    w.p = vec2(dot(shore.east.xyz, ray), dot(shore.north.xyz, ray)) * z + vec2(shore.east.w, shore.north.w);
    // On a level surface the depth changes with the ray.
    float fall = dot(shore.height.xyz, ray);
    fall = abs(fall) < 1.0e-6 ? 1.0e-6 : fall;
    vec3 right = vec3(frame.slope.x, 0.0, 0.0);
    vec3 down = vec3(0.0, frame.slope.y, 0.0);
    right -= dot(shore.height.xyz, right) / fall * ray;
    down -= dot(shore.height.xyz, down) / fall * ray;
    w.across = z * mat2(dot(shore.east.xyz, right), dot(shore.north.xyz, right),
                        dot(shore.east.xyz, down), dot(shore.north.xyz, down));
    return w;
}

// Returns the width of a pixel on the water's surface in scene units: the side of a square with the area that the
// pixel covers there.
float width_of(Water w) {
    return sqrt(abs(determinant(w.across)));
}

// Eye depth of the scene; 0 without a scene or at the far plane.
float scene_of(float device_depth) {
    return device_depth == frame.before_lens.w ? 0.0 : eye_depth(device_depth);
}

// Whether the water's surface at eye depth z is visible: unless a solid, at eye depth `scene` (0 or less: no solid),
// is in front of it by more than a margin (surface_part.w).
bool seen_before(float z, float scene) {
    return z > 0.0 && z < EMPTY && !(scene > 0.0 && scene + shore.surface_part.w < z);
}
