// A foam sprite as it is drawn, by quads or by invocations. Needs frame.glsl, random.glsl, whole_steps.glsl,
// gradient_noise.glsl, surface_foam.glsl, pattern.glsl, kernel.glsl.

// Factor for the sprites from which the foam's depth is found: their size relative to the full one is DEPTH_GROWTH
// times the particle's amount of foam (0 to 1), at most 1. So they reach full size while the foam is hardly visible:
// at a sprite's outline the division into front layer and foam behind it changes, which would show.
const float DEPTH_GROWTH = 8.0;

struct FoamPlane {
    vec3 centre;
    vec3 e1;     // unit vectors along its axes
    vec3 e2;
    vec2 axes;   // half-axes, scene units
    vec3 normal;
    float texel; // width of a texel at its centre
};

// Noise that varies the amount of foam within a sprite, as if it were torn: the sprite's own noise, or the finest
// octave of the foam's pattern.
struct FoamNoise {
    vec3 place;  // at its centre
    vec3 along;  // change to the end of its half-axes
    vec3 across;
    vec3 coarse; // logarithm of the pattern at its centre, and its change to the end of the half-axes
    vec2 torn;   // strength of the noise; visibility of the sun
    uint chance; // for stochastic rounding
};

FoamPlane foam_plane(FoamSprite sprite, bool thick) {
    FoamPlane plane;
    plane.centre = sprite.centre.xyz;
    float stretch = foam_axes(sprite, plane.e1, plane.e2);
    plane.normal = cross(plane.e1, plane.e2);
    plane.texel = -sprite.centre.z * max(abs(frame.thick_slope.x), abs(frame.thick_slope.y));
    float b = frame.particle.x * FOAM_AXIS;
    float part = thick ? 1.0 : min(DEPTH_GROWTH * sprite.centre.w, 1.0);
    plane.axes = max(vec2(b * (1.0 + stretch), b), vec2(LEAST_FOAM_AXIS * plane.texel)) * part;
    return plane;
}

// Thickness in scene units along z at the sprite's centre. As for the water's thickness sprites, its integral over
// the plane of constant depth is the volume. A unit square of slopes (xy / depth) covers the area z^2 / |n . centre /
// z| of the sprite's plane with normal n; away from the optical axis this differs from z^2 / |n.z|.
float foam_amount(FoamSprite sprite, FoamPlane plane) {
    float facing = max(abs(dot(plane.normal, plane.centre) / plane.centre.z), LEAST_FACING);
    float volume = frame.particle.w * frame.particle.z * frame.particle.z;
    return sprite.centre.w * volume / (plane.axes.x * plane.axes.y * facing);
}

bool has_pattern() {
    return frame.foam_pattern.x > 0.0;
}

FoamNoise foam_noise(FoamSprite sprite, FoamPlane plane) {
    uint id = floatBitsToUint(sprite.rest.x);
    FoamNoise noise;
    if (has_pattern()) {
        // Two phases of the pattern cross-fade. By its id a sprite has one of them, so that each texel has sprites of
        // both.
        uint phase = pcg(id) >> 31;
        float width = frame.particle.y * frame.foam_octaves.x * OCTAVES[2];
        mat3 turn = mat3(frame.world);
        noise.place = pattern_place((frame.world * vec4(plane.centre, 1.0)).xyz, turn * sprite.velocity.xyz, phase, 2u);
        noise.along = turn * plane.e1 * (plane.axes.x / width);
        noise.across = turn * plane.e2 * (plane.axes.y / width);
        float strength = frame.foam_pattern.x * HEIGHTS[2] * told_apart(width, plane.texel);
        noise.torn.x = strength * frame.foam_phases[phase];
        vec2 rise = vec2(dot(sprite.pattern.xyz, plane.e1), dot(sprite.pattern.xyz, plane.e2)) * plane.axes;
        noise.coarse = vec3(sprite.pattern.w, clamp(rise, -MOST_PATTERN, MOST_PATTERN));
        noise.coarse.x -= 0.5 * VARIANCE * noise.torn.x * noise.torn.x;
    } else {
        noise.place = noise_phase(id) * 64.0 + vec3(0.0, 0.0, sprite.velocity.w * frame.foam_noise.y);
        noise.along = vec3(NOISE_CELLS, 0.0, 0.0);
        noise.across = vec3(0.0, NOISE_CELLS, 0.0);
        noise.coarse = vec3(0.0);
        float cell = frame.particle.x * FOAM_AXIS / NOISE_CELLS;
        noise.torn.x = frame.foam_noise.x * told_apart(cell, plane.texel);
    }
    noise.torn.y = sprite.rest.y;
    noise.chance = chance_of(id, 0u);
    return noise;
}

// Amounts that a sprite adds to a texel. x: to all foam. y: to the front layer, which is the foam right behind the
// frontmost. z: to the sunlit part of the front layer. w: to all foam weighted by its distance behind the frontmost.
// All are whole steps, so that sums are exact in any order, and all are rounded with the same random number, so that
// a part never exceeds the whole. `before` is the distance from the sprite to the scene behind it.
vec4 foam_steps(ivec2 texel, float amount, FoamNoise own, vec2 place, float depth, float front, float before) {
    float noise = own.torn.x * gradient_noise(own.place + own.along * place.x + own.across * place.y);
    amount *= thickness_kernel(dot(place, place));
    amount *= has_pattern() ? exp(own.coarse.x + dot(own.coarse.yz, place) + noise) : max(1.0 + noise, 0.0);
    // The sprite fades into the scene: a hard cut would show the texels as steps.
    amount *= min(before / (0.5 * frame.particle.y), 1.0);
    // The front layer ends softly within a spacing, so that foam does not pop when it passes the layer's end.
    float past = clamp((depth - front - frame.foam.w) / frame.particle.y, 0.0, 1.0);
    float first = front < EMPTY ? 1.0 - past * past * (3.0 - 2.0 * past) : 0.0;
    // `far` is 0 up to one spacing behind the frontmost foam and grows with the distance behind that. It is bounded by
    // 1, so that steps can hold the sum, and gives most weight to changes of near foam, which hides the rest.
    float behind = max(depth - front - frame.particle.y, 0.0);
    float far = behind / (behind + frame.particle.y);
    return floor(amount * vec4(1.0, first, first * own.torn.y, far) / frame.foam_back.w + rounding_up(own.chance, texel));
}
