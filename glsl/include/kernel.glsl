// The kernel of a particle's thickness sprite: N_z exp(-2 rho^2), N_z = sqrt(1 - rho^2) (thesis Listing A.15; Eq. 3.4
// lacks the square), where rho is the distance from the sprite's centre in half-axes. Its integral over the unit disc
// is pi J, J = 0.3400030. Needs frame.glsl.

// Fixed-point steps of the compute path per amplitude of a thickness sprite, frame.particle.w (that of a particle
// that is all water): 2^24, the resolution of a float. If a sprite with a half-axis of 0.01 texels is enlarged to 1
// texel, its amplitude is divided by 10000, which leaves 1700 steps.
const float UNITS = 16777216.0;

float thickness_kernel(float rho2) {
    return rho2 > 1.0 ? 0.0 : sqrt(1.0 - rho2) * exp(-2.0 * rho2);
}

// Returns rho^2 (rho: distance from the sprite's centre in half-axes) where a ray with this slope meets the plane of
// constant depth through the centre.
float thickness_rho2(vec2 slope, vec3 centre, float inverse_axis) {
    vec2 off = (slope * -centre.z - centre.xy) * inverse_axis;
    return dot(off, off);
}

// Half-axis with which a sprite at a depth is drawn; `slope` converts texels of the image to slopes of rays. A
// half-axis below one texel is enlarged to one texel while the sprite keeps its volume: its amplitude is then divided
// by `widened`. So far water does not sparkle, and no sprite vanishes between texel centres.
float drawn_axis(float axis, float depth, vec4 slope, out float widened) {
    float least = depth * max(abs(slope.x), abs(slope.y));
    float drawn = max(axis, least);
    widened = drawn * drawn / (axis * axis);
    return drawn;
}

// Converts a sum (low word and carries) to scene units.
float metres(uvec2 sum) {
    return (float(sum.y) * 4294967296.0 + float(sum.x)) * (frame.particle.w / UNITS);
}

// Amount of water in the window (third value of sheet_shares) of a texel without a boundary: so much that it always
// counts as a single layer.
const float ONE_SHEET = 1.0e6;

// Whether a texel keeps its boundary, the depth that separates two layers of water. It does if there is water on both
// sides of the boundary, or if the scene hides the boundary at the texel's centre, because other pixels of the texel
// may show the water behind it.
bool keeps_boundary(float boundary, float front, float back, float scene) {
    return boundary < EMPTY && (front > 0.0 && back > 0.0 || scene > 0.0 && scene < boundary);
}

// The window is the range of depth around the boundary between two sheets (layers of water). Water in it means that
// both are one. Distances from the boundary, in spacings, up to which water counts fully, and from which on it does not
// count. The narrowest air has its particles 1.05 spacings from its middle (gaps.glsl), so it is closed before it ends.
const vec2 WINDOW = vec2(0.5, 1.5);

// Shares of a thickness sprite at depth z that belong to the front sheet, to the back sheet, and to the window.
vec3 sheet_shares(float z, float boundary) {
    if (boundary >= EMPTY) {
        return vec3(1.0, 0.0, ONE_SHEET);
    }
    float spacing = frame.particle.y;
    float off = z - boundary;
    float back = smoothstep(-0.5 * spacing, 0.5 * spacing, off);
    return vec3(1.0 - back, back, 1.0 - smoothstep(WINDOW.x * spacing, WINDOW.y * spacing, abs(off)));
}
