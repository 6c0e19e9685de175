// Light reflected by foam on the scene's water. Needs frame.glsl.

// Radiance of shoreline and contact foam in full sun. The values `..._lost` are the parts of it that are missing
// where no sunlight arrives.
struct CoatLight {
    vec4 shore;        // w: opacity
    vec3 shore_lost;
    vec3 contact;
    vec3 contact_lost;
};

CoatLight coat_light() {
    vec3 lost = 1.0 - frame.shade.rgb;
    vec3 shore = frame.shore_color.rgb;
    vec3 contact = frame.contact_color.rgb;
    return CoatLight(frame.shore_color, shore * lost, contact, contact * lost * frame.contact_color.w);
}
