// Direction of a texel of a cube image (Vulkan's face order +x -x +y -y +z -z). Needs nothing.
vec3 cube_direction(ivec3 texel, int size) {
    vec2 uv = (vec2(texel.xy) + 0.5) / float(size) * 2.0 - 1.0;
    vec3 d = texel.z == 0 ? vec3(1.0, -uv.y, -uv.x)
           : texel.z == 1 ? vec3(-1.0, -uv.y, uv.x)
           : texel.z == 2 ? vec3(uv.x, 1.0, uv.y)
           : texel.z == 3 ? vec3(uv.x, -1.0, -uv.y)
           : texel.z == 4 ? vec3(uv.x, -uv.y, 1.0)
                          : vec3(-uv.x, -uv.y, -1.0);
    return normalize(d);
}

// Position of a direction (any length except 0) on a cube: across and down its face, 0 to 1, and the face.
vec3 cube_place(vec3 d) {
    vec3 a = abs(d);
    vec3 p; // across, down, along the face's axis
    float face;
    if (a.x >= a.y && a.x >= a.z) {
        face = d.x >= 0.0 ? 0.0 : 1.0;
        p = vec3(d.x >= 0.0 ? -d.z : d.z, -d.y, a.x);
    } else if (a.y >= a.z) {
        face = d.y >= 0.0 ? 2.0 : 3.0;
        p = vec3(d.x, d.y >= 0.0 ? d.z : -d.z, a.y);
    } else {
        face = d.z >= 0.0 ? 4.0 : 5.0;
        p = vec3(d.z >= 0.0 ? d.x : -d.x, -d.y, a.z);
    }
    return vec3(p.xy / p.z * 0.5 + 0.5, face);
}

// The texel of a direction.
ivec3 cube_texel(vec3 d, int size) {
    vec3 place = cube_place(d);
    return ivec3(clamp(ivec2(place.xy * float(size)), ivec2(0), ivec2(size - 1)), int(place.z));
}

// Components of a world direction in axes with y up: x along `east`, y along `up`, z along their cross product.
vec3 standing(vec3 direction, vec3 east, vec3 up) {
    return vec3(dot(direction, east), dot(direction, up), dot(direction, cross(east, up)));
}
