// Water that stands against panes of glass is flush with them (src/water/panes.rs). The particles' surface there is a
// relief of columns with round edges, because a particle at the glass has neighbours on one side only. Not in the
// thesis.
// Needs frame.glsl, surface.glsl. Reads: nothing.

// Distance from a pane up to which water is flush with it, in spacings: of a surface at right angles to the pane, and
// of one that is parallel to it. The first is less, so that the level water behind a pane keeps its surface.
const vec2 FLUSH = vec2(0.5, 1.5);

// Whether a point, projected onto a pane's plane, lies on the pane.
bool on_pane(int pane, vec4 point) {
    vec2 along = vec2(dot(frame.panes[3 * pane + 1], point), dot(frame.panes[3 * pane + 2], point));
    return all(equal(along, clamp(along, 0.0, 1.0)));
}

// Moves a surface near a pane into the pane's plane, and makes it flat there. Returns whether there is a pane.
// `across`: distance from the pane's plane per depth along the view ray.
bool flush(inout Surface surface, vec2 slope, out float across) {
    across = 0.0;
    int pane = -1;
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    for (bool go = frame.texel.w > 0.0; go; go = false) {
        vec3 position;
        vec3 normal;
        surface_frame(surface, slope, position, normal);
        for (int i = 0; i < int(frame.texel.w); ++i) {
            vec4 plane = frame.panes[3 * i];
            float facing = dot(plane.xyz, vec3(slope, -1.0));
            float z = -plane.w / facing;
            float before = dot(plane, vec4(position, 1.0));
            float reach = frame.particle.y * mix(FLUSH.x, FLUSH.y, max(dot(normal, plane.xyz), 0.0));
            bool near = facing < 0.0 && z > 0.0 && abs(before) < reach;
            bool through = near && on_pane(i, vec4(z * vec3(slope, -1.0), 1.0));
            // Particles stick out through panes. If the ray meets one and passes beside the pane, only the water
            // behind the pane's plane counts.
            bool out_of_it = near && before > 0.0 && on_pane(i, vec4(position, 1.0));
            pane = through || out_of_it ? i : pane;
        }
    }
    // A loop instead of a branch, as above.
    for (bool any = pane >= 0; any; any = false) {
        vec4 plane = frame.panes[3 * pane];
        float facing = dot(plane.xyz, vec3(slope, -1.0));
        across = -facing;
        surface.z = -plane.w / facing;
        surface.dz = surface.z / -facing * plane.xy * frame.slope.xy;
    }
    return pane >= 0;
}
