// Numbers of the frame (src/frame.rs writes them). Pixel coordinates have their centres at +0.5
// and row 0 on top; eye space looks down -z; depth is the positive eye depth.
// Reads: the frame's block.

const float EMPTY = 1.0e10;

layout(set = 0, binding = 0, std140) uniform Frame {
    mat4 view;          // world -> eye
    mat4 world;         // eye -> world
    vec4 projection;    // P00 P11 P20 P21
    vec4 depth;         // device depth z -> x / (z + y); near, far
    vec4 planes[6];     // inward planes of the frustum, eye space
    vec4 extent;        // full width, height; reduced width, height
    vec4 thick_extent;  // thickness width, height; its pixels' size; 0
    vec4 slope;         // full pixel -> slope: scale xy, offset zw
    vec4 thick_slope;   // thickness pixel -> slope
    vec4 texel;         // C_x C_y: world size of a pixel per depth; 0 0
    vec4 scene_depth;   // pixels of the scene's depth per full pixel, size of its part
    vec4 scene_color;   // the same of its colour
    vec4 scene_origin;  // first pixel of the part: of the scene's depth, of its colour
    vec4 target;        // first pixel of the part of the output; rung of the ladder
    vec4 particle;      // drawn radius, spacing, half-axis and amplitude of a thickness sprite
    vec4 density;       // nothing but spray below, full radius above, no spray above; droplets a particle
    vec4 smoothing;     // width, depth falloff, most iterations, fixed count
    vec4 medium_a;      // physical: absorption; source: base colour; w: 1 = source
    vec4 medium_b;      // physical: scattering; source: falloff
    vec4 fresnel;       // bias, scale, power
    vec4 surface;       // refraction, specular, shininess, border threshold
    vec4 sun_direction; // eye space
    vec4 sun_color;
    vec4 ambient;       // w: 1 = composed as the source does
    vec4 foam;          // extinction of all and of the front layer, motion threshold, front layer's depth
    vec4 foam_noise;    // its amplitude, cells a second; relief; least thickness that is whole
    vec4 foam_pattern;  // its strength; that of the lace, its cells in metres; half its period in seconds
    vec4 foam_octaves;  // spacings of its first octave; where its two phases begin in the noise; how much its shape lights it
    vec4 foam_phases;   // how much there is of each; how far it is carried, of half a period, -1 to 1
    vec4 foam_back;     // radiance of little foam, and of much; w: step of its thickness
    vec4 foam_front;    // w: power of the other rule, or 0
    vec4 spray;         // optical depth and half-axis of a droplet, spread; seconds of a streak
    vec4 spray_color;   // radiance; w: 1 = added
    vec4 spray_cloud;   // optical depth and half-axis of mist; seconds of motion that droplets lie apart
    mat4 shadow;        // eye -> the host's shadow map: place in it 0 to 1, depth
    mat4 to_light;      // eye -> the light's maps: place in them 0 to 1, metres along the light
    vec4 shadow_map;    // bias in metres; 1, or -1 where depth is reversed
    vec4 shadow_rect;   // first texel and size of the part of the shadow map or mask
    vec4 light_map;     // edge of the maps in texels, of a texel in metres; smoothing in metres
    vec4 shade;         // light in shade over that in the sun; foam's extinction of sunlight
    vec4 lit_color;     // as scene_color and its origin, of what `lit` reads
    vec4 lit_origin;
    vec4 shadow_linear; // depth z of the shadow map -> (x z + y) / (z z + w), even away from the light
    vec4 shadow_basis;  // its Fourier basis: size in texels, the map's texels a texel, edge of a page
    vec4 shadow_filter; // half the box in texels, scale, offset, ramp
    vec4 shadow_weight[4]; // of the terms
    mat4 before;        // eye -> eye of the frame before, less the identity
    vec4 before_lens;   // its P00 P11; its near plane; device depth of nothing in this frame
    vec4 lens_change;   // P00 P11 P20 P21 less those of the frame before
    vec4 motion;        // seconds since it per spacing; a spacing
    vec4 noise;         // height of 1 in metres, foam; falloff a metre below the surface, half-axis
    vec4 noise_image;   // width, height of the surface noise; its texels' size; cells a metre
    vec4 noise_color;   // radiance of its foam
    vec4 diffuse;       // radius of a whitewater particle without one; nearer and farther end of where blobs take over, 0: nowhere; 1 = the source's falloff below the surface
    vec4 diffuse_below; // that falloff: metres, exponents
    vec4 diffuse_light; // binary logarithm of the intensity's half, its exponent; 1 = mixed as the source does; radius of a blob in its particle's
    vec4 diffuse_search; // spheres of the occlusion: first, more a pass, passes, samples a cubic pixel
    vec4 diffuse_samples; // least and most; reach of occluders in radii, or less than 0 in metres
    vec4 diffuse_opacity; // of fluid and solids; scale and exponent of the shadow
    vec4 diffuse_shadow; // what of a shadow takes light; its offset
    vec4 diffuse_color; // albedo, twice and by its scale; radius of the blur in that of the first sphere
    vec4 diffuse_shapes[3]; // of foam, spray, bubbles: exponents of the shape, its mean over the disc
    vec4 diffuse_life;  // exponents of the lifetime; sizes there are; radius of a bubble in what it would be
    vec4 diffuse_sun;   // the sun's light on what faces it, over 2 pi
    vec4 shore_color;   // radiance of shoreline foam; its opacity
    vec4 contact_color; // of contact foam; what of it is light on it
    vec4 up;            // world, unit length; w: 1/n of the water
    vec4 bed;           // of the light that is thrown up inside, what leaves; ways of the sky's and the sun's light a metre down; 1/n, or 0: dry
    vec4 bed_light;     // pi over the irradiance; what comes in of the sun's light over what does of the sky's
} frame;

// Slope (xy / depth) of the ray through a point of an image, in its pixel coordinates.
vec2 ray_slope(vec2 pixel, vec4 slope) {
    return pixel * slope.xy + slope.zw;
}

float eye_depth(float device_depth) {
    return frame.depth.x / (device_depth + frame.depth.y);
}

// The scene-depth texel of a full-resolution pixel (nearest look-up by uv).
ivec2 scene_texel(vec2 pixel) {
    ivec2 texel = ivec2(pixel * frame.scene_depth.xy);
    return clamp(texel, ivec2(0), ivec2(frame.scene_depth.zw) - 1) + ivec2(frame.scene_origin.xy);
}
