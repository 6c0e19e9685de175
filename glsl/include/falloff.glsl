// The falloff that shapes whitewater particles (Akinci et al. 2013, Eq. 1): 1 up to 0, 0 from b on.
float falloff(float x, float b, float n, float m) {
    float part = clamp(x / b, 0.0, 1.0);
    // pow() of 0 is NaN with some drivers. Near 0, a small exponent gives a value far from 0.
    float rest = part > 0.0 ? 1.0 - pow(part, n) : 1.0;
    return rest > 0.0 ? pow(rest, m) : 0.0;
}
