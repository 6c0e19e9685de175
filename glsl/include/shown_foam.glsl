// The foam that a pixel shows, of pass `surface_foam`. Needs frame.glsl, surface_foam_texels.glsl. Reads: foam depth
// and thickness, scene depth.

// 1: there may be foam; otherwise it is not read.
layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 4) uniform sampler2D foam_depth;
layout(set = 0, binding = 6) uniform sampler2D scene_depth;
layout(set = 0, binding = 9) uniform sampler2D foam_thickness;

// For motion vectors: eye depth of the frontmost foam at a pixel, or EMPTY where the foam's opacity along the view axis,
// without lace and aeration, is less than a half. There the motion is that of the surface behind the foam.
float shown_foam(vec2 pixel) {
    if (FOAM == 0u) {
        return EMPTY;
    }
    // Whether the scene hides the foam is tested as in `composite`.
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    FoamTexels texels = foam_texels(foam_depth, pixel, scene);
    float t = 0.0;
    for (int i = 0; i < 4; ++i) {
        t += texels.weights[i] * texelFetch(foam_thickness, foam_texel(texels, i), 0).x;
    }
    bool hides = frame.foam.x * t * smoothstep(0.0, frame.foam_noise.w, t) >= 0.69314718;
    return hides ? texels.depth : EMPTY;
}
