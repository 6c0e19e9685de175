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
