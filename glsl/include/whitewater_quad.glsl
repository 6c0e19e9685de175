// Where the ray of a pixel meets a whitewater particle, whose quad covers the pixel. Needs
// frame.glsl, falloff.glsl, whitewater.glsl, whitewater_words.glsl.
// Reads: words.

layout(set = 0, binding = 6, std430) readonly buffer Words { uint words[]; };

layout(location = 0) flat in vec4 sprite;
layout(location = 1) flat in vec4 footprint;
layout(location = 2) flat in vec2 parts;

struct Met {
    Whitewater p;
    Footprint f;
    uint at;     // words of the pixel
    vec2 place;  // position in the disc
    float w;     // distance before the centre plane, in radii
    float rr;    // squared distance from the centre
    float depth;
};

// Discards fragments that are not visible.
Met meet() {
    Met m;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    m.p.centre = vec3(0.0, 0.0, -sprite.x);
    m.p.radius = sprite.y;
    m.p.life = sprite.z;
    m.p.kind = uint(sprite.w);
    m.f.middle = footprint.xy;
    m.f.scale = footprint.zw;
    m.f.own = parts.x;
    m.f.even = parts.y;
    m.rr = whitewater_place(m.f, pixel, m.place);
    m.w = sqrt(max(1.0 - m.rr, 0.0));
    m.depth = sprite.x - m.w * sprite.y;
    m.at = words_of(pixel);
    if (!(m.rr < 1.0) || !(floatBitsToUint(m.depth) < words[m.at + SCENE])) {
        discard;
    }
    return m;
}
