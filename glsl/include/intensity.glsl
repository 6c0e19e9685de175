// Light that foam of a thickness t scatters, 0 to 1 (Akinci et al. 2013, Sec. 2.3): t^e / (half + t^e), computed as 1
// / (1 + half / t^e) with logarithms, because t^e of thick foam can overflow. Needs frame.glsl.
float intensity_of(float thickness) {
    float power = frame.whitewater_light.x - frame.whitewater_light.y * log2(max(thickness, 1.0e-30));
    return thickness > 0.0 ? 1.0 / (1.0 + exp2(min(power, 126.0))) : 0.0;
}
