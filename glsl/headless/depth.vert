#version 460
// Pass `scene`: depth only, seen from the eye or from the sun.
// Reads: vertices. Writes: depth.

layout(location = 0) in vec3 position;
layout(push_constant, std430) uniform Push { mat4 clip; } push;

invariant gl_Position;

void main() {
    gl_Position = push.clip * vec4(position, 1.0);
}
