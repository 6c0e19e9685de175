// What all shaders of pass `scene`, the stand-in scene, share: the view, the sun, the shadow map's place, the sea.
// Reads: the scene's block (src/headless/scene/mod.rs writes it).

const float PI = 3.14159265;
const int WAVES = 18;

layout(set = 0, binding = 0, std140) uniform Scene {
    mat4 clip;          // world to clip space
    mat4 shadow;        // world to the shadow map's uv and depth
    vec4 eye;           // position of the eye (world); w: device depth of nothing
    vec4 ray_x;         // a pixel's ray (world) is ray_z + ndc.x · ray_x + ndc.y · ray_y; w: ndc of a pixel
    vec4 ray_y;         // w: ndc of a pixel
    vec4 ray_z;
    vec4 sun_direction; // to the sun (world); w: 1 where the ground hides the sky's lower half
    vec4 sun_color;     // irradiance on a surface that faces the sun; w: radiance of the disc over it, 0 where the picture shows it
    vec4 shadow_texel;  // uv, world size of a texel of the shadow map, height of the ground
    vec4 ground;        // centre x and z, where the ground begins and ends to fade into the sky
    vec4 air;           // one over the length of the haze, 0: clear; metres of procedural surfaces a world unit
    vec4 sea;           // level, length of its largest waves or of a plate of lava, unused, way of the sun's light a metre down
    vec4 absorption;    // of water, 1/m; w: variance of all the waves' slopes
    vec4 scattering;    // of water, 1/m; w: share of the loop that has passed (lava)
    vec4 lava;          // radiance where it is hottest; w: 1 where it loops
    vec4 flow;          // of lava: where to, x and z; how far it is, and how far it was or will be a loop away
    vec4 waves[WAVES];  // of water: radians a metre along x and z, height, phase
} scene;
