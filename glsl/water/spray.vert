#version 460
// Pass `spray` (thesis Sec. 4.9.5; several droplets per particle are new): a quad around each droplet, an ellipse that
// faces the camera, stretched along its projected motion.
// Reads: sprites, what sunlight.glsl reads. Writes: the quad's corners, its optical depth and visibility of the sun, and
// the scale of the noise in mist.

#include "frame.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "spray.glsl"

layout(set = 0, binding = 1, std430) readonly buffer Sprites { SpraySprite sprites[]; };

layout(location = 0) flat out vec3 centre;
layout(location = 1) flat out vec3 along;  // divided by its half-axis
layout(location = 2) flat out vec3 across;
layout(location = 3) flat out vec3 normal;
layout(location = 4) flat out vec2 amount; // optical depth at its centre; visibility of the sun
layout(location = 5) flat out int aside;   // distance in pixels to water beside it
layout(location = 6) flat out uint chance; // random bits
layout(location = 7) flat out vec3 grain;  // cells of the mist's noise per half-axis; number of octaves
layout(location = 8) flat out vec2 turn;   // cosine and sine from the noise's axes to the half-axes

// Salts of the random numbers.
const uint PLACE = 0x5370u;
// Salt of the numbers that a particle has once.
const uint SPINDLE = 4096u;
// Fraction of the droplets of a particle that is entirely spray. Its fraction of mist is the cube.
const float LEAST_TORN = 0.3;
// Maximum number of octaves of the mist's noise.
const float OCTAVES = 5.0;
// Distance at which water is looked up, in drawn radii.
const float ASIDE = 1.5;

vec3 direction_of(uint id, uint number) {
    float level = 2.0 * uniform_of(PLACE, id, number) - 1.0;
    float turn = 6.2831853 * uniform_of(PLACE, id, number + 1u);
    float ring = sqrt(max(1.0 - level * level, 0.0));
    return vec3(ring * cos(turn), ring * sin(turn), level);
}

void main() {
    uint droplets = uint(frame.density.w);
    SpraySprite sprite = sprites[gl_InstanceIndex / droplets];
    uint id = floatBitsToUint(sprite.velocity.w);
    uint number = 5u * (gl_InstanceIndex % droplets);
    chance = chance_of(id, number);
    bool several = droplets > 1u;
    // Droplets are uniform in a ball. With several, the ball is a spindle in a random direction and of random
    // length: some are a burst, some hardly torn.
    vec3 off = direction_of(id, number);
    off *= frame.spray.z * pow(uniform_of(PLACE, id, number + 2u), 1.0 / 3.0);
    vec3 axis = direction_of(id, SPINDLE);
    float wide = (1.0 + 5.0 * uniform_of(PLACE, id, SPINDLE + 2u)) / 6.0;
    off = several ? wide * (0.4 * off + 0.6 * dot(off, axis) * axis) : off;
    // A particle that is entirely spray is a few large drops with little mist; water being torn is many fine ones.
    float share = sprite.centre.w;
    float torn = several ? clamp(4.0 * (1.0 - share), LEAST_TORN, 1.0) : 1.0;
    float part = 0.2 + 0.8 * uniform_of(PLACE, id, SPINDLE + 3u);
    float kept = several ? 0.5 + torn * part * float(droplets) : 1.0;
    // Many droplets are small, few are large; the first one is mist.
    float rare = uniform_of(PLACE, id, number + 3u);
    rare *= rare * rare;
    float size = several ? (0.2 + 2.135 * rare * rare) * inversesqrt(torn) : 1.0;
    bool mist = several && gl_InstanceIndex % droplets == 0u;

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
    // A streak covers more than the droplet, but each point for a shorter time. No narrower than 1.5 pixels,
    // to avoid flicker; then it is thinner in proportion.
    float depth = -centre.z;
    float pixel = depth * max(abs(frame.slope.x), abs(frame.slope.y));
    float still = mist ? frame.spray_cloud.y : frame.spray.y * size;
    vec2 axes = max(vec2(still + 0.5 * speed * frame.spray.w, still), vec2(0.7 * pixel));
    float thick = mist ? frame.spray_cloud.x * torn * torn * torn : frame.spray.x;
    amount.x = share * thick * still * still / (axes.x * axes.y);
    // One value for all colours: around it there is more foam than water.
    vec2 seen = (centre.xy / depth - frame.slope.zw) / frame.slope.xy;
    amount.y = dot(sunlight(centre, seen), vec3(1.0 / 3.0));
    aside = clamp(int(ASIDE * frame.particle.x / pixel + 0.5), 1, 64);
    // Cells are one drawn radius wide, and lengthened by the streak. The smallest octave is a pixel wide.
    vec2 cell = frame.particle.x + vec2(speed * frame.spray.w, 0.0);
    float octaves = frame.spray_mist.x > 0.0 ? clamp(log2(cell.y / pixel), 0.0, OCTAVES) : 0.0;
    grain = vec3(axes / cell, mist ? octaves : 0.0);
    // The noise is lengthened along the motion, and does not turn with it: that of a particle that hardly moves has any
    // direction, another one in each frame.
    turn = vec2(dot(e1, level), dot(e1, cross(level, normal)));
    along = e1 / axes.x;
    across = e2 / axes.y;

    vec2 corner = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
    // One pixel wider, so that snapping does not cut the footprint.
    vec3 at = centre + corner.x * e1 * (axes.x + pixel) + corner.y * e2 * (axes.y + pixel);
    bool drawn = float(gl_InstanceIndex % droplets) < kept;
    bool whole = drawn && depth > 2.0 * (axes.x + pixel) && depth > frame.depth.z;
    vec2 place = (at.xy / -at.z - frame.slope.zw) / frame.slope.xy;
    // Moved off the screen if it comes too near.
    gl_Position = vec4(whole ? place / frame.extent.xy * 2.0 - 1.0 : vec2(-2.0), 0.5, 1.0);
}
