#version 460
// Pass `film`: table of the reflectance of a soap film by the cosine of the angle of incidence and by thickness, once
// per renderer (Huszar, Szecsi, GPU-supported bubble and foam rendering, Sec. 3.1). It uses Airy's formula, or that of
// the paper (film.glsl), with the phase of the refracted ray. The paper's formula as printed has the angle outside the
// film, and the sine of the full phase instead of half of it, so that its maxima lie at half their thickness. The table
// is for three wavelengths, as in the paper, or for the whole spectrum.
// Reads: nothing. Writes: table (RGBA16F), x: cosine 0 to 1, y: thickness from 0.

#include "film.glsl"
#include "spectrum.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 0: three spectral lines, 1: the whole spectrum.
layout(constant_id = 0) const uint SPECTRAL = 1;
layout(constant_id = 1) const uint KIND = 0;

// Wavelengths for red, green and blue in nm.
const vec3 LINES = vec3(610.0, 550.0, 465.0);

layout(set = 0, binding = 0, rgba16f) uniform writeonly image2D table;
layout(push_constant, std430) uniform Push {
    float index; // of refraction
    float most;  // thickness of the last row in nm
} push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(table);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    vec2 at = vec2(texel) / vec2(size - 1);
    float thickness = at.y * push.most;
    vec3 color;
    if (SPECTRAL == 1u) {
        vec3 sum = vec3(0.0);
        vec3 all_light = vec3(0.0);
        for (int i = 0; i < SPECTRUM_COUNT; ++i) {
            float wavelength = SPECTRUM_FIRST + SPECTRUM_STEP * float(i);
            vec3 weight = spectrum_color(wavelength);
            sum += weight * film_reflectance(at.x, push.index, thickness, wavelength, KIND);
            all_light += weight;
        }
        // Colours outside Rec. 709 are clipped.
        color = clamp(sum / all_light, 0.0, 1.0);
    } else {
        for (int i = 0; i < 3; ++i) {
            color[i] = film_reflectance(at.x, push.index, thickness, LINES[i], KIND);
        }
    }
    imageStore(table, texel, vec4(color, 1.0));
}
