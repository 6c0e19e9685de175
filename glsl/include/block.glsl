// Reduction of a block of pixels to one depth, for the smoothing (thesis Sec. 4.7 scales the depth down). Needs
// frame.glsl and the image `depth`.

// The depth that represents a block of pixels: the depth `nearest` of its nearest surface. If this surface covers
// less than a quarter of those pixels that show water, it is the depth of the next surface behind instead. Otherwise
// a drop would hide a texel of the pool behind it from the smoothing; the drop is drawn with its own shape anyway.
float block_depth(ivec2 first, ivec2 end, float nearest) {
    float second = EMPTY;
    int own = 0;
    int wet = 0;
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            float z = imageLoad(depth, ivec2(x, y)).x;
            bool same = z <= nearest + frame.surface.w;
            own += same ? 1 : 0;
            wet += z < EMPTY ? 1 : 0;
            second = same ? second : min(second, z);
        }
    }
    return 4 * own < wet ? second : nearest;
}
