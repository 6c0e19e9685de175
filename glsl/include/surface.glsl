// The smoothed water surface at a full-resolution pixel, from its reduced image: depth and
// derivatives of the four texels around it that lie on the pixel's own surface (thesis Sec. 4.10,
// Listings A.16-A.18). Where the source shades four neighbours at a border and blends their
// colours, we blend the derivatives of those on the same surface and shade once: the colour of
// another surface never bleeds in, which shows as dark seams.

struct Surface {
    float z;
    vec2 dz;        // per reduced pixel
    vec4 weights;   // of the four texels, sum 1
    ivec2 base;     // the first of them
};

layout(set = 0, binding = 1) uniform sampler2D smoothed;

float smoothed_at(ivec2 p) {
    ivec2 last = ivec2(frame.extent.zw) - 1;
    bool outside = p.x < 0 || p.y < 0 || p.x > last.x || p.y > last.y;
    return outside ? EMPTY : texelFetch(smoothed, p, 0).x;
}

// One-sided where the other side is another surface; the smaller one where both might do.
float difference(float before, float z, float after, float threshold) {
    float a = z - before;
    float b = after - z;
    bool has_a = abs(a) <= threshold;
    bool has_b = abs(b) <= threshold;
    if (has_a && has_b) {
        return 0.5 * (a + b);
    }
    float smaller = abs(a) < abs(b) ? a : b;
    return has_a || has_b ? smaller : 0.0;
}

Surface surface_at(vec2 pixel, float front, float threshold) {
    Surface s;
    vec2 h = pixel / frame.thick_extent.w - 0.5;
    ivec2 base = ivec2(floor(h));
    vec2 f = h - vec2(base);
    ivec2 last = ivec2(frame.extent.zw) - 1;
    s.base = base;

    // 4x4 block around the four texels, corners left out.
    float z[16];
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            bool corner = (x == 0 || x == 3) && (y == 0 || y == 3);
            z[4 * y + x] = corner ? EMPTY : smoothed_at(base + ivec2(x - 1, y - 1));
        }
    }
    vec4 centre = vec4(z[5], z[6], z[9], z[10]);
    // Texels beyond the image's edge repeat it.
    if (base.x < 0) { centre.xz = centre.yw; }
    if (base.x >= last.x) { centre.yw = centre.xz; }
    if (base.y < 0) { centre.xy = centre.zw; }
    if (base.y >= last.y) { centre.zw = centre.xy; }

    vec4 bilinear = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    vec4 off = abs(centre - front);
    vec4 w = bilinear * vec4(lessThanEqual(off, vec4(threshold)));
    float sum = w.x + w.y + w.z + w.w;
    if (sum < 1.0e-4) {
        float least = min(min(off.x, off.y), min(off.z, off.w));
        w = off.x == least ? vec4(1, 0, 0, 0) : off.y == least ? vec4(0, 1, 0, 0)
          : off.z == least ? vec4(0, 0, 1, 0) : vec4(0, 0, 0, 1);
        sum = 1.0;
        if (least > threshold) {
            s.z = front;
            s.dz = vec2(0.0);
            s.weights = w;
            return s;
        }
    }
    w /= sum;
    s.weights = w;
    s.z = 0.0;
    s.dz = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        if (w[i] == 0.0) {
            continue;
        }
        ivec2 t = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), last) - base;
        int at = 4 * (t.y + 1) + t.x + 1;
        s.z += w[i] * z[at];
        s.dz += w[i] * vec2(difference(z[at - 1], z[at], z[at + 1], threshold),
                            difference(z[at - 4], z[at], z[at + 4], threshold));
    }
    return s;
}

// Eye-space position and normal (towards the eye).
void surface_frame(Surface s, vec2 slope, vec2 slope_step, out vec3 position, out vec3 normal) {
    position = vec3(slope, -1.0) * s.z;
    vec3 px = vec3(slope_step.x * s.z + slope.x * s.dz.x, slope.y * s.dz.x, -s.dz.x);
    vec3 py = vec3(slope.x * s.dz.y, slope_step.y * s.z + slope.y * s.dz.y, -s.dz.y);
    normal = normalize(cross(px, py));
    normal = dot(normal, position) > 0.0 ? -normal : normal;
}
