// A whitewater particle as a ray meets it: a ball that faces the eye, as its sprite does. Distances across the view are
// measured at the depth of its centre, and distances along it are depths, so the integral of the kernel along a ray is
// the thickness of the sprite in that pixel (src/lib.rs derives the kernels). Needs view.glsl. Reads: records.

struct Ball {
    vec3 centre;   // x and y in eye space; depth
    float radius;  // 0: not in the picture
    vec3 kernel;   // of y = 1 - q^2 at q radii from the centre: sqrt(y) (a + b y + c y^2)
    float inverse; // 1 / radius
};

layout(set = 0, binding = 1, std430) readonly buffer Records { vec4 records[]; };

Ball ball_of(uint i) {
    vec4 where = records[2u * i];
    vec4 what = records[2u * i + 1u];
    return Ball(where.xyz, where.w, what.xyz, what.w);
}

// First and last index of a slab's samples that lie in a ball. Sample k lies t + k dt radii from the ball's centre
// along the ray. The range is empty if the ray misses the ball.
ivec2 samples_in(float rest, float t, float dt, int samples) {
    float reach = sqrt(max(rest, 0.0));
    vec2 k = clamp(vec2(ceil((-reach - t) / dt), floor((reach - t) / dt)), vec2(0.0, -1.0), vec2(samples, samples - 1));
    return rest > 0.0 ? ivec2(k) : ivec2(0, -1);
}
