// References: Karis, "Real Shading in Unreal Engine 4", 2013 (a picture blurred by the lobe); rendering/environment.py,
//             which makes the textures; Blender's Environment Texture (the equirectangular map).
// Summary: the radiance that reaches a surface from all around, and what is seen where nothing is drawn: an even world,
//          or a picture of one.

const int LEVEL_SIDE = 32;
const int BLURRED_LEVELS = 5;
const float BLURRED_ROUGHNESS[5] = float[5](0.25, 0.4, 0.6, 0.8, 1.0);

#ifdef ENVIRONMENT
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

#endif

#ifdef ENVIRONMENT_LIGHT
vec3 environment_level_at(int level, vec3 direction) {
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = vec2(d.x >= 0.0 ? 1.0 - abs(d.y) : abs(d.y) - 1.0, d.y >= 0.0 ? 1.0 - abs(d.x) : abs(d.x) - 1.0);
  vec2 at = ((d.z < 0.0 ? folded : d.xy) * 0.5 + 0.5) * float(LEVEL_SIDE) + 0.5;
  ivec2 low = clamp(ivec2(floor(at)), ivec2(0), ivec2(LEVEL_SIDE));
  vec2 share = at - vec2(low);
  ivec2 first = low + ivec2(0, level * (LEVEL_SIDE + 2));
  vec3 below = mix(texelFetch(environment_levels, first, 0).rgb,
                   texelFetch(environment_levels, first + ivec2(1, 0), 0).rgb, share.x);
  vec3 above = mix(texelFetch(environment_levels, first + ivec2(0, 1), 0).rgb,
                   texelFetch(environment_levels, first + ivec2(1, 1), 0).rgb, share.x);
  return mix(below, above, share.y);
}

vec3 world_irradiance(vec3 normal) {  // over pi
  return shading.world.rgb * environment_level_at(BLURRED_LEVELS, mat3(shading.view_to_environment) * normal);
}

vec3 world_reflection(vec3 direction, float roughness) {
  vec3 toward = mat3(shading.view_to_environment) * direction;
  if (roughness < BLURRED_ROUGHNESS[0]) {
    vec3 sharp = environment_image_at(toward);
    return shading.world.rgb * mix(sharp, environment_level_at(0, toward), roughness / BLURRED_ROUGHNESS[0]);
  }
  int level = 0;
  while (level < BLURRED_LEVELS - 2 && roughness > BLURRED_ROUGHNESS[level + 1]) level++;
  float share = (roughness - BLURRED_ROUGHNESS[level]) / (BLURRED_ROUGHNESS[level + 1] - BLURRED_ROUGHNESS[level]);
  vec3 finer = environment_level_at(level, toward), coarser = environment_level_at(level + 1, toward);
  return shading.world.rgb * mix(finer, coarser, clamp(share, 0.0, 1.0));
}
#else
vec3 world_irradiance(vec3 normal) {  // over pi
  return shading.world.rgb;
}

vec3 world_reflection(vec3 direction, float roughness) {
  return shading.world.rgb;
}
#endif

// Premultiplied, of the sample at that texel.
vec4 world_background(ivec2 texel) {
#ifdef ENVIRONMENT
  vec2 place = shading.window.xy + (vec2(texel) + 0.5) * shading.window.zw;
  vec3 direction = shading.options.x > 0.5 ? vec3(0.0, 0.0, -1.0) : vec3(place, -1.0);
  vec3 seen = environment_image_at(mat3(shading.view_to_environment) * normalize(direction));
#else
  vec3 seen = vec3(1.0);
#endif
  return vec4(seen * shading.world.rgb, 1.0) * shading.world.w;
}
