// Sources of light of pass `scene`: the sky's irradiance and the environment, both without the sun. Needs nothing.
// Reads: environment, irradiance.

layout(set = 0, binding = 2) uniform samplerCube environment;
layout(set = 0, binding = 3, std430) readonly buffer Irradiance { vec4 irradiance[9]; };

vec3 sky_irradiance(vec3 n) {
    vec3 e = 0.282095 * irradiance[0].rgb
           + 0.488603 * (irradiance[1].rgb * n.y + irradiance[2].rgb * n.z + irradiance[3].rgb * n.x)
           + 1.092548 * (irradiance[4].rgb * n.x * n.y + irradiance[5].rgb * n.y * n.z + irradiance[7].rgb * n.x * n.z)
           + 0.315392 * irradiance[6].rgb * (3.0 * n.z * n.z - 1.0)
           + 0.546274 * irradiance[8].rgb * (n.x * n.x - n.y * n.y);
    return max(e, 0.0);
}
