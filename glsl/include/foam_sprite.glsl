// A foam sprite as it is drawn, by quads or by invocations. Needs frame.glsl, random.glsl,
// gradient_noise.glsl, foam.glsl, kernel.glsl.

// Over the foam, the depth's part of the half-axes: whole before there is enough foam to be seen, for what
// is behind the frontmost foam and what is before it changes at its outline.
const float DEPTH_GROWTH = 8.0;

struct FoamPlane {
    vec3 centre;
    vec3 e1;     // unit vectors along its axes
    vec3 e2;
    vec2 axes;   // half-axes
    vec3 normal;
    float texel; // width of one at its centre
    float torn;  // strength of its noise
};

FoamPlane foam_plane(FoamSprite sprite, bool thick) {
    FoamPlane plane;
    plane.centre = sprite.centre.xyz;
    float stretch = foam_axes(sprite, plane.e1, plane.e2);
    plane.normal = cross(plane.e1, plane.e2);
    plane.texel = -sprite.centre.z * max(abs(frame.thick_slope.x), abs(frame.thick_slope.y));
    float b = frame.particle.x * FOAM_AXIS;
    // Cells of less than a texel cannot be told from each other; those of two are seen whole.
    plane.torn = frame.foam_noise.x * smoothstep(1.0, 2.0, b / (NOISE_CELLS * plane.texel));
    float part = thick ? 1.0 : min(DEPTH_GROWTH * sprite.centre.w, 1.0);
    plane.axes = max(vec2(b * (1.0 + stretch), b), vec2(LEAST_FOAM_AXIS * plane.texel)) * part;
    return plane;
}

// Metres in its middle, and its place in the noise. As a thickness sprite of water: the integral over the
// picture's plane is the volume.
vec4 foam_look(FoamSprite sprite, FoamPlane plane) {
    float facing = max(abs(plane.normal.z), LEAST_FACING);
    float volume = frame.particle.w * frame.particle.z * frame.particle.z;
    vec3 phase = noise_phase(floatBitsToUint(sprite.rest.x)) * 64.0;
    return vec4(sprite.centre.w * volume / (plane.axes.x * plane.axes.y * facing),
                phase + vec3(0.0, 0.0, sprite.velocity.w * frame.foam_noise.y));
}

// What it adds where a ray meets it: to all foam, to the layer right behind the frontmost, to what of that the
// sun lights, and by how far behind the frontmost it lies. Whole steps, their sums are exact, in any order.
// torn: strength of the noise, share of the sun's light. before: metres to the scene.
vec4 foam_steps(vec4 look, vec2 torn, vec2 place, float depth, float front, float before) {
    float noise = gradient_noise(vec3(NOISE_CELLS * place, 0.0) + look.yzw);
    float amount = look.x * thickness_kernel(dot(place, place));
    amount *= max(1.0 + torn.x * noise, 0.0);
    // It sinks into the scene softly: a sprite that the scene cuts would end in steps of the texels.
    amount *= min(before / (0.5 * frame.particle.y), 1.0);
    // The layer ends softly, within a spacing: what passes its end would pop.
    float past = clamp((depth - front - frame.foam.w) / frame.particle.y, 0.0, 1.0);
    float first = front < EMPTY ? 1.0 - past * past * (3.0 - 2.0 * past) : 0.0;
    // Bounded, so that steps can hold its sum, and led by what is near, which hides the rest.
    float behind = max(depth - front - frame.particle.y, 0.0);
    float far = behind / (behind + frame.particle.y);
    return floor(amount * vec4(1.0, first, first * torn.y, far) / frame.foam_back.w + 0.5);
}
