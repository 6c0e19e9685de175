#version 460
// Pass `scene`: vertices of opaque meshes, which are in world space already.
// Reads: vertices. Writes: corners, with the attributes for scene.frag.

#include "../headless/scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 light;
layout(location = 4) in vec4 around;

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec2 out_uv;
layout(location = 3) out vec4 out_light;
layout(location = 4) out vec4 out_around;

// This draw and the draw of depth alone before it (depth.vert) must compute the same depth.
invariant gl_Position;

void main() {
    gl_Position = scene.clip * vec4(position, 1.0);
    out_position = position;
    out_normal = normal;
    out_uv = uv;
    out_light = light;
    out_around = around;
}
