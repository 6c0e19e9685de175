// Colour of the scene where a marched ray meets it, as seen through the water that lies on the scene at that point.
// The march itself only knows the scene's depth, and would show the bed of a pool dry, several times brighter than
// under water. Not in the thesis. Simpler than a ray traced through this water: the water's surface is assumed to be
// level, and its refraction does not displace the ray.
// Needs frame.glsl, medium.glsl, sheets.glsl, level.glsl, march.glsl, and `Sheet`, FILLED, `air`, `fresnel`,
// `under_water` and `scene_at` of shade.glsl and its includes. Reads: depth, smoothed, thickness, sheets, boundaries,
// scene colour and depth, environment.

// at: pixels. along: direction of the ray, a unit vector in eye space.
vec3 met_scene(vec2 at, vec3 along) {
    vec3 dry = scene_at(at);
    ivec2 pixel = clamp(ivec2(at), ivec2(0), ivec2(frame.extent.xy) - 1);
    ivec2 texel = ivec2(vec2(pixel) / frame.thick_extent.z);
    // The water that may lie on the scene: all water of the pixel, or only the back layer where air separates it from
    // the front layer.
    float z = texelFetch(depth, pixel, 0).x;
    float t = texelFetch(thickness, texel, 0).x;
    float boundary = SHEETS == 2u ? boundary_of(texel) : EMPTY;
    for (bool covers = z < boundary && boundary < EMPTY; covers; covers = false) {
        vec3 parts = texelFetch(sheets, texel, 0).xyz;
        ivec4 rect = levels.level[BACK].rect;
        ivec2 there = min(ivec2(vec2(pixel) / levels.level[BACK].texel.z), rect.zw - 1);
        float apart = air(parts.z);
        z = mix(z, texelFetch(smoothed, rect.xy + there, 0).x, apart);
        t = parts.y + (1.0 - apart) * parts.x;
    }
    float room = met_depth(at) - z;
    float filled = t / max(room, 1.0e-6 * frame.particle.y);
    vec3 ray = vec3(ray_slope(at, frame.slope), -1.0);
    vec3 up = frame.up.xyz * mat3(frame.world);
    float wet = frame.bed.w > 0.0 && room > 0.0 && t > 0.0 ? smoothstep(FILLED.x, FILLED.y, filled) : 0.0;
    Sheet sheet = NO_SHEET;
    sheet.wet = 1.0;
    sheet.down = min(t, max(room, 0.0)) * max(-dot(ray, up), 0.0);
    sheet.sun = 1.0;
    sheet.thick = min(t, room);
    vec3 c = under_water(sheet, dry);
    // Up to the level surface along the refracted ray, and out.
    float facing = abs(dot(along, up));
    float inside = sqrt(1.0 - frame.up.w * frame.up.w * (1.0 - facing * facing));
    c = through_medium(c, sheet.down / inside, lit_on(up, up, 1.0)).rgb;
    vec3 mirrored = mat3(frame.world) * (along - 2.0 * min(dot(along, up), 0.0) * up);
    c = mix(c, textureLod(environment, mirrored, 0.0).rgb, fresnel(facing));
    return mix(dry, c, wet);
}
