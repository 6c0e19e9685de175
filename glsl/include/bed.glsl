// Darkening of the scene under water (Lekner and Dorf 1988, "Why some things are darker when wet", with the water's
// absorption; not in the thesis).
// Needs frame.glsl, medium.glsl, `Sheet` of shade.glsl and CAST of sunlight.glsl. Reads: nothing.

// Thickness of water, in particle spacings, from which on it starts to darken the bed (the scene's surface beneath),
// and from which on it darkens the bed fully. The particles of a thinner film lie apart, and full darkening would
// show each one as a dark disc.
const vec2 FILM = vec2(0.5, 2.0);

// Colour of the scene under a sheet (layer) of water, from its dry colour. The water's surface, of mean reflectance
// F, lets 1 - F of the incoming light in. Of the light that the bed scatters, the share q = (1 - F)/n^2 leaves the
// water, and the surface reflects the rest back to the bed. The bed scatters the part A (its albedo) of the rest
// again, and so on. In total the bed's colour is multiplied by q/(1 - A (1 - q)), which is 1 for a white bed (A = 1).
// Reflection of the view ray is not included here: it is part of the sheet's own reflection. Sunlight is absorbed
// along its refracted path down, skylight along the mean path of an even sky. Light that goes up and down between two
// scatterings at the bed is mostly totally reflected, so its path is flat: it counts as five mean paths of skylight.
// `over` applies the absorption on the way from the bed to the eye.
vec3 under_water(Sheet sheet, vec3 dry) {
    vec3 extinction = frame.medium_b.rgb + (frame.medium_a.w > 0.5 ? vec3(0.0) : frame.medium_a.rgb);
    vec3 sky = exp(-extinction * (frame.bed.y * sheet.down));
    vec3 sun = exp(-extinction * (frame.bed.z * sheet.down));
    vec3 lit = (1.0 - frame.shade.rgb) * sheet.sun;
    // Pass `lit` has already applied the sun's part.
    vec3 came = frame.shade.rgb * sky + lit * sun * frame.bed_light.w;
    came /= max(frame.shade.rgb + (CAST == 1u ? lit * sun : lit), vec3(1.0e-9));
    vec3 albedo = clamp(dry * frame.bed_light.rgb, 0.0, 1.0);
    vec3 back = sky * sky * sky * sky * sky * (1.0 - frame.bed.x);
    vec3 wet = dry * came * frame.bed.x / (1.0 - albedo * back);
    float film = smoothstep(FILM.x * frame.particle.y, FILM.y * frame.particle.y, sheet.thick);
    return mix(dry, wet, frame.target.z >= BACK_WATER ? sheet.wet * film : 0.0);
}
