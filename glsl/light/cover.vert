#version 460
// Pass `lit`: one triangle over the view.
// Reads: nothing. Writes: its corners.

void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0);
}
