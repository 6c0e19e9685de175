// How much of the water is before the frontmost foam: T_wf of the source (thesis Sec. 3.2.2), which asks
// once a particle (Listing A.14). Needs frame.glsl. Reads: foam depth.

// 1: there may be foam; else it is not read.
layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 7) uniform sampler2D foam_depth;

// Depth of the frontmost foam in a texel.
float foam_at(ivec2 texel) {
    return texelFetch(foam_depth, texel, 0).x;
}

// Share of a sprite whose centre lies at a depth.
float share_before(float z, float foam) {
    float spacing = frame.particle.y;
    return foam < EMPTY ? 1.0 - smoothstep(-0.5 * spacing, 0.5 * spacing, z - foam) : 1.0;
}
