// The falloff that shapes whitewater particles (Akinci et al. 2013, Eq. 1): (1 - (x/b)^n)^m between 0 and b, 1 for x
// below 0, and 0 for x above b.
float falloff(float x, float b, float n, float m) {
    float part = clamp(x / b, 0.0, 1.0);
    // pow() of 0 is NaN with some drivers, so 0 is handled without pow(). Replacing 0 by a tiny number would not do:
    // with a small exponent pow() maps that number to a value far from 0.
    float rest = part > 0.0 ? 1.0 - pow(part, n) : 1.0;
    return rest > 0.0 ? pow(rest, m) : 0.0;
}
