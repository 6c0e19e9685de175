// Words of each texel in the compute path of surface foam, next to each other: two depths, then fixed-point sums of
// all foam, of the shadowed part of the front layer (with LIT), of all foam times a weight from 0 to 1 that grows
// with its distance behind the frontmost foam, and of the foam behind the front layer. For most sprites all addends
// but the first are zero and are not added.

// 1: something casts shadows on foam.
layout(constant_id = 1) const uint LIT = 0;

// Words of a texel with depths. FRONT: bits of the depth of the frontmost foam, or of the scene if no foam is before
// the scene. SCENE: bits of the scene's depth. Bits of positive floats have the same order as the floats.
const uint FRONT = 0u;
const uint SCENE = 1u;
const uint ALL = 2u;
const uint UNLIT = 3u;
const uint FAR = 3u + LIT;
const uint LATE = 4u + LIT;
const uint WORDS = 5u + LIT;

// Max sum, in fixed-point steps: single precision represents all integers up to it. It is a thickness of 4096 to
// 8192 spacings of foam, because a step is more than 1/4096 and at most 1/2048 of a spacing (`foam_step`).
const uint FULL = 16777216u;
// No more is added to a sum that has reached this. A sprite adds at most 25 thousand steps without the foam's pattern,
// so up to 2^32 there is room for 85 thousand invocations that add at the same time. The pattern multiplies the steps
// (`foam_steps`), so with it there is room for fewer.
const uint HALF_FULL = 2147483648u;

uint words_of(ivec2 texel) {
    return WORDS * (uint(texel.y) * uint(frame.thick_extent.x) + uint(texel.x));
}
