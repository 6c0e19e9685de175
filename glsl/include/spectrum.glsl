// Wavelengths (nm) as linear Rec. 709: the CIE 1931 observer, approximated by sums of Gaussians (Wyman, Sloan,
// Shirley, Simple Analytic Approximations to the CIE XYZ Color Matching Functions, 2013). Needs nothing.

// First wavelength of the sum, number of wavelengths, and distance between them.
const float SPECTRUM_FIRST = 380.0;
const int SPECTRUM_COUNT = 81;
const float SPECTRUM_STEP = 5.0;

// A Gaussian with a different width on each side.
float spectrum_lobe(float wavelength, float middle, float below, float above) {
    float t = (wavelength - middle) * (wavelength < middle ? below : above);
    return exp(-0.5 * t * t);
}

// Colour of light of one wavelength, not normalized: to show light of equal energy at all wavelengths as white,
// divide sums by the sum of this colour over all wavelengths.
vec3 spectrum_color(float w) {
    float x = 0.362 * spectrum_lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * spectrum_lobe(w, 599.8, 0.0264, 0.0323)
        - 0.065 * spectrum_lobe(w, 501.1, 0.0490, 0.0382);
    float y = 0.821 * spectrum_lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * spectrum_lobe(w, 530.9, 0.0613, 0.0322);
    float z = 1.217 * spectrum_lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * spectrum_lobe(w, 459.0, 0.0385, 0.0725);
    return vec3(
        3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
}
