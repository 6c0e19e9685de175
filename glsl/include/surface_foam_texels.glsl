// The texels of surface foam around a pixel. Foam has the lower resolution of the thickness images, but whether the
// scene hides it is tested per pixel, so the scene's outlines in front of foam are sharp. Needs frame.glsl.

struct FoamTexels {
    ivec4 at;     // the first and the last of the four texels
    vec4 weights; // bilinear, row by row; 0 where the scene hides the foam
    vec4 shown;   // the same, and 0 for texels without foam
    vec4 z;       // depth of the frontmost foam, EMPTY where none is visible
    float depth;  // the least of them
};

// The four texels of `foam_depth` around a pixel, with weights that are 0 where the scene hides the foam. `pixel` is
// a position in pixels (centres at +0.5), `scene` the eye depth of the scene there, 0 or less without a scene.
FoamTexels foam_texels(sampler2D foam_depth, vec2 pixel, float scene) {
    // Clamp to the frame: the image may be larger.
    vec2 h = clamp(pixel / frame.thick_extent.z - 0.5, vec2(0.0), frame.thick_extent.xy - 1.0);
    vec2 base = floor(h);
    vec2 f = h - base;
    FoamTexels foam;
    foam.at.xy = ivec2(base);
    foam.at.zw = min(foam.at.xy + 1, ivec2(frame.thick_extent.xy) - 1);
    foam.weights = vec4(1.0 - f.x, f.x, 1.0 - f.x, f.x) * vec4(1.0 - f.y, 1.0 - f.y, f.y, f.y);
    vec4 z = textureGather(foam_depth, (base + 1.0) / vec2(textureSize(foam_depth, 0))).wzxy;
    // Foam counts as hidden only if it is more than one particle spacing behind the scene: where foam lies on the
    // scene at a grazing angle, a texel covers pixels with nearer and with farther scene depths.
    float end = scene > 0.0 ? min(scene + frame.particle.y, EMPTY) : EMPTY;
    bvec4 seen = lessThan(mix(vec4(EMPTY), z, greaterThan(foam.weights, vec4(0.0))), vec4(end));
    foam.shown = mix(vec4(0.0), foam.weights, seen);
    // Texels with thickness but no depth (very little foam) keep their weight.
    foam.weights = mix(foam.shown, foam.weights, greaterThanEqual(z, vec4(EMPTY)));
    foam.z = mix(vec4(EMPTY), z, seen);
    foam.depth = min(min(foam.z.x, foam.z.y), min(foam.z.z, foam.z.w));
    return foam;
}

// The i-th of the four texels.
ivec2 foam_texel(FoamTexels foam, int i) {
    return ivec2((i & 1) == 0 ? foam.at.x : foam.at.z, (i & 2) == 0 ? foam.at.y : foam.at.w);
}
