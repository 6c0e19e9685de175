// Contact foam: the closer the scene is behind the water's surface, the more foam (Lettier, Foam). Needs shore.glsl,
// and shoreline.glsl for the web (the foam's texture). Reads: the host's mask.

layout(set = 0, binding = 30) uniform sampler2D contact_mask;

// Distance between the points at which a ray meets the water's surface and the scene. `shore.contact.w` chooses the
// measure: 0 along the ray, 1 along the view axis, 2 vertical. The distance is large if there is no scene, and with
// the vertical measure also if the ray does not go down, because then the scene is not below the surface.
float contact_distance(vec3 ray, float z, float scene) {
    float far = scene > 0.0 ? scene - z : EMPTY;
    if (shore.contact.w == 0.0) {
        return far * length(ray);
    }
    float down = -dot(shore.height.xyz, ray);
    return shore.contact.w == 1.0 ? far : down > 0.0 ? far * down : EMPTY;
}

float eased(float x) {
    return x * x / (2.0 * (x * x - x) + 1.0);
}

// The pattern that modulates contact foam, at point `p` of the water's surface. x: its value, 0 to 1. yz: the change
// of this value per pixel to the right and down.
vec3 pattern_at(vec2 pixel, vec2 p, mat2 across) {
    float scale = shore.contact_mask.x;
    float level = level_of(sqrt(abs(determinant(across))) * scale * shore.web.z);
    vec4 web = web_at(p * scale + shore.contact_mask.yz, level);
    vec3 pattern = vec3(web.x, web.zw * (scale * across));
    if (GENERAL == 1u) {
        ivec2 texel = clamp(ivec2(pixel * shore.mask.xy), ivec2(0), ivec2(shore.mask.zw) - 1);
        float host = texelFetch(contact_mask, texel + ivec2(shore.mask_part.xy), 0).x;
        pattern = shore.contact_mask.w > 0.5 ? vec3(host, 0.0, 0.0) : pattern;
    }
    return pattern;
}

// Coverage of contact foam. `far` is the distance from the surface to the scene, divided by the distance at which the
// foam ends.
float contact_foam(float far, float pattern) {
    return eased((1.0 - clamp(far, 0.0, 1.0)) * mix(1.0, clamp(pattern, 0.0, 1.0), shore.contact.z));
}
