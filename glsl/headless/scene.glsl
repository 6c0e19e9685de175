// Data that all shaders of pass `scene`, the stand-in scene, share: the view, the sun, the transform to the shadow map,
// the sea.
// Reads: the scene's block (src/headless/scene/mod.rs writes it).

const float PI = 3.14159265;
const int WAVES = 28;

layout(set = 0, binding = 0, std140) uniform Scene {
    mat4 clip;          // world to clip space
    mat4 shadow;        // world to the shadow map's uv and depth
    vec4 eye;           // eye position (world); w: cleared value of the device depth
    vec4 ray_x;         // a pixel's ray (world) is ray_z + ndc.x · ray_x + ndc.y · ray_y; w: ndc per pixel
    vec4 ray_y;         // w: ndc per pixel
    vec4 ray_z;
    vec4 sun_direction; // direction to the sun (world); w: 1 if ground or backdrop hide the sky's lower half
    vec4 sun_color;     // irradiance on a surface that faces the sun; w: radiance of the disc divided by it,
                        // 0 if the environment shows the sun itself
    vec4 shadow_texel;  // texel of the shadow map in uv (xy) and in world units; height of the ground, -1e9: none
    vec4 ground;        // centre x and z, distances at which the ground begins and ends to fade into the sky
    vec4 air;           // 1 / length of the haze, 0: clear; metres per world unit for procedural surfaces;
                        // clouds and band over the horizon, 0 to 1
    vec4 splashed;      // least x and z, greatest x and z of the basin that splashes on the paving around it;
                        // least > greatest: none
    vec4 sea;           // level, length of the largest waves or of a plate of lava, unused, path of sunlight per unit of depth
    vec4 absorption;    // of water, per world unit; w: variance of the slopes of all waves
    vec4 scattering;    // of water, per world unit; w: fraction of the loop that has passed (lava)
    vec4 lava;          // radiance of the hottest parts; w: 1 if it loops
    vec4 flow;          // of lava: direction x and z (of gusts on water too); distance flown, and that of a
                        // copy one loop behind
    vec4 waves[WAVES];  // of water: wave number along x and z in radians per world unit, amplitude, phase
    vec4 shifts[WAVES]; // of each wave: factors of unrest() in its phase; variance of the slopes of this wave
                        // and all shorter ones
} scene;
