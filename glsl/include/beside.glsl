// Tells which pixels and blocks without water are shaded nevertheless. Needs frame.glsl, surface_foam_texels.glsl.
// Reads: foam depth, spray, depth of whitewater particles, depth of bubble foam.

// 1: there may be surface foam; 0: its image is not read.
layout(constant_id = 9) const uint FOAM = 0;
layout(constant_id = 10) const uint SPRAY = 0;
layout(constant_id = 20) const uint WHITEWATER = 0;
layout(constant_id = 22) const uint SOAP = 0;
// Width of a foam texel in pixels. It is a constant, so that loops over texels are unrolled.
layout(constant_id = 3) const uint FOAM_EDGE = 4;

layout(set = 0, binding = 13) uniform sampler2D foam_depth;
layout(set = 0, binding = 15) uniform sampler2D spray;
layout(set = 0, binding = 21) uniform sampler2D whitewater;
layout(set = 0, binding = 25) uniform sampler2D soap_depth;

bool spray_at(ivec2 pixel) {
    return SPRAY == 1u && texelFetch(spray, pixel, 0).x > 0.0
        || WHITEWATER == 1u && texelFetch(whitewater, pixel, 0).x < EMPTY
        || SOAP == 1u && texelFetch(soap_depth, pixel, 0).x < EMPTY;
}

// Returns whether a block of `side` x `side` pixels, with its first pixel at `corner`, may show surface foam; the
// scene may still hide this foam. `side` is a power of two and both coordinates of `corner` are multiples of it. So
// all pixels in the same quarter of a foam texel are interpolated from the same four texels, which are read once.
bool foam_beside(ivec2 corner, int side) {
    int step = max(int(FOAM_EDGE) / 2, 1);
    vec4 z = vec4(EMPTY);
    for (int y = 0; y < side; y += step) {
        for (int x = 0; x < side; x += step) {
            vec2 h = (vec2(corner + ivec2(x, y)) + 0.5) / float(FOAM_EDGE) - 0.5;
            h = clamp(h, vec2(0.0), frame.thick_extent.xy - 1.0);
            z = min(z, textureGather(foam_depth, (floor(h) + 1.0) / vec2(textureSize(foam_depth, 0))));
        }
    }
    return FOAM == 1u && any(lessThan(z, vec4(EMPTY)));
}
