// The thickness kernel: N_z exp(-2 rho^2), N_z = sqrt(1 - rho^2) (thesis Listing A.15; Eq. 3.4
// lacks the square). Its integral over the unit disc is pi J, J = 0.3400030. Needs frame.glsl.

// Fixed-point steps per amplitude (frame.particle.w) of a particle that is all water, in the compute path: 2^24, the
// resolution of a float. If a half-axis of 0.01 texels is enlarged to 1 texel, the amplitude is divided by 10000, which
// leaves 1700 steps.
const float UNITS = 16777216.0;

float thickness_kernel(float rho2) {
    return rho2 > 1.0 ? 0.0 : sqrt(1.0 - rho2) * exp(-2.0 * rho2);
}

// rho^2 at the point where the ray meets the plane of the sprite's centre.
float thickness_rho2(vec2 slope, vec3 centre, float inverse_axis) {
    vec2 off = (slope * -centre.z - centre.xy) * inverse_axis;
    return dot(off, off);
}

// Half-axis with which a sprite at a depth is drawn, and the factor by which its amplitude is divided. A sprite
// with a half-axis below one pixel gets one of a pixel and keeps its volume, so that far water neither sparkles nor
// vanishes between pixel centres.
float drawn_axis(float axis, float depth, vec4 slope, out float widened) {
    float least = depth * max(abs(slope.x), abs(slope.y));
    float drawn = max(axis, least);
    widened = drawn * drawn / (axis * axis);
    return drawn;
}

// Converts a sum (low word and carries) to metres.
float metres(uvec2 sum) {
    return (float(sum.y) * 4294967296.0 + float(sum.x)) * (frame.particle.w / UNITS);
}

// Value of the window without a boundary: more than enough water for one sheet.
const float ONE_SHEET = 1.0e6;

// Whether a texel keeps its boundary: where there is water on both sides, and where the scene hides the boundary at the
// texel's centre, because the water may be visible beside that.
bool keeps_boundary(float boundary, float front, float back, float scene) {
    return boundary < EMPTY && (front > 0.0 && back > 0.0 || scene > 0.0 && scene < boundary);
}

// Shares with which a sprite at a depth adds to the front sheet, the back sheet and the window between them.
// Water in the window means that both are one sheet.
vec3 sheet_shares(float z, float boundary) {
    if (boundary >= EMPTY) {
        return vec3(1.0, 0.0, ONE_SHEET);
    }
    float spacing = frame.particle.y;
    float off = z - boundary;
    float back = smoothstep(-0.5 * spacing, 0.5 * spacing, off);
    return vec3(1.0 - back, back, 1.0 - smoothstep(0.5 * spacing, spacing, abs(off)));
}
