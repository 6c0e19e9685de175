// Sprite of a particle's surface foam (thesis Sec. 4.6.2 and 4.8): an ellipse along its motion, which changes to a
// disc facing the camera where it is slow or moves along the view. Needs frame.glsl.

struct FoamSprite {
    vec4 centre;   // eye space; foam, 0 to 1
    vec4 velocity; // eye space; age in seconds
    vec4 rest;     // bits of the id; share of the sun's light
    vec4 pattern;  // w: logarithm of how much more there is of it in its middle; xyz: how that grows a metre
};

// Sprites to a workgroup of the compute path.
const uint FOAM_GROUP = 64u;
// Half-axis across the motion in drawn radii. That of the depth shrinks with the last of the foam; else
// it is the thickness', which ends softly: a narrower one cuts it off (the source has 2 to 3).
const float FOAM_AXIS = 2.0;
// Least half-axis of the thickness in texels: a narrower one would come and go between their middles. As it
// is wider it is thinner.
const float LEAST_FOAM_AXIS = 1.5;
// Cells of the noise to a half-axis.
const float NOISE_CELLS = 1.6;
// Least that a sprite counts as turned towards the eye: seen from its edge it would be endless.
const float LEAST_FACING = 0.2;

// Unit vectors along the motion and across it; how far it is stretched, 0 to 1.
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
