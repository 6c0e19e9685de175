#version 460
// Pass `light`: distance in scene units along the sunlight, from the region's centre, at which the light first meets
// water, foam or spray. MIN blending keeps the nearest disc. Not in the thesis. Reads: the discs of front.vert. Writes:
// front (R32F).

#include "frame.glsl"

layout(location = 0) flat in vec2 centre;
layout(location = 1) flat in float depth;
layout(location = 2) flat in float axis;

layout(location = 0) out float front;

void main() {
    vec2 place = (gl_FragCoord.xy - centre) * (frame.light_map.y / axis);
    float rho2 = dot(place, place);
    if (rho2 > 1.0) {
        discard;
    }
    front = depth - min(axis, frame.particle.x) * sqrt(1.0 - rho2);
}
