// The sea of pass `scene`: a level sheet of water or lava. The pixel's ray is intersected with the
// sheet's plane; the sea is not in the depth image.
// The normal of water comes from a sum of sines. Waves that are too short for the pixel's footprint
// are filtered out; the variance of their slopes widens the sun's glint and blurs the reflection.
// Slopes are normally distributed (Cox and Munk 1954) and weighted by the visible area of their
// facets (Ross, Dion and Potvin 2005). The mean visible slope has a closed form and gives the
// direction of the reflection. The mean Fresnel reflectance is the fit of Bruneton, Neyret and
// Holzschuch (2010). Gusts make short waves higher in patches.
// Light is attenuated and scattered along the refracted ray. What lies under water is looked up
// along the straight ray; the waves displace only its patterns. Caustics are brighter where the
// waves converge a bundle of the sun's rays.
// Of the surroundings only environment, clouds, band of haze and sun are reflected.
// Needs scene.glsl, noise.glsl, light.glsl. Reads: the scene's block, environment, irradiance.

const uint WATER = 1;
const uint LAVA = 2;

layout(constant_id = 3) const uint SEA = 0;

const float REFRACTION = 1.333;
const float MIRRORED = 0.02037; // reflectance at normal incidence
const float FINER = 0.2;           // variance of slopes: ripples too short for the sum of waves, relative to the sum
const float CLOUDED = 0.256;       // mean opacity of the clouds of sky.frag
const float SKY_PATH = 1.2;        // mean path of skylight per unit of depth under water

// Whether the eye is above the sea. From below the sea is not drawn.
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

// A sum of few sines looks like a lattice. Therefore slow sines, each displaced by the ones before it, shift the
// phase of each wave by another amount.
vec2 unrest(vec2 at) {
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
    return sum;
}

// Factor by which gusts make short waves steeper or flatter, in patches of one to a hundred lengths
// of the largest wave.
// `width`: width of the footprint, in lengths of the largest wave.
float gusts(vec2 at, float width) {
    vec2 q = at / scene.sea.y;
    vec2 towards = scene.flow.xy;
    // The patches are elongated along the wind.
    q = vec2(0.55 * dot(q, towards), dot(q, vec2(-towards.y, towards.x)));
    float sum = 0.0;
    float frequency = 0.008;
    float height = 0.9;
    for (int i = 0; i < 6; ++i) {
        float share = kept(width, frequency);
        if (share <= 0.0) {
            break;
        }
        sum += height * share * noise(q * frequency + float(i) * 17.3, 61);
        frequency *= 2.6;
        height *= 0.8;
    }
    return exp2(clamp(sum, -1.6, 1.1));
}

// Phase of a wave at a point.
float phase(int i, vec2 at, vec2 unrest) {
    vec4 wave = scene.waves[i];
    return dot(wave.xy, at) + wave.w + dot(scene.shifts[i].xy, unrest);
}

// The sea's surface at a pixel: its ray and the intersection; the filtered slope; and of the slopes too fine for the
// pixel the variance along x, along z, and their covariance.
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
        vec2 unrest = unrest(s.place.at);
        vec3 square = vec3(dot(s.place.across, s.place.across), dot(s.place.down, s.place.down), dot(s.place.across, s.place.down));
        float least = max(0.5 * (square.x + square.y) - length(vec2(0.5 * (square.x - square.y), square.z)), 0.0);
        float most = square.x + square.y - least;
        float gust = gusts(s.place.at, 1.2 * sqrt(sqrt(least * most)) / scene.sea.y);
        // Ripples too short for the sum.
        s.hidden.xy += 0.5 * FINER * scene.absorption.w * gust * gust;
        for (int i = 0; i < WAVES; ++i) {
            vec4 wave = scene.waves[i];
            // Waves shorter than the footprint's short axis are not visible.
            if (dot(wave.xy, wave.xy) * least > 30.0) {
                s.hidden.xy += 0.5 * scene.shifts[i].z * gust * gust;
                break;
            }
            float kept = shown(wave.xy, s.place, 0.7);
            vec2 rise = wave.xy * wave.z * mix(1.0, gust, min(0.2 * float(i), 1.0));
            s.slope += rise * kept * cos(phase(i, s.place.at, unrest));
            s.hidden += 0.5 * (1.0 - kept * kept) * vec3(rise * rise, rise.x * rise.y);
        }
    }
    return s;
}

// Apparent sideways displacement, by refraction at the waves, of what lies `depth` under water. Patterns move with
// it; edges do not.
vec3 wobble(Surf s, float depth) {
    vec2 aside = (1.0 - 1.0 / REFRACTION) * depth * s.slope;
    return vec3(aside.x, 0.0, aside.y);
}

// Transmittance of hazy air over a distance. Over a sea of water blue light is lost first: the rates are proportional
// to the wavelength to the power of about -1.5, between those of salt and smoke (-1.3, atmosphere.glsl) and of air
// (-4). Elsewhere all colours are lost alike.
vec3 clear_air(float distant) {
    // `mix` instead of a conditional: if a specialization constant chooses between vectors, lavapipe
    // 22.3 selects only the first component.
    vec3 rate = mix(vec3(1.0), vec3(0.80, 1.0, 1.39), SEA == WATER ? 1.0 : 0.0);
    return exp(-distant * scene.air.x * rate);
}

// Droplets low over the sea make a bright band above the horizon. `up`: the sine of the angle above the horizon.
vec3 with_band(vec3 sky, float up) {
    vec3 bright = scene.sun_color.rgb * vec3(0.124, 0.144, 0.170);
    return mix(sky, max(bright, sky), min(scene.air.z, 1.0) * 0.8 * exp(-max(up, 0.0) / 0.07));
}

// Air over the sea is cleaner, and bluer than over land.
vec3 over_the_sea(vec3 sky, float up) {
    return sky * mix(vec3(1.0), vec3(0.68, 0.95, 1.30), scene.air.z * smoothstep(0.0, 0.2, up));
}

// Thin clouds before the sky; `thick` is their opacity.
vec3 with_clouds(vec3 sky, float up, float thick) {
    vec3 lit = scene.sun_color.rgb * vec3(0.172, 0.185, 0.205);
    return mix(sky, max(lit, sky), scene.air.z * 0.75 * thick * smoothstep(0.0, 0.05, up));
}

float fresnel(float cosine) {
    return MIRRORED + (1.0 - MIRRORED) * pow(max(1.0 - cosine, 0.0), 5.0);
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

// Caustics: brightness of the ground, by how the waves converge a bundle of the sun's rays; its mean is about 1.
float caustics(vec3 at, float depth) {
    vec3 ray = pixel_ray();
    if (ray.y >= 0.0) {
        return 1.0;
    }
    Place place = place_at(ray, at.y);
    // Where the sunlight that arrives here passed the surface.
    place.at = at.xz + depth * scene.sea.w / REFRACTION * scene.sun_direction.xz;
    float bent = depth * (1.0 - 1.0 / REFRACTION);
    vec2 unrest = unrest(place.at);
    float gust = gusts(place.at, sqrt(length(place.across) * length(place.down)) / scene.sea.y);
    vec3 bend = vec3(0.0);
    float variance = 0.0;
    for (int i = 0; i < WAVES; ++i) {
        vec4 wave = scene.waves[i];
        float square = dot(wave.xy, wave.xy);
        // The caustics of a wave are blurred by the width of the sun's disc, and on a bed that lies far beyond the
        // wave's focus.
        float focus = bent * wave.z * square;
        float blurred = exp(-4.0e-6 * depth * depth * square) / (1.0 + 28.0 * focus * focus);
        // The shortest waves are faded out: the last few would look like a lattice.
        blurred *= 1.0 - smoothstep(0.4, 1.0, float(i) / float(WAVES));
        float kept = shown(wave.xy, place, 1.2) * blurred;
        float part = bent * wave.z * kept * gust;
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
    return exp(-extinction() * depth * SKY_PATH);
}

// Slopes of the normals of the facets that are seen from a direction: in xy their mean minus the slope of the
// surface's normal n, in z the variance of slopes along the line of sight. The slope m of a facet's normal relative
// to the surface's is normally distributed with the covariance C. The facet is seen in proportion to max(t + m·e, 0),
// with t the tangent of the eye's height over the surface and e the level direction to the eye. The mean of m with
// this weight is
// C e / s · F(a) / (a F(a) + f(a)), with s² = e·C e, a = t / s, and F and f the standard normal distribution and its
// density.
vec3 seen_slope(vec3 hidden, vec3 n, vec3 v) {
    vec2 e = normalize(v.xz + vec2(1.0e-6, 0.0));
    vec2 spread = vec2(dot(hidden.xz, e), dot(hidden.zy, e));
    float variance = dot(spread, e);
    float s = sqrt(max(variance, 1.0e-12));
    float sine = clamp(dot(n, v), 0.0, 1.0);
    float a = min(sine / (sqrt(max(1.0 - sine * sine, 1.0e-6)) * s), 12.0);
    // Approximation of F by Page (1977).
    float below = 0.5 + 0.5 * tanh(0.79788 * (a + 0.044715 * a * a * a));
    float at = 0.39894 * exp(-0.5 * a * a);
    return vec3(spread / s * below / (a * below + at), variance);
}

// Reflected environment above the horizon, with clouds of mean opacity.
vec3 mirror(vec3 n, vec3 v, vec3 seen) {
    n = normalize(n / n.y + vec3(seen.x, 0.0, seen.y));
    vec3 r = reflect(-v, n);
    r.y = abs(r.y);
    float size = float(textureSize(environment, 0).x);
    float lod = clamp(log2(1.3 * sqrt(seen.z) * size), 0.0, log2(size) - 3.0);
    vec3 sky = over_the_sea(textureLod(environment, r, lod).rgb, r.y);
    return with_band(with_clouds(sky, r.y, CLOUDED), r.y);
}

// The sun's reflection in facets of all slopes (Cox and Munk 1954).
vec3 glint(vec2 slope, vec3 hidden, vec3 v) {
    vec3 l = scene.sun_direction.xyz;
    vec3 h = normalize(v + l);
    if (l.y <= 0.0 || h.y <= 0.0) {
        return vec3(0.0);
    }
    // The sun's disc has a width too.
    vec2 variance = hidden.xy + 4.0e-6;
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
    // A slope that falls away from the eye more steeply than the line of sight is hidden by the crest before it. So
    // the slope's component away from the eye is limited, smoothly.
    vec2 e = normalize(v.xz + vec2(1.0e-6, 0.0));
    float rises = v.y / max(length(v.xz), 1.0e-3);
    float open = rises - dot(s.slope, e);
    float least = 0.4 * rises;
    float seen_open = open > least ? open : least * exp(open / least - 1.0);
    vec2 slope = s.slope + e * (open - seen_open);
    vec3 n = normalize(vec3(-slope.x, 1.0, -slope.y));
    vec3 seen = seen_slope(s.hidden, n, v);
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
    float f = rough_fresnel(clamp(dot(n, v), 0.0, 1.0), seen.z);
    return (1.0 - f) * c + f * mirror(n, v, seen) + glint(s.slope, s.hidden, v);
}

// Centre of a plate: one per cell.
vec2 plate_middle(ivec2 cell) {
    return 0.15 + 0.7 * vec2(hash(ivec3(cell, 41)), hash(ivec3(cell, 43)));
}

// The crust of lava consists of plates. Returns the distance to the border with the next plate, in cells, and a
// random number of the plate.
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
        // In a picture sequence that loops, two copies of the flow of lava are cross-faded, so that the end of the
        // loop equals its beginning.
        vec2 other = lava_heat(place.at, scene.flow.w, width);
        heat = mix(heat, other, scene.scattering.w);
    }
    // Red begins to glow at the lowest temperature.
    vec3 glow = scene.lava.rgb * pow(vec3(heat.x), vec3(1.8, 3.0, 5.0));
    return glow + 0.035 * max(heat.y, 0.1) * (1.0 - heat.x) * lit / PI;
}

// Colour of the sea over what lies `depth` below its level. `lit`: irradiance on the sea, used for lava.
vec3 sea_over(vec3 under, float depth, vec3 lit, Surf s) {
    vec3 c = SEA == WATER ? water(under, depth, s) : lava(s.place, lit);
    // Far away the sea fades into the sky at the horizon: in hazy air as everything does, in clear air at a shorter
    // distance than the ground, because the sea has less detail.
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
