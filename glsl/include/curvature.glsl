// One step of curvature flow at a pixel (thesis Sec. 2.5.3, Eqs. 2.10-2.16 with their misprints
// mended; van der Laan et al. 2009). z is the eye depth, c = (C_x, C_y) of this image.
// `precise`: raster and compute forms must agree bit for bit.

struct Stencil {
    float z;          // centre
    vec4 axis;        // left, right, up, down
    vec4 corner;      // left-up, right-up, left-down, right-down
};

// No smoothing across silhouettes: an axis with a one-sided difference over the falloff has no
// derivatives at all.
bool cut(float a, float b, float z, float falloff) {
    return abs(a - z) > falloff || abs(b - z) > falloff;
}

// (C_y E_x + C_x E_y) and D.
vec2 curvature_terms(Stencil s, vec2 c, float falloff, bool mixed) {
    precise float zx = 0.5 * (s.axis.y - s.axis.x);
    precise float zxx = s.axis.x - 2.0 * s.z + s.axis.y;
    precise float zy = 0.5 * (s.axis.w - s.axis.z);
    precise float zyy = s.axis.z - 2.0 * s.z + s.axis.w;
    bool cut_x = cut(s.axis.x, s.axis.y, s.z, falloff);
    bool cut_y = cut(s.axis.z, s.axis.w, s.z, falloff);
    if (cut_x) {
        zx = 0.0;
        zxx = 0.0;
    }
    if (cut_y) {
        zy = 0.0;
        zyy = 0.0;
    }
    precise float zxy = 0.0;
    if (mixed) {
        vec4 off = abs(s.corner - s.z);
        bool corner_cut = max(max(off.x, off.y), max(off.z, off.w)) > falloff;
        if (!(cut_x || cut_y || corner_cut)) {
            zxy = 0.25 * ((s.corner.w - s.corner.z) - (s.corner.y - s.corner.x));
        }
    }
    precise float cx2 = c.x * c.x;
    precise float cy2 = c.y * c.y;
    precise float cc = cx2 * cy2;
    precise float d = cy2 * zx * zx + cx2 * zy * zy + cc * s.z * s.z;
    // Half of D_x and D_y.
    precise float dx = cy2 * zx * zxx + cx2 * zy * zxy + cc * s.z * zx;
    precise float dy = cy2 * zx * zxy + cx2 * zy * zyy + cc * s.z * zy;
    precise float ex = zx * dx - zxx * d;
    precise float ey = zy * dy - zyy * d;
    precise float sum = c.y * ex + c.x * ey;
    return vec2(sum, d);
}

// The new depth. `step` is kappa (ConstantWidth) or epsilon (the source's rules).
float curvature_step(Stencil s, vec2 c, float falloff, uint rule, float step) {
    bool constant_width = rule == RULE_CONSTANT_WIDTH;
    vec2 terms = curvature_terms(s, c, falloff, constant_width);
    precise float divisor = constant_width ? terms.y * c.y : terms.y * sqrt(terms.y);
    precise float moved = s.z - step * terms.x / divisor;
    return moved;
}
