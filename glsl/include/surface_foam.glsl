// Sprite of a particle's surface foam (thesis Sec. 4.6.2 and 4.8): an ellipse along the particle's motion. It changes
// to a disc facing the camera if the particle is slow or moves along the view. Needs frame.glsl.

struct FoamSprite {
    vec4 centre;   // eye-space position; foam, 0 to 1
    vec4 velocity; // eye-space velocity; age in seconds
    vec4 rest;     // x: bits of the particle's id; y: visibility of the sun; zw: 0
    vec4 pattern;  // w: logarithm of the pattern's factor at the centre; xyz: its gradient per scene unit, eye space
};

// Sprites per workgroup of the compute path.
const uint FOAM_GROUP = 64u;
// Half-axis of a foam sprite across the motion, in drawn radii (2 to 3 in the thesis). In the pass for the depth of
// foam it shrinks as the particle's foam ends. In the pass for the thickness it does not, because there the sprite
// fades softly towards its edge, and a smaller half-axis would cut it off.
const float FOAM_AXIS = 2.0;
// Min half-axis of a foam sprite in texels of the thickness: narrower sprites would flicker between texel centres.
// Widened sprites are thinner in proportion.
const float LEAST_FOAM_AXIS = 1.5;
// Noise cells per half-axis.
const float NOISE_CELLS = 1.6;
// Min value of n . centre / z, by which a sprite's thickness is divided. It is the cosine between the sprite's normal
// and the view ray, times the ray's length per depth. At 0 the sprite is seen edge-on, and would be infinitely thick.
const float LEAST_FACING = 0.2;

// Unit vectors along and across the motion; returns the stretch, 0 to 1.
float foam_axes(FoamSprite sprite, out vec3 along, out vec3 across) {
    vec3 v = normalize(sprite.centre.xyz);
    float speed = length(sprite.velocity.xyz);
    vec3 direction = sprite.velocity.xyz / max(speed, 1.0e-20);
    across = cross(direction, v);
    float turned = length(across);
    if (speed <= 1.0e-6 * frame.particle.y || turned < 1.0e-3) {
        across = cross(v, vec3(0.0, 1.0, 0.0));
        across = dot(across, across) < 1.0e-6 ? cross(v, vec3(1.0, 0.0, 0.0)) : across;
        across = normalize(across);
        along = cross(across, v);
        return 0.0;
    }
    across /= turned;
    vec3 facing = cross(across, v);
    facing = dot(facing, direction) < 0.0 ? -facing : facing;
    float stretch = smoothstep(0.0, frame.foam.z, speed / frame.particle.y)
                  * (1.0 - smoothstep(0.9, 1.0, abs(dot(v, direction))));
    along = normalize(mix(facing, direction, stretch));
    return stretch;
}
