// The scene under water, as dark as the water makes it (Lekner and Dorf 1988, "Why some things are darker when wet", with
// the light that water takes; not in the thesis).
// Needs frame.glsl, medium.glsl, and of shade.glsl a sheet and its ladder. Reads: nothing.

// Colour of what lies under a sheet, of its colour without. Of the light on the surface comes in 1 - F; a part (1 - F)/n^2
// of what is diffuse goes out again, the rest is thrown back to the bed, whose reflectance A tells how much of that comes
// up once more: (1 - F)/n^2 / (1 - A (1 - (1 - F)/n^2)), 1 for white. Each eye's own 1 - F is in what it mirrors. On its
// way down light is lost over the sun's bent way and the mean one of an even sky's; up and down again inside over five
// times that, mostly totally reflected: both over sin^2, without losses. What it loses on its way to the eye is
// `over`'s.
vec3 under_water(Sheet sheet, vec3 dry) {
    vec3 extinction = frame.medium_b.rgb + (frame.medium_a.w > 0.5 ? vec3(0.0) : frame.medium_a.rgb);
    vec3 sky = exp(-extinction * (frame.bed.y * sheet.down));
    vec3 sun = exp(-extinction * (frame.bed.z * sheet.down));
    vec3 lit = (1.0 - frame.shade.rgb) * sheet.sun;
    // Pass `lit` took the sun's part already.
    vec3 came = frame.shade.rgb * sky + lit * sun * frame.bed_light.w;
    came /= max(frame.shade.rgb + (CAST == 1u ? lit * sun : lit), vec3(1.0e-9));
    vec3 albedo = clamp(dry * frame.bed_light.rgb, 0.0, 1.0);
    vec3 back = sky * sky * sky * sky * sky * (1.0 - frame.bed.x);
    vec3 wet = dry * came * frame.bed.x / (1.0 - albedo * back);
    return mix(dry, wet, frame.target.z >= BACK_WATER ? sheet.wet : 0.0);
}
