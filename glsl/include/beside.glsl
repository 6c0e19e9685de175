// What is drawn where there is no water. Needs frame.glsl. Reads: foam depth, spray.

// 1: there may be some; else it is not read.
layout(constant_id = 9) const uint FOAM = 0;
layout(constant_id = 10) const uint SPRAY = 0;

layout(set = 0, binding = 13) uniform sampler2D foam_depth;
layout(set = 0, binding = 15) uniform sampler2D spray;

bool beside(ivec2 pixel) {
    bool foam = FOAM == 1u && texelFetch(foam_depth, pixel, 0).x < EMPTY;
    return foam || SPRAY == 1u && texelFetch(spray, pixel, 0).x > 0.0;
}
