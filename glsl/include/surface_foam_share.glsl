// Share of the water that is in front of the frontmost foam: T_wf of the thesis (Sec. 3.2.2), in which each particle
// is either in front or not (Listing A.14). Needs frame.glsl.

// 1: there may be foam.
layout(constant_id = 9) const uint FOAM = 0;

// Fraction of a thickness sprite that lies before the foam at depth `foam`; z is the depth of the sprite's centre.
float share_before(float z, float foam) {
    float spacing = frame.particle.y;
    return foam < EMPTY ? 1.0 - smoothstep(-0.5 * spacing, 0.5 * spacing, z - foam) : 1.0;
}
