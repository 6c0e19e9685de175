#version 460
// Pass `map`, heights: the depth alone is written. Reads: nothing. Writes: nothing.

void main() {}
