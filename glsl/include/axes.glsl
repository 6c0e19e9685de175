// Shape of an ellipsoid: the symmetric matrix that maps a sphere of the particle's radius to the ellipsoid (Yu and
// Turk 2013, Eq. 16: the inverse of G without 1/h). It is stored as six 16-bit numbers, whose steps move the surface
// by less than a 5000th of the radius. Needs nothing.

// Largest absolute value that an element of the matrix can store. It suffices for ellipsoids with the sphere's
// volume whose longest half-axis is at most 8 times the shortest: this half-axis is at most 4 radii if they are
// elongated, and less if they are flat.
const float MOST_AXIS = 4.0;

uvec3 pack_axes(mat3 axes) {
    vec3 diagonal = vec3(axes[0].x, axes[1].y, axes[2].z) / MOST_AXIS;
    vec3 off = vec3(axes[2].y, axes[2].x, axes[1].x) / MOST_AXIS;
    return uvec3(packSnorm2x16(diagonal.xy), packSnorm2x16(vec2(diagonal.z, off.x)), packSnorm2x16(off.yz));
}

// Sum of the squares of the half-axes.
float axes_norm2(mat3 axes) {
    return dot(axes[0], axes[0]) + dot(axes[1], axes[1]) + dot(axes[2], axes[2]);
}

mat3 unpack_axes(uvec3 words) {
    vec2 a = unpackSnorm2x16(words.x) * MOST_AXIS;
    vec2 b = unpackSnorm2x16(words.y) * MOST_AXIS;
    vec2 c = unpackSnorm2x16(words.z) * MOST_AXIS;
    return mat3(vec3(a.x, c.y, c.x), vec3(c.y, a.y, b.y), vec3(c.x, b.y, b.x));
}
