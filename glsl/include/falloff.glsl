// The falloff that shapes diffuse particles (Akinci et al. 2013, Eq. 1): 1 up to 0, 0 from b on.
float falloff(float x, float b, float n, float m) {
    // pow() of 0 is NaN on some drivers.
    float rest = 1.0 - pow(max(x / b, 1.0e-20), n);
    return x < b ? pow(max(rest, 1.0e-20), m) : 0.0;
}
