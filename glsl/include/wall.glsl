// The wall, the film between two touching bubbles: part of a sphere through the circle in which the bubbles
// intersect. On this circle the wall's tangent bisects the angle between the two bubbles (Huszar, Szecsi, Sec. 3.2,
// whose print lacks the roots and squares of the formula). If the two bubbles and the wall meet there at 120 degrees,
// the radius r of the wall obeys Laplace's law, 1/r = 1/r_B - 1/r_A, with the radii r_A > r_B of the bubbles. Needs
// nothing. The wall is stored as curvature and apex, not as centre and radius: between equal bubbles it is a plane,
// and between nearly equal ones the sphere's radius exceeds single precision.

struct Wall {
    vec3 apex;
    vec3 axis;       // unit, from the larger bubble to the smaller
    float curvature; // 0 for a plane; the centre lies ahead on the axis
};

// Computes the wall (shared film) between the bubbles a and b (xyz centre, w radius), which have to intersect without
// one containing the other.
Wall wall_between(vec4 a, vec4 b) {
    if (a.w < b.w) {
        vec4 other = a;
        a = b;
        b = other;
    }
    vec3 apart = b.xyz - a.xyz;
    float square = dot(apart, apart);
    // Sine of half the angle between the radii to the circle of intersection.
    float sine = sqrt(max(0.5 - (a.w * a.w + b.w * b.w - square) / (4.0 * a.w * b.w), 1.0e-12));
    Wall wall;
    wall.axis = apart * inversesqrt(square);
    wall.curvature = (a.w - b.w) / (2.0 * a.w * b.w * sine);
    float k = wall.curvature;
    float way = (k * a.w * a.w + 2.0 * a.w * sine) / (1.0 + sqrt(1.0 + k * k * a.w * a.w + 2.0 * k * a.w * sine));
    wall.apex = a.xyz + way * wall.axis;
    return wall;
}

bool wall_inside(vec3 point, vec4 ball) {
    vec3 q = point - ball.xyz;
    return dot(q, q) <= ball.w * ball.w;
}

// Distance along a ray (unit direction) to the nearest point after the distance `from` at which it meets the wall,
// the part of the wall's sphere that is inside both bubbles; -1 if there is none.
float wall_hit(Wall wall, vec4 a, vec4 b, vec3 origin, vec3 direction, float from) {
    vec3 q = origin - wall.apex;
    float k = wall.curvature;
    // The ray meets the wall's sphere of curvature k at the roots t of k t^2 + 2 h t + c = 0, computed by a form of
    // the quadratic formula that stays precise for k near 0.
    float h = k * dot(q, direction) - dot(direction, wall.axis);
    float c = k * dot(q, q) - 2.0 * dot(q, wall.axis);
    float under = h * h - k * c;
    if (under < 0.0) {
        return -1.0;
    }
    float sum = -(h + (h < 0.0 ? -1.0 : 1.0) * sqrt(under));
    float near = sum != 0.0 ? c / sum : -1.0;
    float far = k != 0.0 ? sum / k : -1.0;
    vec2 hits = vec2(min(near, far), max(near, far));
    for (int i = 0; i < 2; ++i) {
        vec3 point = origin + hits[i] * direction;
        if (hits[i] > from && wall_inside(point, a) && wall_inside(point, b)) {
            return hits[i];
        }
    }
    return -1.0;
}

// Unit normal of the wall (film between two bubbles) at a point on it. It points from the larger bubble to the
// smaller.
vec3 wall_normal(Wall wall, vec3 point) {
    return normalize(wall.axis - wall.curvature * (point - wall.apex));
}
