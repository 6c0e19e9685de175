// Spheres in perspective: footprint and exact intersection. (The thesis offsets a billboard by N_z r: Sec. 4.6.1,
// Listings A.8, A.9.) Needs nothing.

// Bounds of the projected sphere in slopes xy / depth (min xy, max xy). They come from the tangents through the eye
// in the xz and yz planes. False if the sphere reaches the eye plane, or nearly does, and so has no (finite) bounds.
bool sphere_bounds(vec3 centre, float radius, out vec4 bounds) {
    float d = -centre.z;
    float h = d * d - radius * radius;
    if (d <= 1.01 * radius) {
        bounds = vec4(-1.0e10, -1.0e10, 1.0e10, 1.0e10);
        return false;
    }
    vec2 reach = radius * sqrt(centre.xy * centre.xy + h);
    bounds = vec4(centre.xy * d - reach, centre.xy * d + reach) / h;
    return true;
}

// Parameter t of the point t w at which a ray first meets a sphere; EMPTY if the ray misses, or if t is less than
// `near` (the far root is never taken). The discriminant uses the distance between centre and ray: at a distance of
// 1000 radii the textbook form loses half a radius to rounding.
float ray_hit(vec3 w, vec3 centre, float radius, float near) {
    float inverse = 1.0 / dot(w, w);
    float along = dot(w, centre) * inverse;
    vec3 off = centre - w * along;
    float left = radius * radius - dot(off, off);
    float t = along - sqrt(max(left, 0.0) * inverse);
    return left < 0.0 || t < near ? EMPTY : t;
}

// Eye depth at which the ray (slope, -1) from the eye first meets the sphere; EMPTY if it misses, or meets it
// before the depth `near`.
float sphere_hit(vec2 slope, vec3 centre, float radius, float near) {
    return ray_hit(vec3(slope, -1.0), centre, radius, near);
}

// Slope bounds to pixel bounds (min xy, max xy) of an image.
vec4 pixel_bounds(vec4 bounds, vec4 slope) {
    vec4 p = (bounds - slope.zwzw) / slope.xyxy;
    return vec4(min(p.xy, p.zw), max(p.xy, p.zw));
}

// From bounds in pixels (min xy, max xy), the first (xy) and last (zw) pixel whose centre lies in them, clamped to
// the image; there is none if last < first. The margin covers rounding.
ivec4 pixel_span(vec4 bounds, vec2 extent) {
    const float margin = 1.0 / 64.0;
    vec4 p = clamp(bounds, vec4(-1.0), extent.xyxy + 1.0);
    ivec2 first = max(ivec2(ceil(p.xy - 0.5 - margin)), ivec2(0));
    ivec2 last = min(ivec2(floor(p.zw - 0.5 + margin)), ivec2(extent) - 1);
    return ivec4(first, last);
}
