#version 460
// Pass `map`, heights: writes no colour; the rasterizer writes the depth. Reads: nothing. Writes: nothing.

void main() {}
