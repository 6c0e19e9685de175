#version 460
// Pass `spray` (thesis Sec. 4.9.5; several droplets per particle are new): a quad around each droplet, an ellipse
// that faces the camera, stretched along its projected motion. Droplets of a particle with neighbours fill the
// ellipsoid that pass `shape` has fitted to the neighbours. The first droplet of a particle is mist, the projection
// of that ellipsoid lengthened by its motion.
// Reads: sprites, inputs of sunlight.glsl. Writes: the quad's corners, its optical depth and visibility of the sun, and
// what the clumps in mist depend on.

#include "frame.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "convolution.glsl"
#include "density.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "axes.glsl"
#include "spray.glsl"
#include "gradient_noise.glsl"
#include "pattern.glsl"
#include "clumps.glsl"

layout(set = 0, binding = 1, std430) readonly buffer Sprites { SpraySprite sprites[]; };

layout(location = 0) flat out vec3 centre;
layout(location = 1) flat out vec3 along;  // divided by its half-axis
layout(location = 2) flat out vec3 across;
layout(location = 3) flat out vec3 normal;
// Optical depth at the centre; visibility of the sun; light of the glint, relative to sunlight, and the squared ratio of
// the droplet's radius to the glint's.
layout(location = 4) flat out vec4 amount;
layout(location = 5) flat out int aside;   // distance in pixels to water beside it
layout(location = 6) flat out uint chance; // random bits
layout(location = 7) flat out vec3 drift;  // velocity in the world
layout(location = 8) flat out vec4 source; // the particle's centre in the world; 1: clumps per pixel (mist)

// Salts of the random numbers.
const uint PLACE = 0x5370u;
// First counter of the random numbers that a particle has once.
const uint SPINDLE = 4096u;
// The droplets of a particle fill either a random spindle or the ellipsoid that is fitted to its neighbours. Up to
// the first sum of the ellipsoid's squared half-axes (3 for a ball) they fill the spindle, from the second on the
// ellipsoid, and in between a mix.
const float BALL = 3.0;
const float FLAT = 3.6;
// One droplet in this many glints: it mirrors the sun towards the eye.
const float GLINT_ONE_OF = 32.0;
// Radius of a glint relative to the droplet's, unless that is narrower than 1.4 pixels.
const float GLINT_RADIUS = 0.35;
// First counter of the random numbers that select glinting droplets.
const uint GLINT = 8192u;
// First counter of the random numbers by which droplets are left out in thin spray.
const uint KEPT = 12288u;
// Range of densities over which such a droplet fades.
const float FADE = 0.2;
// Size of the ellipsoid that the droplets of a particle fill: the square root of the sum of its squared half-axes,
// divided by the scatter radius (the radius of the ball that droplets fill otherwise).
const float STRAND = 0.7;
// An ellipse counts as a circle, without a longer half-axis, if the difference of its squared half-axes is less than
// this fraction of their sum.
const float ROUND = 1.0e-3;
// A spray particle's mist fades in between these two sums of its neighbours' weights, so that two or three particles
// alone are drops without mist.
const vec2 CROWD = vec2(1.0, 6.0);
// Number of octaves of the clumps at a droplet. Finer ones would only make single droplets differ.
const uint DROPLET_OCTAVES = 3u;
// Min half-axis of a droplet, and of a glint, in pixels.
const float LEAST = 0.7;
// Distance at which water is looked up, in drawn radii.
const float ASIDE = 1.5;

vec3 direction_of(uint id, uint number) {
    float level = 2.0 * uniform_of(PLACE, id, number) - 1.0;
    float turn = 6.2831853 * uniform_of(PLACE, id, number + 1u);
    float ring = sqrt(max(1.0 - level * level, 0.0));
    return vec3(ring * cos(turn), ring * sin(turn), level);
}

// Returns the half-axes, longer first, of the ellipse as which a particle's mist is projected on the plane with the
// axes `onto`: the covariances of its ellipsoid `shape` and of its `streak` (motion) are added. `longer` becomes the
// direction of the longer half-axis, and is left as it is for a circle.
vec2 mist_ellipse(mat3 shape, vec3 streak, mat2x3 onto, inout vec3 longer) {
    mat2x3 seen = frame.spray_cloud.y * (shape * transpose(mat3(frame.view)) * onto);
    vec2 along = streak * onto;
    float xx = dot(seen[0], seen[0]) + along.x * along.x;
    float yy = dot(seen[1], seen[1]) + along.y * along.y;
    float xy = dot(seen[0], seen[1]) + along.x * along.y;
    float middle = 0.5 * (xx + yy);
    float apart = length(vec2(0.5 * (xx - yy), xy));
    if (apart > ROUND * middle) {
        float angle = 0.5 * atan(2.0 * xy, xx - yy);
        longer = onto * vec2(cos(angle), sin(angle));
    }
    return sqrt(vec2(middle + apart, max(middle - apart, 0.0)));
}

void main() {
    uint droplets = uint(frame.density.w);
    SpraySprite sprite = sprites[gl_InstanceIndex / droplets];
    uint id = floatBitsToUint(sprite.velocity.w);
    uint droplet = gl_InstanceIndex % droplets;
    uint number = 5u * droplet;
    chance = chance_of(id, number);
    bool several = droplets > 1u;
    // The droplets of a particle are distributed uniformly in a ball. If there are several, the ball is squeezed to a
    // spindle of random direction and size, so that some particles look like a wide burst and others like one hardly
    // torn drop.
    vec3 off = direction_of(id, number);
    off *= frame.spray.z * pow(uniform_of(PLACE, id, number + 2u), 1.0 / 3.0);
    vec3 axis = direction_of(id, SPINDLE);
    float wide = (1.0 + 5.0 * uniform_of(PLACE, id, SPINDLE + 2u)) / 6.0;
    vec3 spindle = wide * (0.4 * off + 0.6 * dot(off, axis) * axis);
    // With neighbours, droplets lie in strands and thin layers between the particles.
    mat3 shape = unpack_axes(sprite.shape.xyz);
    float squares = axes_norm2(shape);
    vec3 strand = shape * off * (STRAND * inversesqrt(squares));
    off = several ? mix(spindle, strand, smoothstep(BALL, FLAT, squares)) : off;
    float share = sprite.centre.w;
    float torn = torn_of(share);
    float part = 0.2 + 0.8 * uniform_of(PLACE, id, SPINDLE + 3u);
    float kept = several ? 0.5 + torn * part * float(droplets) : 1.0;
    // Many droplets are small, few are large; the first one is mist.
    float rare = uniform_of(PLACE, id, number + 3u);
    rare *= rare * rare;
    float size = several ? (SMALLEST_DROPLET + DROPLET_RANGE * rare * rare) * inversesqrt(torn) : 1.0;
    bool mist = several && droplet == 0u;

    // In world space, so that it does not turn with the camera.
    float along_motion = 2.0 * uniform_of(PLACE, id, number + 4u) - 1.0;
    centre = sprite.centre.xyz + mat3(frame.view) * off + along_motion * frame.spray_cloud.z * sprite.velocity.xyz;
    normal = normalize(centre);
    vec3 motion = sprite.velocity.xyz;
    motion -= dot(motion, normal) * normal;
    float speed = length(motion);
    vec3 side = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    // Motion straight towards the eye leaves only rounding errors, which give no direction.
    float still_below = max(1.0e-6 * frame.particle.y, 1.0e-3 * length(sprite.velocity.xyz));
    vec3 level = normalize(cross(side, normal));
    vec3 e1 = speed > still_below ? motion / speed : level;
    vec3 e2 = cross(e1, normal);
    // A droplet that moves during the exposure becomes a streak. The streak covers a larger area than the droplet,
    // but each point for a shorter time, so its optical depth is that of the droplet divided by the ratio of the
    // areas. A sprite narrower than 1.4 pixels is widened to that, to avoid flicker; its optical depth is divided
    // likewise.
    float depth = -centre.z;
    float pixel = depth * max(abs(frame.slope.x), abs(frame.slope.y));
    float still = mist ? frame.spray_cloud.y : frame.spray.y * size;
    still = several && !mist ? min(still, frame.spray_near.x * depth) : still;
    vec2 axes = vec2(still + 0.5 * speed * frame.spray.w, still);
    vec3 upright = cross(level, normal);
    if (mist) {
        axes = mist_ellipse(shape, 0.5 * frame.spray.w * motion, mat2x3(level, upright), e1);
        e2 = cross(e1, normal);
    }
    axes = max(axes, vec2(LEAST * pixel));
    float crowd = smoothstep(CROWD.x, CROWD.y, uintBitsToFloat(sprite.shape.w));
    float thick = mist ? frame.spray_cloud.x * torn * torn * torn * crowd : frame.spray.x;
    amount.x = share * thick * still * still / (axes.x * axes.y);
    drift = mat3(frame.world) * sprite.velocity.xyz;
    bool clumpy = several && frame.spray_mist.x > 0.0;
    source = vec4((frame.world * vec4(sprite.centre.xyz, 1.0)).xyz, mist && clumpy ? 1.0 : 0.0);
    bool drawn = float(droplet) < kept;
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    for (bool go = drawn && !mist && clumpy; go; go = false) {
        vec3 point = (frame.world * vec4(centre, 1.0)).xyz;
        float density = clumps_at(point, source.xyz, drift, pixel, DROPLET_OCTAVES);
        // Where spray is thinner there are fewer droplets, and where it is denser they are more opaque. A droplet
        // fades as the density passes its random number.
        float own = uniform_of(PLACE, id, KEPT + droplet);
        amount.x *= max(density, 1.0) * clamp((density - own) / FADE + 0.5, 0.0, 1.0);
        drawn = amount.x > 0.0;
    }
    // Visibility of the sun from a droplet. The three colour channels are averaged to one value, because around spray
    // there is more white foam than coloured water.
    vec2 seen = (centre.xy / depth - frame.slope.zw) / frame.slope.xy;
    float direct = dot(sunlight(centre, seen), vec3(1.0 / 3.0));
    bool glints = several && !mist && GLINT_ONE_OF * uniform_of(PLACE, id, GLINT + droplet) < 1.0;
    amount.y = mix(direct, sqrt(sqrt(direct)), frame.spray_mist.z);
    float radius = clamp(LEAST * pixel / axes.y, GLINT_RADIUS, 1.0);
    amount.zw = vec2(glints ? frame.spray_cloud.w : 0.0, 1.0 / (radius * radius));
    aside = clamp(int(ASIDE * frame.particle.x / pixel + 0.5), 1, 64);
    along = e1 / axes.x;
    across = e2 / axes.y;

    vec2 corner = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
    // The quad is one pixel wider than the droplet's ellipse on each side, so that the snapping of vertices to the
    // rasteriser's grid does not cut the ellipse.
    vec3 at = centre + corner.x * e1 * (axes.x + pixel) + corner.y * e2 * (axes.y + pixel);
    bool whole = drawn && depth > 2.0 * (axes.x + pixel) && depth > frame.depth.z;
    vec2 place = (at.xy / -at.z - frame.slope.zw) / frame.slope.xy;
    // Moved off the screen if it comes too near.
    gl_Position = vec4(whole ? place / frame.extent.xy * 2.0 - 1.0 : vec2(-2.0), 0.5, 1.0);
}
