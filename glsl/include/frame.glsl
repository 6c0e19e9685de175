// Values of the frame (src/frame.rs writes them). Pixel centres lie at +0.5, and row 0 is the top row. Eye space
// looks down -z. Depth is the positive eye depth.
// Reads: the frame's block.

const float EMPTY = 1.0e10;

layout(set = 0, binding = 0, std140) uniform Frame {
    mat4 view;          // world -> eye
    mat4 world;         // eye -> world
    vec4 projection;    // P00 P11 P20 P21
    vec4 depth;         // device depth z -> x / (z + y); near, far
    vec4 planes[6];     // inward planes of the frustum, eye space
    vec4 extent;        // full width, height; reduced width, height
    vec4 thick_extent;  // thickness width, height; size of its texels in pixels; 0
    vec4 slope;         // full pixel -> slope: scale xy, offset zw
    vec4 thick_slope;   // thickness pixel -> slope
    vec4 texel;         // C_x C_y: world size of a pixel per depth; slope of a wavelet; number of panes
    vec4 scene_depth;   // scene-depth texels per pixel, size of the used part
    vec4 scene_color;   // the same for the scene's colour
    vec4 scene_origin;  // first texel of the used part: of the scene's depth, of its colour
    vec4 target;        // first pixel of the used part of the output; layers of the debug view
    vec4 particle;      // drawn radius, spacing, half-axis and amplitude of a thickness sprite
    vec4 density;       // only spray below x, full radius above y, no spray above z; droplets per particle
    vec4 smoothing;     // width, depth falloff, maximum iterations, fixed count
    vec4 medium_a;      // physical: absorption; turbid: 0; source: base colour; w: 1 = source
    vec4 medium_b;      // physical: scattering; turbid: extinction, share of scattered light; source: falloff
    vec4 fresnel;       // bias, scale, power
    vec4 surface;       // refraction, specular, shininess, border threshold
    vec4 sun_direction; // eye space
    vec4 sun_color;
    vec4 ambient;       // turbid: radiance of an infinitely deep body; w: 1 = the thesis' composite
    vec4 foam;          // extinction of all and of the front layer, motion threshold, front layer's depth
    vec4 foam_noise;    // amplitude, cells per second; relief; thickness below which foam fades
    vec4 foam_pattern;  // strength of the pattern; of the lace; width of the lace's cells in scene units; half the pattern's period in seconds
    vec4 foam_lace;     // strength of the lace's shading
    vec4 foam_octaves;  // spacings per cell of the first octave; origins of the two phases in the noise; strength of shape lighting
    vec4 foam_phases;   // weights of the two phases; displacement of each relative to half a period, -1 to 1
    vec4 foam_back;     // radiance of thin foam; w: quantum of the thickness
    vec4 foam_front;    // radiance of thick foam; w: exponent of the thesis' rule, or 0
    vec4 spray;         // optical depth and half-axis of a droplet, spread; seconds of a streak
    vec4 foam_aerated; // radiance of water with bubbles under foam; its opacity over the foam's
    vec4 spray_color;   // radiance; w: 1 = added
    vec4 spray_cloud;   // optical depth and half-axis of mist; seconds that droplets are spread over; sunlight of a glint
    vec4 spray_mist;    // amplitude of the clumps; extinction for sunlight over foam's; scattering; relief
    vec4 spray_near;    // max half-axis of a droplet over its depth
    mat4 shadow;        // eye -> the host's shadow map: place in it 0 to 1, depth
    mat4 to_light;      // eye -> the light's maps: place in them 0 to 1, distance along the light in scene units
    vec4 shadow_map;    // bias in scene units; 1, or -1 where depth is reversed
    vec4 shadow_rect;   // first texel and size of the part of the shadow map or mask
    vec4 light_map;     // side length of the maps in texels; of a texel in scene units; smoothing in scene units
    vec4 shade;         // irradiance of level ground in shade over that in sun; foam's extinction of sunlight
    vec4 lit_color;     // as scene_color and its origin, for the image that `lit` reads
    vec4 lit_origin;
    vec4 shadow_linear; // depth d of the shadow map -> (x d + y) / (z d + w), linear along the light
    vec4 shadow_basis;  // its Fourier basis: size in texels, map texels per texel, side length of a page
    vec4 shadow_filter; // half the box in texels, scale, offset, half the width of the ramp
    vec4 shadow_weight[4]; // of the terms
    mat4 before;        // eye -> previous eye, minus the identity
    vec4 before_lens;   // previous P00 P11; its near plane; device depth of the far end in this frame
    vec4 lens_change;   // P00 P11 P20 P21 minus the previous ones
    vec4 motion;        // seconds since the previous frame per spacing; spacing
    vec4 noise;         // height of 1 in scene units, foam; falloff per scene unit below the surface, half-axis
    vec4 noise_image;   // width, height of the surface noise; size of its texels in pixels; cells per scene unit
    vec4 noise_color;   // radiance of its foam; fraction of the height that water on the scene lacks
    vec4 whitewater;       // default radius of a whitewater particle; near and far end of the cross-fade to blobs, 0: none; 1 = the paper's falloff below the surface
    vec4 whitewater_below; // that falloff: scene units, exponents
    vec4 whitewater_light; // log2 of the intensity's half, its exponent; 1 = the paper's mixing; radius of a blob relative to its particle
    vec4 whitewater_search; // occlusion spheres: first radius, increment per pass, passes, samples per cubic pixel
    vec4 whitewater_samples; // minimum and maximum samples; reach of occluders in radii, or, negative, in scene units
    vec4 whitewater_opacity; // of fluid and solids; scale and exponent of the shadow
    vec4 whitewater_shadow; // colour that a shadow removes; its offset
    vec4 whitewater_color; // 2 albedo scale; radius of the blur relative to the first sphere
    vec4 whitewater_shapes[3]; // foam, spray, bubbles: exponents of the shape, its mean over the disc
    vec4 whitewater_life;  // exponents of the fade; number of sizes; relative radius of a bubble
    vec4 whitewater_sun;   // the sun's irradiance on a surface that faces it, over 2 pi
    vec4 shore_color;   // radiance of shoreline foam; its opacity
    vec4 contact_color; // radiance of contact foam; its lit share
    vec4 up;            // world, unit length; w: 1/n of the water
    vec4 bed;           // share of upward light that leaves the water; path of skylight, of sunlight, per unit of depth; 1/n, or 0: dry
    vec4 bed_light;     // pi over the irradiance; transmittance of sunlight relative to skylight
    vec4 wavelets[15];  // wave vector in the world, cycles per scene unit; phase in cycles
    vec4 panes[24];     // three rows per pane of glass: distance before it, place along its edges (0 to 1)
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
