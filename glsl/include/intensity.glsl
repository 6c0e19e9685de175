// Light that foam of a thickness scatters, 0 to 1 (Akinci et al. 2013, Sec. 2.3). Needs frame.glsl.
float intensity_of(float thickness) {
    float power = thickness > 0.0 ? pow(thickness, frame.diffuse_light.y) : 0.0;
    return power / (frame.diffuse_light.x + power);
}
