// References: Blender's Environment Texture (the equirectangular map); rendering/scene/environment.py, which makes the texture.
// Summary: the world image in a direction.

vec3 environment_image_at(vec3 direction) {
  ivec2 size = textureSize(environment_image, 0);
  float length_2 = dot(direction.xy, direction.xy);
  float turn = length_2 > 0.0 ? atan(direction.y, direction.x) : 0.0;
  vec2 at = vec2(0.5 - turn / 6.28318530718, 0.5 + atan(direction.z, sqrt(length_2)) / 3.14159265359) * vec2(size) - 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 share = at - vec2(low);
  ivec2 columns = (ivec2(low.x, low.x + 1) + size.x) % size.x, rows = clamp(ivec2(low.y, low.y + 1), 0, size.y - 1);
  vec3 below = mix(texelFetch(environment_image, ivec2(columns.x, rows.x), 0).rgb,
                   texelFetch(environment_image, ivec2(columns.y, rows.x), 0).rgb, share.x);
  vec3 above = mix(texelFetch(environment_image, ivec2(columns.x, rows.y), 0).rgb,
                   texelFetch(environment_image, ivec2(columns.y, rows.y), 0).rgb, share.x);
  return mix(below, above, share.y);
}
