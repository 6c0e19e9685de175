// Shared by the steps that compute the map of distances to the shore (jump flooding, Rong, Tan 2006). A seed is a
// point of the shore line: its position in 16ths of a texel, 16 bits per axis; NONE if unknown.

const uint NONE = 0xffffffffu;

layout(push_constant, std430) uniform Push {
    ivec4 window; // first texel and size of the part that is computed anew
    int size;     // texels on each axis
    int jump;
    float texel;  // its edge in scene units
    float level;  // of the water
    vec4 part;    // of the host's height image: first texel, size
} push;

vec2 place_of(uint seed) {
    return vec2(seed & 0xffffu, seed >> 16) / 16.0;
}

// The invocation's texel in the window.
bool texel_of(uvec2 id, out ivec2 texel) {
    texel = push.window.xy + ivec2(id);
    return all(lessThan(ivec2(id), push.window.zw));
}
