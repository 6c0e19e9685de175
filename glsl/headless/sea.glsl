// The sea of pass `scene`: a level sheet of water or lava, found by the pixel's ray alone, so that no depth knows of it.
// Its normal is of a sum of sines, each of which loses what the pixel's footprint cannot show; what is lost widens the
// sun's glint and the mirror image (Cox and Munk 1954; Bruneton et al. 2010 for the mean of Fresnel's law).
// Light is absorbed and scattered along the ray as it goes on when bent, but what is seen lies where the ray goes on
// straight; patterns alone waver with the waves. The sun's light gathers on the floor by how the waves bend a bundle of
// it. Only the environment is mirrored.
// Needs scene.glsl, noise.glsl, light.glsl. Reads: the scene's block, environment, irradiance.

const uint WATER = 1;
const uint LAVA = 2;

layout(constant_id = 3) const uint SEA = 0;

const float REFRACTION = 1.333;
const float MIRRORED = 0.02037; // reflectance at normal incidence
const float WHITEWATER = 1.2;      // mean path of skylight per metre of depth under water

// Whether the eye is above the sea; from below it is not drawn.
bool over_sea() {
    return SEA != 0u && scene.eye.y > scene.sea.x;
}

// Intersection of the pixel's ray with a level plane, and its change per pixel across and down.
struct Place {
    vec2 at;
    vec2 across;
    vec2 down;
};

vec3 pixel_ray() {
    vec2 ndc = gl_FragCoord.xy * vec2(scene.ray_x.w, scene.ray_y.w) - 1.0;
    return scene.ray_z.xyz + ndc.x * scene.ray_x.xyz + ndc.y * scene.ray_y.xyz;
}

// The ray must go down.
Place place_at(vec3 ray, float height) {
    float along = (height - scene.eye.y) / ray.y;
    vec2 slant = ray.xz / ray.y;
    vec3 x = along * scene.ray_x.w * scene.ray_x.xyz;
    vec3 y = along * scene.ray_y.w * scene.ray_y.xyz;
    return Place(scene.eye.xz + along * ray.xz, x.xz - x.y * slant, y.xz - y.y * slant);
}

// Amplitude of a wave after filtering with a Gaussian of `deviation` pixels.
float shown(vec2 wave, Place place, float deviation) {
    float x = dot(wave, place.across);
    float y = dot(wave, place.down);
    return exp(-0.5 * deviation * deviation * (x * x + y * y));
}

// A sum of few sines looks like a lattice. Slow sines, each displaced by those before, shift the phase of
// each wave differently, which makes patches of rough and of smooth water.
vec3 unrest(vec2 at) {
    vec2 q = at / scene.sea.y;
    vec2 way = vec2(0.94, 0.34);
    vec2 sum = vec2(0.0);
    float number = 0.5;
    float height = 1.5;
    for (int i = 0; i < 4; ++i) {
        vec2 across = vec2(-way.y, way.x);
        sum += height * sin(number * vec2(dot(q, way), dot(q, across)) + 0.9 * sum.yx + vec2(1.3, 4.1) * float(i));
        way = vec2(-0.42 * way.x - 0.91 * way.y, 0.91 * way.x - 0.42 * way.y);
        number *= 2.3;
        height *= 0.62;
    }
    float gust = sin(0.23 * q.x + 0.11 * q.y + 0.5 * sum.x) + sin(0.19 * q.y - 0.13 * q.x + 0.5 * sum.y);
    return vec3(sum, 1.0 + 0.3 * gust);
}

// Phase of a wave at a point.
float phase(int i, vec2 at, vec3 unrest) {
    vec4 wave = scene.waves[i];
    float turn = 2.1 * float(i);
    // Short waves are shifted as much relative to their length.
    float more = 1.0 + 0.5 * float(i);
    return dot(wave.xy, at) + wave.w + more * (unrest.x * cos(turn) + unrest.y * sin(turn));
}

// The surface at a pixel: its ray and the intersection; the filtered slope; and the variance of the slopes
// too fine for the pixel: along x, along z, both.
struct Surf {
    vec3 ray;
    Place place;
    vec2 slope;
    vec3 hidden;
};

Surf surf() {
    Surf s;
    s.ray = pixel_ray();
    s.ray.y = min(s.ray.y, -1.0e-7);
    s.place = place_at(s.ray, scene.sea.x);
    s.slope = vec2(0.0);
    s.hidden = vec3(0.0);
    if (SEA == WATER) {
        vec3 unrest = unrest(s.place.at);
        // Waves shorter than the footprint's short axis are not visible.
        vec3 square = vec3(dot(s.place.across, s.place.across), dot(s.place.down, s.place.down), dot(s.place.across, s.place.down));
        float least = max(0.5 * (square.x + square.y) - length(vec2(0.5 * (square.x - square.y), square.z)), 0.0);
        for (int i = 0; i < WAVES; ++i) {
            vec4 wave = scene.waves[i];
            if (dot(wave.xy, wave.xy) * least > 30.0) {
                s.hidden.xy += 0.5 * max(scene.absorption.w - s.hidden.x - s.hidden.y, 0.0);
                break;
            }
            float kept = shown(wave.xy, s.place, 0.7);
            vec2 rise = wave.xy * wave.z * mix(1.0, unrest.z, min(0.25 * float(i), 1.0));
            s.slope += rise * kept * cos(phase(i, s.place.at, unrest));
            s.hidden += 0.5 * (1.0 - kept * kept) * vec3(rise * rise, rise.x * rise.y);
        }
    }
    return s;
}

// Sideways displacement by the waves of what lies `depth` under water. Patterns move with it; edges do not.
vec3 wobble(Surf s, float depth) {
    vec2 aside = (1.0 - 1.0 / REFRACTION) * depth * s.slope;
    return vec3(aside.x, 0.0, aside.y);
}

// Transmittance of hazy air over a distance. Over the sea mostly molecules scatter, by the wavelength to the power of -4,
// so blue light is lost first.
vec3 clear_air(float distant) {
    vec3 rate = SEA == WATER ? vec3(0.60, 0.90, 2.1) : vec3(1.0);
    return exp(-distant * scene.air.x * rate);
}

// Droplets low over the sea make a bright band above the horizon. `up`: the sine of the height.
vec3 with_band(vec3 sky, float up) {
    vec3 bright = scene.sun_color.rgb * vec3(0.124, 0.144, 0.170);
    return mix(sky, max(bright, sky), min(scene.air.z, 1.0) * 0.8 * exp(-max(up, 0.0) / 0.07));
}

float fresnel(float cosine) {
    return MIRRORED + (1.0 - MIRRORED) * pow(1.0 - cosine, 5.0);
}

// Mean of the Fresnel reflectance over slopes with a variance.
float rough_fresnel(float cosine, float variance) {
    float deviation = sqrt(variance);
    return MIRRORED
        + (1.0 - MIRRORED) * pow(1.0 - cosine, 5.0 * exp(-2.69 * deviation)) / (1.0 + 22.7 * deviation * sqrt(deviation));
}

vec3 extinction() {
    return scene.absorption.rgb + scene.scattering.rgb;
}

// Caustics: brightness by how the waves converge a bundle of the sun's rays; mean about 1.
float caustics(vec3 at, float depth) {
    vec3 ray = pixel_ray();
    if (ray.y >= 0.0) {
        return 1.0;
    }
    Place place = place_at(ray, at.y);
    // Where the sunlight that arrives here passed the surface.
    place.at = at.xz + depth * scene.sea.w / REFRACTION * scene.sun_direction.xz;
    float bent = depth * (1.0 - 1.0 / REFRACTION);
    vec3 unrest = unrest(place.at);
    vec3 bend = vec3(0.0);
    float variance = 0.0;
    for (int i = 0; i < WAVES; ++i) {
        vec4 wave = scene.waves[i];
        float square = dot(wave.xy, wave.xy);
        // The sun's disc, and being far beyond the focus, blur the caustics.
        float focus = bent * wave.z * square;
        float blurred = exp(-4.0e-6 * depth * depth * square) / (1.0 + 28.0 * focus * focus);
        // The shortest waves are faded out: the last few would look like a lattice.
        blurred *= 1.0 - smoothstep(0.4, 1.0, float(i) / float(WAVES));
        float kept = shown(wave.xy, place, 1.2) * blurred;
        float part = bent * wave.z * kept * unrest.z;
        bend -= part * sin(phase(i, place.at, unrest)) * vec3(wave.xy * wave.xy, wave.x * wave.y);
        variance += 0.5 * part * part * square * square;
    }
    float area = abs((1.0 + bend.x) * (1.0 + bend.y) - bend.z * bend.z);
    return (1.0 + 0.35 * variance) / (area + 0.35 * variance);
}

// Fractions of sunlight and of skylight that arrive at a depth under water.
vec3 sun_under(vec3 at, float depth) {
    float entering = 1.0 - fresnel(max(scene.sun_direction.y, 0.0));
    return entering * exp(-extinction() * depth * scene.sea.w) * caustics(at, depth);
}

vec3 sky_under(float depth) {
    return exp(-extinction() * depth * WHITEWATER);
}

// Reflected environment, from above the horizon.
vec3 mirror(vec3 n, vec3 v, float variance) {
    // Of the slopes too fine for the pixel, those towards the eye are more visible.
    float lean = variance / max(v.y, 2.0 * sqrt(variance) + 1.0e-4);
    n = normalize(n + lean * normalize(vec3(v.x, 1.0e-4, v.z)));
    vec3 r = reflect(-v, n);
    r.y = abs(r.y);
    float size = float(textureSize(environment, 0).x);
    float lod = clamp(log2(1.3 * sqrt(variance) * size), 0.0, log2(size) - 3.0);
    return with_band(textureLod(environment, r, lod).rgb, r.y);
}

// The sun's reflection in facets of all slopes (Cox and Munk 1954).
vec3 glint(vec2 slope, vec3 hidden, vec3 v) {
    vec3 l = scene.sun_direction.xyz;
    vec3 h = normalize(v + l);
    if (l.y <= 0.0 || h.y <= 0.0) {
        return vec3(0.0);
    }
    // The width of the disc, and ripples too small for the sum.
    vec2 variance = hidden.xy + 4.0e-6 + 0.01 * scene.absorption.w;
    vec2 off = -h.xz / h.y - slope;
    float determinant = variance.x * variance.y - hidden.z * hidden.z;
    float square = (variance.y * off.x * off.x + variance.x * off.y * off.y - 2.0 * hidden.z * off.x * off.y) / determinant;
    float density = exp(-0.5 * square) / (2.0 * PI * sqrt(determinant));
    // From a low eye, facets hide each other.
    float seen = v.y + 0.6 * sqrt(variance.x + variance.y);
    float h2 = h.y * h.y;
    return scene.sun_color.rgb * fresnel(max(dot(v, h), 0.0)) * density / (4.0 * h2 * h2 * seen);
}

// Water over a surface `depth` below its own.
vec3 water(vec3 under, float depth, Surf s) {
    vec3 v = -normalize(s.ray);
    vec3 n = normalize(vec3(-s.slope.x, 1.0, -s.slope.y));
    float variance = s.hidden.x + s.hidden.y;
    // Cosine of the refracted ray, under a level surface.
    float down = sqrt(1.0 - (1.0 - v.y * v.y) / (REFRACTION * REFRACTION));
    float path = depth / down;
    vec3 lost = extinction();
    vec3 up_light = sky_irradiance(vec3(0.0, 1.0, 0.0));
    float sun_cosine = max(scene.sun_direction.y, 0.0);
    vec3 entering = up_light + scene.sun_color.rgb * sun_cosine * (1.0 - fresnel(sun_cosine));
    // Light that goes down and is scattered equally in all directions.
    vec3 rate = lost * (1.0 + down * scene.sea.w);
    vec3 sum = (1.0 - exp(-rate * path)) / max(rate, 1.0e-9);
    vec3 c = under * exp(-lost * path) + scene.scattering.rgb * entering * scene.sea.w / (4.0 * PI) * sum;
    float f = rough_fresnel(clamp(dot(n, v), 0.0, 1.0), variance);
    return (1.0 - f) * c + f * mirror(n, v, variance) + glint(s.slope, s.hidden, v);
}

// Centre of a plate: one per cell.
vec2 plate_middle(ivec2 cell) {
    return 0.15 + 0.7 * vec2(hash(ivec3(cell, 41)), hash(ivec3(cell, 43)));
}

// Distance to the border with the next plate, in cells, and a random number of the plate.
vec2 plate(vec2 p) {
    ivec2 cell = ivec2(floor(p));
    vec2 f = fract(p);
    float nearest = 9.0;
    ivec2 own = ivec2(0);
    vec2 to_own = vec2(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 step = ivec2(i % 3, i / 3) - 1;
        vec2 to = vec2(step) + plate_middle(cell + step) - f;
        float square = dot(to, to);
        if (square < nearest) {
            nearest = square;
            own = step;
            to_own = to;
        }
    }
    float border = 9.0;
    for (int i = 0; i < 25; ++i) {
        ivec2 step = own + ivec2(i % 5, i / 5) - 2;
        vec2 to = vec2(step) + plate_middle(cell + step) - f;
        vec2 apart = to - to_own;
        if (dot(apart, apart) > 1.0e-5) {
            border = min(border, dot(0.5 * (to + to_own), normalize(apart)));
        }
    }
    return vec2(border, hash(ivec3(cell + own, 47)));
}

// Temperature of lava, 0 to 1, and brightness of its crust.
vec2 lava_heat(vec2 at, float drift, float width) {
    vec2 towards = scene.flow.xy;
    vec2 q = vec2(dot(at, towards) - drift, dot(at, vec2(-towards.y, towards.x))) / scene.sea.y;
    width /= scene.sea.y;
    // Stretched along the flow.
    vec3 large = vec3(0.35 * q.x, 0.8 * q.y, 3.0);
    vec2 warp = vec2(octaves(vec3(q, 5.0), 0.7, 3, width), octaves(vec3(q, 11.0), 0.7, 3, width));
    float streaks = octaves(large + vec3(0.5 * warp, 0.0), 0.8, 4, width);
    vec2 first = plate(vec2(0.75 * q.x, q.y) + 0.9 * warp);
    vec2 second = plate(2.9 * (vec2(0.8 * q.x, q.y) + 0.9 * warp) + 7.0);
    float open = smoothstep(-0.15, 0.55, streaks);
    float wide = mix(0.035, 0.4, open * open);
    float crack = 1.0 - smoothstep(0.0, wide + 1.5 * width, first.x);
    float fine = (1.0 - smoothstep(0.0, 0.10 + 3.0 * width, second.x)) * (0.25 + 0.5 * open);
    float grain = octaves(vec3(q, 23.0), 6.0, 3, width);
    float heat = max(crack * (0.72 + 0.25 * open), fine) + 0.20 * open + 0.10 * (first.y - 0.5) + 0.18 * grain;
    float crust = 1.0 + 0.7 * grain + 0.5 * (second.y - 0.5);
    return vec2(clamp(heat, 0.0, 1.0), crust);
}

// Lava, opaque. `lit`: irradiance on it.
vec3 lava(Place place, vec3 lit) {
    float width = 1.2 * sqrt(length(place.across) * length(place.down));
    vec2 heat = lava_heat(place.at, scene.flow.z, width);
    if (scene.lava.w > 0.0) {
        // Two copies of the flow are cross-faded, so that the end of the loop equals its beginning.
        vec2 other = lava_heat(place.at, scene.flow.w, width);
        heat = mix(heat, other, scene.scattering.w);
    }
    // Red begins to glow at the lowest temperature.
    vec3 glow = scene.lava.rgb * pow(vec3(heat.x), vec3(1.8, 3.0, 5.0));
    return glow + 0.035 * max(heat.y, 0.1) * (1.0 - heat.x) * lit / PI;
}

// The sea over what lies `depth` below its level. `lit`: irradiance on it, used for lava.
vec3 sea_over(vec3 under, float depth, vec3 lit, Surf s) {
    vec3 c = SEA == WATER ? water(under, depth, s) : lava(s.place, lit);
    // Far away the sea fades into the sky at the horizon: through hazy air as all does, in clear air earlier than the
    // ground, because it has less detail.
    vec3 horizon = textureLod(environment, normalize(vec3(s.ray.x, 0.02 * length(s.ray.xz), s.ray.z)), 2.0).rgb;
    float distant = distance(s.place.at, scene.eye.xz);
    float away = distant / scene.ground.w;
    float faded = max(1.0 - exp(-7.0 * away * away / (0.1 + away)), smoothstep(0.2, 1.0, away));
    horizon = with_band(horizon, 0.0);
    vec3 veil = scene.air.x > 0.0 ? 1.0 - clear_air(distant) : vec3(faded);
    return mix(c, horizon, veil);
}

// Irradiance from lava on what stands over it: an estimate from height and slope alone, as if lava were below
// everywhere.
vec3 lava_glow(float height, vec3 n) {
    vec3 mean = scene.lava.rgb * vec3(0.60, 0.26, 0.06);
    return PI * mean * (0.5 - 0.42 * n.y) * exp(-max(height, 0.0) / scene.sea.y);
}
