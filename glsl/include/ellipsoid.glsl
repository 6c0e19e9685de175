// A particle as it is drawn, as a sphere or an ellipsoid (Yu and Turk 2013), in perspective: its bounds on the
// screen, exact intersection with a ray, and thickness sprite. In lists of ellipsoids each particle has two entries:
// its sphere, then its shape (axes.glsl). Needs frame.glsl, sphere.glsl.

#include "axes.glsl"

// 1: ellipsoids.
layout(constant_id = 15) const uint ELLIPSOIDS = 0;
// Number of vec4 entries per particle in a list.
const uint ENTRIES = 1u + ELLIPSOIDS;

struct Ellipsoid {
    vec4 sphere;  // eye-space centre; radius
    mat3 axes;    // maps a sphere of that radius to the ellipsoid; unused for spheres, as are the two below
    mat3 inverse; // maps the ellipsoid to that sphere
    vec3 centre;  // centre in that space
};

Ellipsoid ellipsoid_of(vec4 sphere, vec4 shape) {
    Ellipsoid e = Ellipsoid(sphere, mat3(1.0), mat3(1.0), sphere.xyz);
    if (ELLIPSOIDS == 1u) {
        e.axes = unpack_axes(floatBitsToUint(shape.xyz));
        e.inverse = inverse(e.axes);
        e.centre = e.inverse * sphere.xyz;
    }
    return e;
}

// A particle of the list LIST.
#define ellipsoid_in(LIST, INDEX) \
    ellipsoid_of(LIST[ENTRIES * (INDEX)], LIST[ENTRIES * (INDEX) + ELLIPSOIDS])

// Matrix B of the ellipsoid's dual form: the tangent plane with unit normal n has the distance sqrt(n.B n) from the
// ellipsoid's centre.
mat3 ellipsoid_dual(Ellipsoid e, float radius) {
    return (radius * radius) * (e.axes * e.axes);
}

// Bounds like those of sphere_bounds. The plane x = s depth through the eye is tangent to the ellipsoid if (c_x - s
// d)^2 = (1, s).B (1, s), with the centre's x coordinate c_x and depth d, and the x and z elements of B. The same
// holds for y.
bool ellipsoid_bounds(Ellipsoid e, out vec4 bounds) {
    if (ELLIPSOIDS == 0u) {
        return sphere_bounds(e.sphere.xyz, e.sphere.w, bounds);
    }
    mat3 b = ellipsoid_dual(e, e.sphere.w);
    vec2 c = e.sphere.xy;
    float d = -e.sphere.z;
    if (d <= 1.01 * sqrt(b[2].z)) {
        bounds = vec4(-1.0e10, -1.0e10, 1.0e10, 1.0e10);
        return false;
    }
    vec2 square = vec2(b[0].x, b[1].y);
    vec2 mixed = b[2].xy;
    // The difference of two positive forms, which avoids fourth powers of the depth.
    vec2 root = square * (d * d) + 2.0 * c * d * mixed + c * c * b[2].z - (square * b[2].z - mixed * mixed);
    vec2 reach = sqrt(max(root, vec2(0.0)));
    vec2 middle = c * d + mixed;
    bounds = vec4(middle - reach, middle + reach) / (d * d - b[2].z);
    return true;
}

// Eye depth of the nearest point.
float ellipsoid_nearest(Ellipsoid e) {
    if (ELLIPSOIDS == 0u) {
        return -e.sphere.z - e.sphere.w;
    }
    // Rounding must not put this nearest depth of the ellipsoid behind a hit of a ray on it, so 1.0e-5 of both terms,
    // centre depth and root, is subtracted.
    return -e.sphere.z * (1.0 - 1.0e-5) - 1.00001 * sqrt(ellipsoid_dual(e, e.sphere.w)[2].z);
}

// Like sphere_hit.
float ellipsoid_hit(vec2 slope, Ellipsoid e, float near) {
    if (ELLIPSOIDS == 0u) {
        return sphere_hit(slope, e.sphere.xyz, e.sphere.w, near);
    }
    return ray_hit(e.inverse * vec3(slope, -1.0), e.centre, e.sphere.w, near);
}

// An upper bound of the longest half-axis, in units of the radius.
float ellipsoid_reach(Ellipsoid e) {
    vec3 rows = abs(e.axes[0]) + abs(e.axes[1]) + abs(e.axes[2]);
    return max(rows.x, max(rows.y, rows.z));
}

// The thickness sprite: an ellipse in the plane through the ellipsoid's centre at constant depth. It is the parallel
// projection of the ellipsoid to this plane, along the ray through the centre.
struct Disc {
    vec3 conic;   // (xx, xy, yy) of the quadratic form rho^2
    vec2 reach;   // half of its bounding box
    float area;   // product of the half-axes
};

// The thickness sprite of an ellipsoid with axes multiplied by `scale`. `slope` converts texels of the image to slopes
// of rays; half-axes below one texel are widened to one. The thickness at the centre must be divided by `area`, so
// that the sprite keeps its volume.
Disc ellipsoid_disc(Ellipsoid e, float scale, vec4 slope) {
    mat3 b = ellipsoid_dual(e, scale * e.sphere.w);
    float depth = -e.sphere.z;
    vec2 w = e.sphere.xy / depth;
    float xx = b[0].x + w.x * (2.0 * b[2].x + w.x * b[2].z);
    float yy = b[1].y + w.y * (2.0 * b[2].y + w.y * b[2].z);
    float xy = b[0].y + w.x * b[2].y + w.y * b[2].x + w.x * w.y * b[2].z;
    float least = depth * max(abs(slope.x), abs(slope.y));
    least *= least;
    float middle = 0.5 * (xx + yy);
    float apart = length(vec2(0.5 * (xx - yy), xy));
    vec2 squares = vec2(middle + apart, max(middle - apart, 0.0)); // of the half-axes
    if (squares.x <= least) {
        xx = least;
        yy = least;
        xy = 0.0;
    } else if (squares.y < least) {
        // Widens only the shorter axis, by the projector on it.
        float more = (least - squares.y) / (squares.x - squares.y);
        vec3 onto = vec3(squares.x - xx, -xy, squares.x - yy) * more;
        xx += onto.x;
        xy += onto.y;
        yy += onto.z;
    }
    float area2 = max(squares.x, least) * max(squares.y, least);
    Disc disc;
    disc.conic = vec3(yy, -xy, xx) / area2;
    disc.reach = sqrt(vec2(xx, yy));
    disc.area = sqrt(area2);
    return disc;
}

// rho^2 at the point where the ray meets the sprite's plane; rho is the distance from the centre in half-axes, 1 at
// the rim.
float disc_rho2(vec2 slope, vec3 centre, vec3 conic) {
    vec2 off = slope * -centre.z - centre.xy;
    return off.x * (conic.x * off.x + 2.0 * conic.y * off.y) + conic.z * off.y * off.y;
}
