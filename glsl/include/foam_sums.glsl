// Words of each texel in the compute path of surface foam, next to each other: fixed-point sums of all foam, of the
// shadowed part of the front layer, of all foam times its distance behind the frontmost, and of the foam behind the
// front layer. For most sprites all but the first are zero and not added.

// 1: something casts shadows on foam.
layout(constant_id = 1) const uint LIT = 0;

// Bits of the depth of the frontmost, of the scene's where there is none before it, and of the scene's. Positive
// floats order as their bits do.
const uint FRONT = 0u;
const uint SCENE = 1u;
const uint ALL = 2u;
const uint UNLIT = 3u;
const uint FAR = 3u + LIT;
const uint LATE = 4u + LIT;
const uint WORDS = 5u + LIT;

// No sum is more: single precision holds all whole numbers up to it. It is 4096 spacings of foam or more.
const uint FULL = 16777216u;
// From here on nothing is added: room is left for what 85 thousand invocations may be adding at once.
const uint HALF_FULL = 2147483648u;

uint words_of(ivec2 texel) {
    return WORDS * (uint(texel.y) * uint(frame.thick_extent.x) + uint(texel.x));
}
