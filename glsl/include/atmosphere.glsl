// A physically based clear sky: single scattering of sunlight in a Rayleigh and Mie atmosphere (Nishita et al. 1993;
// Rayleigh coefficient and layers of Bruneton and Neyret 2008), plus a term for light that scatters more than once.
// That term is fitted to a Monte Carlo solution over ground of albedo 0.2: the sky's irradiance on level ground
// differs from the solution by at most 6 % for suns above 30 degrees, and by 18 % in blue for a sun at 10 degrees.
// The sky is computed at the wavelengths 645, 553 and 443 nm, which give the colour of the spectral sky in Rec. 709
// within 4 %. The scattering coefficients are those at 550 nm, scaled with the wavelength to the power -4 (Rayleigh)
// and -1.3 (aerosol, Angstrom's exponent). The aerosol's optical depth to the zenith by scattering is 0.1 at 550 nm,
// that of a clear day; its single-scattering albedo is 0.9. Lengths are in kilometres.

const float EARTH = 6360.0;
const float TOP = 6420.0;
const vec3 RAYLEIGH = vec3(7.14e-3, 13.21e-3, 32.08e-3); // per km at sea level
const vec3 MIE = vec3(67.7e-3, 82.7e-3, 110.4e-3);
const vec3 MIE_ABSORPTION = 0.11 * MIE;
const float RAYLEIGH_HEIGHT = 8.0;
const float MIE_HEIGHT = 1.2;
const float MIE_ASYMMETRY = 0.76;

float leave_sphere(float height, float cosine, float radius) {
    float b = height * cosine;
    return -b + sqrt(max(b * b - height * height + radius * radius, 0.0));
}

// Density of air (x) and aerosol (y), relative to sea level, integrated in km from a point to the top of the
// atmosphere. `height` is the point's distance from the Earth's centre, `cosine` that of the angle between the
// direction and the zenith.
vec2 optical_depth(float height, float cosine) {
    const int steps = 12;
    float span = leave_sphere(height, cosine, TOP) / float(steps * steps);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < steps; ++i) {
        // Quadratic steps: the air is densest near the ground.
        float t = (float(i * i + i) + 0.5) * span;
        float h = sqrt(height * height + t * t + 2.0 * height * t * cosine) - EARTH;
        sum += exp(-max(h, 0.0) / vec2(RAYLEIGH_HEIGHT, MIE_HEIGHT)) * float(2 * i + 1) * span;
    }
    return sum;
}

vec3 transmittance(vec2 depth) {
    return exp(-(RAYLEIGH * depth.x + (MIE + MIE_ABSORPTION) * depth.y));
}

// Radiance of the sky (without the sun's disc) in a direction with y up, for a sun of unit irradiance. Below the
// horizon it is the radiance of ground that this sun and sky light.
vec3 sky_radiance(vec3 direction, vec3 sun) {
    const int steps = 24;
    float eye = EARTH + 0.05;
    // The horizon is the lowest direction that is integrated.
    float up = max(direction.y, 0.003);
    vec3 d = normalize(vec3(direction.x, up, direction.z));
    float span = leave_sphere(eye, d.y, TOP);
    vec2 along = vec2(0.0);
    vec3 rayleigh = vec3(0.0);
    vec3 mie = vec3(0.0);
    float before = 0.0;
    for (int i = 0; i < steps; ++i) {
        // Steps grow with distance: most of the air is near.
        float after = span * pow(float(i + 1) / float(steps), 2.0);
        float t = 0.5 * (before + after);
        float size = after - before;
        before = after;
        float r = sqrt(eye * eye + t * t + 2.0 * eye * t * d.y);
        vec2 density = exp(-max(r - EARTH, 0.0) / vec2(RAYLEIGH_HEIGHT, MIE_HEIGHT)) * size;
        float sun_cosine = (eye * sun.y + t * dot(d, sun)) / r;
        vec3 reach = transmittance(along + 0.5 * density + optical_depth(r, max(sun_cosine, -0.05)));
        along += density;
        rayleigh += density.x * reach;
        mie += density.y * reach;
    }
    float mu = dot(d, sun);
    float g = MIE_ASYMMETRY;
    float phase_r = 3.0 / (16.0 * 3.14159265) * (1.0 + mu * mu);
    float phase_m = 3.0 / (8.0 * 3.14159265) * (1.0 - g * g) * (1.0 + mu * mu)
                  / ((2.0 + g * g) * pow(1.0 + g * g - 2.0 * g * mu, 1.5));
    float height = max(sun.y, 0.0);
    float often = 0.072 * height / (height + 0.12);
    vec3 sky = rayleigh * RAYLEIGH * phase_r + mie * MIE * phase_m + often * (1.0 - exp(-RAYLEIGH * along.x));
    // Below the horizon: grey ground, lit by sun and sky, which replaces the sky gradually (a soft horizon).
    float below = 1.0 - smoothstep(-0.12, 0.0, direction.y);
    vec3 sky_light = vec3(0.15, 0.20, 0.29) * often / 0.072;
    vec3 ground = 0.22 / 3.14159265 * (height * transmittance(optical_depth(eye, sun.y)) + sky_light);
    return mix(sky, ground, below);
}
