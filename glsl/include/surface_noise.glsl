// The baseline's surface noise (van der Laan, Green, Sainz, I3D 2009; thesis Sec. 2.5.3): definitions shared by its
// pass and by `composite`. Needs frame.glsl.

// Fixed-point steps per noise value of 1: floats hold multiples of 1/65536 exactly up to 256, so sums up to 256 are
// exact in any order.
const float NOISE_PARTS = 65536.0;

// Profile of a noise sprite (rho2: squared distance from its centre, 1 at its edge): a Gaussian that ends smoothly,
// also in its slope, which is used for shading.
float noise_kernel(float rho2) {
    float left = max(1.0 - rho2, 0.0);
    return left * left * exp(-2.0 * rho2);
}

// The full-resolution pixel whose surface a texel of the noise lies on.
ivec2 noise_pixel(ivec2 texel) {
    vec2 middle = (vec2(texel) + 0.5) * frame.noise_image.z;
    return min(ivec2(middle), ivec2(frame.extent.xy) - 1);
}
