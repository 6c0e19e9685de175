#version 460
// Pass `splat` by quads (Akinci et al. 2013, Sec. 2.1 and 2.2; passes 3 and 4): a quad around the pixels of each
// particle, whose edges lie between pixels. Reads: positions, kinds, radii, ages, ids, crossfade. Writes: the quad's
// corners, the particle's sprite and footprint.

#include "frame.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "crossfade.glsl"
#include "whitewater_push.glsl"
#include "whitewater_streams.glsl"

layout(location = 0) flat out vec4 sprite;    // depth of its centre, radius, life, kind
layout(location = 1) flat out vec4 footprint; // centre in pixels, 1 / half-axes
layout(location = 2) flat out vec2 parts;     // of the footprint: own, even

void main() {
    Whitewater p = whitewater_at(gl_InstanceIndex);
    Footprint f = footprint_of(p);
    sprite = vec4(-p.centre.z, p.radius, p.life, float(p.kind));
    footprint = vec4(f.middle, f.scale);
    parts = vec2(f.own, f.even);
    vec4 edges = vec4(max(f.box.xy, ivec2(0)), min(f.box.zw + 1, ivec2(frame.extent.xy)));
    bool drawn = p.life > 0.0 && all(lessThan(edges.xy, edges.zw));
    vec2 corner = vec2((gl_VertexIndex & 1) == 0 ? edges.x : edges.z, (gl_VertexIndex & 2) == 0 ? edges.y : edges.w);
    vec2 place = corner / frame.extent.xy * 2.0 - 1.0;
    gl_Position = drawn ? vec4(place, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
}
