#version 460
// Pass `scene`: the sky, one triangle that covers the view at the farthest depth.
// Reads: the view. Writes: corners with their rays.

#include "../headless/scene.glsl"

layout(location = 0) out vec3 ray;

void main() {
    vec2 ndc = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
    gl_Position = vec4(ndc, scene.eye.w, 1.0);
    ray = scene.ray_z.xyz + ndc.x * scene.ray_x.xyz + ndc.y * scene.ray_y.xyz;
}
