// What the view ray meets after the water's front surface has refracted it (Wyman 2005, "An Approximate Image-Space
// Approach for Interactive Refraction"; not in the thesis). If the water touches the scene, the ray ends on the
// scene. If air follows behind the water, the far surface refracts the ray once more. Differs from Wyman: the far
// surface is the front surface moved back by the thickness, and its slope is the sum of the front surface's and the
// thickness' slopes; the scene behind is found by a screen-space march.
// Needs frame.glsl, sheets.glsl, surface.glsl, march.glsl, met_water.glsl, and `Sheet`, FLATTEST, `air`, `fresnel`,
// `spline_slope` and `spline_rise` of shade.glsl. Reads: thickness, sheets, boundaries, scene depth, environment,
// inputs of met_water.glsl.

// Weight of the light from the directions into which the far surface bends rays; the rest of the light comes straight
// through, because water in the air has ripples finer than its particles. With weight 1, every crown of a splash and
// every drop would have saturated blots.
const float BENT = 0.5;
// Factor on BENT (the weight of bent light) for light that the far surface reflects back into the sheet. Such a ray
// meets the water again, in a direction that is not known. With factor 1 the rims of sheets were ribbons in the colour
// of the zenith. With this one, water in front of a dark scene is darker than a path tracer's.
const float BENT_BACK = 0.3;
// Factor on BENT (the weight of bent light) for a sheet, a layer of water, in front of more water, because many bent
// rays hit the water behind instead of the sky.
const float BENT_BEFORE = 0.5;
// Angle by which a sheet in front of more water deflects a ray, divided by the slope of the sheet's thickness. For a
// prism this ratio is n - 1 = 0.33. It is smaller here because most of the slope is noise of the particles.
const float PRISM = 0.08;

// Light that enters the front sheet from behind.
struct Exit {
    float kept; // transmittance for the scene behind
    vec3 free;  // all other light
    vec3 scene;
    float path; // length through the sheet, scene units
};

// Slope of the thickness, per pixel.
vec2 thickness_slope(vec2 pixel) {
    vec2 h = pixel / frame.thick_extent.z - 0.5;
    vec2 middle = floor(h + 0.5);
    vec2 texel = 1.0 / vec2(textureSize(thickness, 0));
    vec4 before = textureGather(thickness, middle * texel, 0);
    vec4 right = textureGather(thickness, (middle + vec2(1.0, 0.0)) * texel, 0);
    vec4 below = textureGather(thickness, (middle + vec2(0.0, 1.0)) * texel, 0);
    vec4 after = textureGather(thickness, (middle + 1.0) * texel, 0);
    return spline_rise(middle, h - middle, before, right, below, after) / frame.thick_extent.z;
}

// Returns the slope per pixel of the thickness of the front sheet (layer of water); water behind it counts only where
// no air lies between. Texels in which the depth `front` is not in front of the boundary between the sheets show
// another surface; they get the mean thickness of the other texels.
vec2 sheet_slope(vec2 pixel, float front) {
    vec2 h = pixel / frame.thick_extent.z - 0.5;
    ivec2 middle = ivec2(floor(h + 0.5));
    mat3 own; // one column per row of texels
    mat3 other;
    float sum = 0.0;
    float count = 0.0;
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            ivec2 texel = clamp(middle + ivec2(x, y) - 1, ivec2(0), ivec2(frame.thick_extent.xy) - 1);
            vec3 t = texelFetch(sheets, texel, 0).xyz;
            other[y][x] = front < boundary_of(texel) ? 0.0 : 1.0;
            own[y][x] = (1.0 - other[y][x]) * (t.x + (1.0 - air(t.z)) * t.y);
            sum += own[y][x];
            count += 1.0 - other[y][x];
        }
    }
    own += other * (sum / max(count, 1.0));
    return spline_slope(h - vec2(middle), own[0], own[1], own[2]) / frame.thick_extent.z;
}

// Direction of the refracted view ray in the water, a unit vector.
vec3 into_water(Sheet sheet) {
    vec3 v = normalize(-sheet.at);
    float ratio = frame.up.w;
    // The normal of a ripple may point away from the eye.
    float facing = max(dot(sheet.normal, v), 0.0);
    return ratio * (sheet.normal * facing - v) - sheet.normal * sqrt(1.0 - ratio * ratio * (1.0 - facing * facing));
}

// Offset in pixels from a pixel to the point where its refracted ray meets the scene under the sheet. False position
// finds the ray's length, between a length at which the ray is still before the scene and one at which it is behind.
// (Fixed-point iteration would jump between floor and wall where these meet.) The first length tried reaches the
// depth of the scene straight behind the pixel. While no length behind the scene is known, each step at most doubles
// the length. Objects in front of the water are ignored.
const int BED_LOOKS = 5;
// Part of the interval between the two ray lengths: false position keeps each new length at least this far from both
// of them.
const float BED_ENDS = 0.1;
// Distance along z that a refracted ray crosses before it meets the scene, divided by the thickness of the water. Up
// to the first value the ray meets the scene under the water. From the second on it has left the water beside the
// scene that the water touches, such as beside the box from which a jet comes.
const vec2 BED_MISSED = vec2(2.0, 4.0);
// `touches` becomes the share of the ray that meets the scene under the water.
vec2 bed_offset(Sheet sheet, vec2 pixel, out float touches) {
    vec3 inside = into_water(sheet);
    float z = -sheet.at.z;
    float along = max(-inside.z, FLATTEST);
    // `before` and `beyond` each hold the length of the refracted ray, and by how much the scene at the ray's end is
    // deeper than this end.
    vec2 before = vec2(0.0, max(met_depth(pixel) - z, 0.0));
    vec2 beyond = vec2(-1.0);
    float far = before.y / along;
    for (int i = 0; i < BED_LOOKS; ++i) {
        vec3 end = sheet.at + inside * far;
        float scene = met_depth(clamp(on_screen(end).xy, vec2(0.5), frame.extent.xy - 0.5));
        vec2 here = vec2(far, scene + end.z);
        bool skipped = scene <= z;
        bool passed = here.y <= 0.0;
        before = skipped || passed ? before : here;
        beyond = skipped || !passed ? beyond : here;
        float open = min(far + before.y / along, 2.0 * far);
        float part = clamp(before.y / max(before.y - beyond.y, 1.0e-20), BED_ENDS, 1.0 - BED_ENDS);
        float next = beyond.x < 0.0 ? open : mix(before.x, beyond.x, part);
        far = skipped ? far : next;
    }
    float crossed = far * max(-inside.z, 0.0) / max(sheet.thick, frame.particle.y);
    touches = 1.0 - smoothstep(BED_MISSED.x, BED_MISSED.y, crossed);
    vec3 end = on_screen(sheet.at + inside * far);
    vec2 at = clamp(end.xy, vec2(0.5), frame.extent.xy - 0.5);
    bool plane = all(equal(at, end.xy)) && met_depth(at) > z;
    at = plane ? on_plane(on_screen(sheet.at), end) : at;
    return clamp(at, vec2(0.5), frame.extent.xy - 0.5) - pixel;
}

// Returns the offset in pixels of the image of water at eye depth `beyond`, seen through a sheet (layer of water) at
// eye depth `front` as through a prism.
vec2 prism_offset(vec2 pixel, float front, float beyond) {
    vec2 slope = sheet_slope(pixel, front) / (frame.texel.xy * front);
    return PRISM * slope * max(beyond - front, 0.0) / (frame.texel.xy * max(beyond, front));
}

// Returns the light that enters the front sheet (layer of water) from behind. `surface`: the particles' front surface,
// which at a pane of glass is not that of the sheet. `behind`: the scene's colour as refracted by the front surface
// alone. `covers`: there is a second sheet behind this one. `pool`: how far the back sheet touches the scene, 0 to 1.
// With 1 the ray that leaves the front sheet shows `behind`, which includes the water of the back sheet, because a
// march would find the dry scene.
Exit exit_of(Sheet sheet, Surface surface, vec2 pixel, vec3 behind, bool covers, float pool) {
    float ratio = frame.up.w;
    vec3 inside = into_water(sheet);
    Exit result;
    result.path = sheet.thick / max(-inside.z, FLATTEST);
    vec3 from = sheet.at + inside * result.path;

    Surface far = surface;
    far.z = sheet.thick - sheet.at.z;
    vec2 steepest = frame.texel.xy * far.z * RIM_SLOPE;
    vec2 thicker = vec2(0.0);
    // Loops instead of branches, for CPU drivers (docs/performance.md).
    bool apart = SHEETS == 2u && covers;
    bool alone = !apart;
    while (apart) {
        thicker = sheet_slope(pixel, surface.z);
        apart = false;
    }
    while (alone) {
        thicker = thickness_slope(pixel);
        alone = false;
    }
    far.dz += thicker;
    far.dz = clamp(far.dz, -steepest, steepest);
    vec3 there;
    vec3 n;
    surface_frame(far, ray_slope(pixel, frame.slope), there, n);
    float inner = clamp(-dot(inside, n), 0.0, 1.0);
    float square = 1.0 - (1.0 - inner * inner) / (ratio * ratio);
    bool total = square <= 0.0;
    float outer = sqrt(max(square, 0.0));
    // `thrown`: share of the light that the far surface reflects back into the sheet. With Schlick's form it rises to
    // 1 at the angle beyond which total reflection leaves no refracted ray, so both cases meet without an edge.
    vec3 inward = normalize(inside + 2.0 * inner * n);
    float thrown = fresnel(outer);
    vec3 along = total ? inward : normalize(inside / ratio + n * (inner / ratio - outer));

    Met met = march(from, along, pool < 1.0 && !total ? int(EXIT) : 0);
    met.share *= 1.0 - pool;
    // If a ray leaves the sheet (layer of water) downwards and meets no scene on the screen, it counts as not
    // refracted.
    float bent = BENT * mix(1.0, BENT_BEFORE, pool);
    vec3 world = mat3(frame.world) * along;
    float sky = bent * (1.0 - met.share) * smoothstep(-0.3, 0.0, dot(world, frame.up.xyz));
    met.share *= bent;
    vec3 back = mat3(frame.world) * inward;
    float back_sky = BENT_BACK * bent * smoothstep(-0.3, 0.0, dot(back, frame.up.xyz));
    // `air` is the weight of the refraction at the far surface of the water. It is 0 for a thin film, whose two
    // surfaces are parallel, and for water that touches the scene and so has no air behind it.
    float air = (1.0 - sheet.wet) * smoothstep(0.0, frame.particle.x, sheet.thick);
    vec3 seen = (1.0 - met.share - sky) * behind;
    for (bool any = met.share > 0.0; any; any = false) {
        seen += met.share * met_scene(met.at, along);
    }
    result.free = air * ((1.0 - thrown) * sky * textureLod(environment, world, 0.0).rgb
                         + thrown * back_sky * textureLod(environment, back, 0.0).rgb);
    vec3 scene = mix(behind, (1.0 - thrown) * seen + thrown * (1.0 - back_sky) * behind, air);
    result.kept = mix(1.0, (1.0 - thrown) * (1.0 - sky) + thrown * (1.0 - back_sky), air);
    result.scene = result.kept > 0.0 ? scene / result.kept : behind;
    result.path = mix(sheet.path, result.path, air);
    return result;
}

// The light that enters the sheet, from the colour c behind it.
vec3 opened(Exit e, vec3 c) {
    return c * e.kept + e.free;
}
