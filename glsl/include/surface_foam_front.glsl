// The frontmost foam of a texel of the thickness. Reads: foam depth.

layout(set = 0, binding = 7) uniform sampler2D foam_depth;

// Depth of the foam; EMPTY without foam.
float foam_at(ivec2 texel) {
    return texelFetch(foam_depth, texel, 0).x;
}
