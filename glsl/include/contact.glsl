// Contact foam: the more the nearer what is behind the surface lies (Lettier, Foam). Needs shore.glsl, and
// shoreline.glsl for the web. Reads: the host's mask.

layout(set = 0, binding = 30) uniform sampler2D contact_mask;

// How far the point behind is from the surface's, both of one ray; where it is none, far.
float contact_distance(vec3 ray, float z, float scene) {
    float far = scene > 0.0 ? scene - z : EMPTY;
    if (shore.contact.w == 0.0) {
        return far * length(ray);
    }
    return shore.contact.w == 1.0 ? far : far * -dot(shore.height.xyz, ray);
}

float eased(float x) {
    return x * x / (2.0 * (x * x - x) + 1.0);
}

// Of the pattern, at a place of the surface.
float masked(vec2 pixel, vec2 p, float width) {
    float pattern = 1.0;
    bool own = shore.contact_mask.w > 0.5;
    for (int i = own || shore.contact.z == 0.0 ? 0 : 1; i > 0; --i) {
        float scale = shore.contact_mask.x;
        pattern = web_at(p * scale + shore.contact_mask.yz, scale, width).x;
    }
    for (int i = own ? 1 : 0; i > 0; --i) {
        ivec2 texel = clamp(ivec2(pixel * shore.mask.xy), ivec2(0), ivec2(shore.mask.zw) - 1);
        pattern = texelFetch(contact_mask, texel + ivec2(shore.mask_part.xy), 0).x;
    }
    return mix(1.0, clamp(pattern, 0.0, 1.0), shore.contact.z);
}
