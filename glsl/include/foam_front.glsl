// The frontmost foam of a texel of the thickness. Reads: foam depth.

layout(set = 0, binding = 7) uniform sampler2D foam_depth;

// Its depth; EMPTY where there is none.
float foam_at(ivec2 texel) {
    return texelFetch(foam_depth, texel, 0).x;
}
