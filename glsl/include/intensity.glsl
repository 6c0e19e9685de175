// Share of light that foam of thickness t scatters (Akinci et al. 2013, Sec. 2.3): t^e / (h + t^e), with the
// constants e and h. It is computed as 1 / (1 + h / t^e) with logarithms, because t^e can overflow for thick foam.
// Needs frame.glsl.
float intensity_of(float thickness) {
    float power = frame.whitewater_light.x - frame.whitewater_light.y * log2(max(thickness, 1.0e-30));
    return thickness > 0.0 ? 1.0 / (1.0 + exp2(min(power, 126.0))) : 0.0;
}
