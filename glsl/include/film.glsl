// Thin-film interference of a soap film in air: its reflectance (Airy). Needs nothing.

// How the reflectance of one face of the film is computed. EXACT: Fresnel's equations for both polarizations
// separately. SCHLICK: Schlick's approximation of their mean. SOURCE: 1 - cos, as in the paper.
const uint FRESNEL_EXACT = 0u;
const uint FRESNEL_SCHLICK = 1u;
const uint FRESNEL_SOURCE = 2u;

// Cosine inside the film, of refractive index n.
float film_refracted(float cosine, float n) {
    return sqrt(max(1.0 - (1.0 - cosine * cosine) / (n * n), 0.0));
}

// Reflectance of one face, for polarization perpendicular and parallel to the plane of incidence.
vec2 film_face(float cosine, float n, uint kind) {
    float inside = film_refracted(cosine, n);
    if (kind == FRESNEL_EXACT) {
        float across = (cosine - n * inside) / (cosine + n * inside);
        float along = (n * cosine - inside) / (n * cosine + inside);
        return vec2(across * across, along * along);
    }
    float out_of = 1.0 - cosine;
    if (kind == FRESNEL_SOURCE) {
        return vec2(out_of);
    }
    float normal = (n - 1.0) / (n + 1.0);
    float square = out_of * out_of;
    return vec2(mix(normal * normal, 1.0, square * square * out_of));
}

// sin^2 of half the phase difference between the light reflected by the two faces of a film. The sine is evaluated by
// its series within a quarter of a turn, because devices guarantee their own sine only to 2^-11.
float film_phase(float cosine, float n, float thickness, float wavelength) {
    float turns = 2.0 * n * thickness * film_refracted(cosine, n) / wavelength;
    float x = 3.14159265 * (turns - floor(turns + 0.5));
    float y = x * x;
    float sine = x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0
        + y * (1.0 / 362880.0 - y * (1.0 / 39916800.0))))));
    return sine * sine;
}

// Reflectance of the film for unpolarized light, at most 1. The paper's formula can exceed 1 and is clamped.
float film_reflectance(float cosine, float n, float thickness, float wavelength, uint kind) {
    float phase = film_phase(cosine, n, thickness, wavelength);
    vec2 face = film_face(cosine, n, kind);
    if (kind == FRESNEL_SOURCE) {
        return min(4.0 * face.x * phase, 1.0);
    }
    vec2 back = 4.0 * face * phase;
    vec2 through = 1.0 - face;
    // At grazing incidence both are 0.
    vec2 share = back / max(back + through * through, 1.0e-20);
    return 0.5 * (share.x + share.y);
}
