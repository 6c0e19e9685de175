#version 460
// Pass `map`, heights: only depth is written. Reads: nothing. Writes: nothing.

void main() {}
