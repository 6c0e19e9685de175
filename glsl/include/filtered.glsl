// Bilinear look-up in a part of an image.

// The value at `place`, a position in texels from the corner of the part. Texels outside the part are never read, not
// even with weight 0, because a NaN in them would come through. So at the centre of a texel only this texel is
// fetched, and other positions are clamped to be at least 1/256 of a texel (a step of the filter's 8 bits) inside the
// centres of the outermost texels.
vec4 filtered(sampler2D image, vec2 place, vec2 first, vec2 size) {
    place = clamp(place, vec2(0.5), size - 0.5);
    vec2 texel = floor(place);
    if (all(lessThan(abs(place - texel - 0.5), vec2(1.0 / 512.0)))) {
        return texelFetch(image, ivec2(first + texel), 0);
    }
    vec2 edge = min(vec2(0.5 + 1.0 / 256.0), 0.5 * size);
    return textureLod(image, (first + clamp(place, edge, size - edge)) / vec2(textureSize(image, 0)), 0.0);
}
