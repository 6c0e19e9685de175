// Octahedral map of all directions to a square: the upper half in the middle, the lower one folded out to the corners
// (Meyer et al. 2010). A border of one texel repeats the texels across the edge, so that no seam appears and no
// driver needs to filter across faces.

vec2 octahedral_signs(vec2 p) {
    return mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
}

// Direction at a position of the octahedral square, -1 to 1 on each axis. A position slightly outside gives the
// direction that continues across the square's edge.
vec3 octahedral_direction(vec2 p) {
    p = abs(p.x) > 1.0 ? vec2(2.0 * octahedral_signs(p).x - p.x, -p.y) : p;
    p = abs(p.y) > 1.0 ? vec2(-p.x, 2.0 * octahedral_signs(p).y - p.y) : p;
    vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    d.xy = d.z < 0.0 ? (1.0 - abs(p.yx)) * octahedral_signs(p) : p;
    return normalize(d);
}

// Position of a direction of any length except 0.
vec2 octahedral_place(vec3 d) {
    vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    return d.z < 0.0 ? (1.0 - abs(p.yx)) * octahedral_signs(p) : p;
}

// Texture coordinates of a direction in an octahedral image of `texels` texels along its axes: 0 to 1 across the
// whole image, whose outermost texels are the border.
vec2 octahedral_texture_place(vec3 d, ivec2 texels) {
    vec2 at = (0.5 * octahedral_place(d) + 0.5) * (vec2(texels) - 2.0) + 1.0;
    return at / vec2(texels);
}
