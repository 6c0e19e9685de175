// One step of curvature flow at a pixel (thesis Sec. 2.5.3 and 4.7, Listing A.13). z is the eye depth. Differences
// from the thesis are described at each step. `precise` makes the raster and compute forms agree bit for bit. Needs
// nothing.

struct Stencil {
    float z;          // centre
    vec4 axis;        // left, right, up, down
    vec4 corner;      // left-up, right-up, left-down, right-down
};

struct Derivatives {
    float x, y, xx, yy, xy;
    bool has_xy;
};

// Central differences. Nothing is smoothed across silhouettes: if the depth of either neighbour on an axis differs
// from the centre's by more than `falloff`, the derivatives along this axis are 0.
Derivatives derivatives(Stencil s, float falloff, bool mixed) {
    Derivatives z;
    vec4 off = abs(s.axis - s.z);
    bool cut_x = max(off.x, off.y) > falloff;
    bool cut_y = max(off.z, off.w) > falloff;
    precise float x = 0.5 * (s.axis.y - s.axis.x);
    precise float xx = (s.axis.x - s.z) + (s.axis.y - s.z);
    precise float y = 0.5 * (s.axis.w - s.axis.z);
    precise float yy = (s.axis.z - s.z) + (s.axis.w - s.z);
    z.x = cut_x ? 0.0 : x;
    z.xx = cut_x ? 0.0 : xx;
    z.y = cut_y ? 0.0 : y;
    z.yy = cut_y ? 0.0 : yy;
    z.xy = 0.0;
    z.has_xy = false;
    if (mixed) {
        vec4 far = abs(s.corner - s.z);
        bool cut = cut_x || cut_y || max(max(far.x, far.y), max(far.z, far.w)) > falloff;
        precise float xy = 0.25 * ((s.corner.w - s.corner.z) - (s.corner.y - s.corner.x));
        z.xy = xy;
        z.has_xy = !cut;
    }
    return z;
}

// The thesis' step (Sec. 2.5.3, Eqs. 2.10-2.16 with their misprints corrected; van der Laan et al. 2009; without the
// mixed derivative, as in Listing A.13): returns z - epsilon 2H, where H is the mean curvature. c = (C_x, C_y) is the
// world size of a pixel at depth 1.
float source_step(Stencil s, vec2 c, float falloff, float epsilon) {
    Derivatives z = derivatives(s, falloff, false);
    precise float cx2 = c.x * c.x;
    precise float cy2 = c.y * c.y;
    precise float cc = cx2 * cy2;
    precise float d = cy2 * z.x * z.x + cx2 * z.y * z.y + cc * s.z * s.z;
    // Half of D_x and D_y.
    precise float dx = cy2 * z.x * z.xx + cc * s.z * z.x;
    precise float dy = cx2 * z.y * z.yy + cc * s.z * z.y;
    precise float ex = z.x * dx - z.xx * d;
    precise float ey = z.y * dy - z.yy * d;
    precise float moved = s.z - epsilon * (c.y * ex + c.x * ey) / (d * sqrt(d));
    return moved;
}

// A step of mean curvature flow of the surface P = (slope, -1) z, where `slope` is that of the pixel's ray (xy /
// depth). It uses the surface's two fundamental forms, so the width over which the surface is smoothed does not
// depend on distance, slant or position in the image. (The thesis' D omits the ray's slope, so it is correct only on
// the optical axis, and planes drift away.) `g` is the signed change of the ray's slope per pixel, `kappa` the
// diffusion in square pixels for a surface that faces the eye.
float flow_step(Stencil s, vec2 slope, vec2 g, float falloff, float kappa) {
    Derivatives z = derivatives(s, falloff, true);
    precise float ww = 1.0 + slope.x * slope.x + slope.y * slope.y;
    precise float gx = g.x * s.z;
    precise float gy = g.y * s.z;
    precise float e = ww * z.x * z.x + gx * (2.0 * slope.x * z.x + gx);
    precise float f = ww * z.x * z.y + gx * slope.x * z.y + gy * slope.y * z.x;
    precise float h = ww * z.y * z.y + gy * (2.0 * slope.y * z.y + gy);
    precise float bend = 2.0 / s.z;
    precise float l = z.xx - bend * z.x * z.x;
    // If z_xy is unknown (at silhouettes), the whole mixed term m is 0: its other half alone would bend a plane.
    precise float mixed = z.xy - bend * z.x * z.y;
    precise float m = z.has_xy ? mixed : 0.0;
    precise float n = z.yy - bend * z.y * z.y;
    // Determinant e h - f f of the first fundamental form, as the squared length of the normal: a sum of squares,
    // which cannot cancel to 0.
    precise float nx = gy * z.x;
    precise float ny = gx * z.y;
    precise float nz = gx * gy + gx * slope.y * z.y + gy * slope.x * z.x;
    precise float area = nx * nx + ny * ny + nz * nz;
    precise float moved = s.z + kappa * gx * gx * (h * l - 2.0 * f * m + e * n) / area;
    return moved;
}
