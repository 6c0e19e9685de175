// What all shaders of pass `scene`, the stand-in scene, share: the view, the sun, the shadow map's place.
// Reads: the scene's block (src/headless/scene/mod.rs writes it).

const float PI = 3.14159265;

layout(set = 0, binding = 0, std140) uniform Scene {
    mat4 clip;          // world to clip space
    mat4 shadow;        // world to the shadow map's uv and depth
    vec4 eye;           // position of the eye (world); w: device depth of nothing
    vec4 ray_x;         // a pixel's ray (world) is ray_z + ndc.x · ray_x + ndc.y · ray_y
    vec4 ray_y;
    vec4 ray_z;
    vec4 sun_direction; // to the sun (world); w: 1 where the ground hides the sky's lower half
    vec4 sun_color;     // irradiance on a surface that faces the sun; w: radiance of the disc over it
    vec4 shadow_texel;  // uv, world size of a texel of the shadow map, height of the ground
    vec4 ground;        // centre x and z, where the ground begins and ends to fade into the sky
} scene;
