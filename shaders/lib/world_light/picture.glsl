// References: Karis, "Real Shading in Unreal Engine 4", 2013 (a picture blurred by the lobe); rendering/scene/environment.py,
//             which makes the textures; Blender's Environment Texture (the equirectangular map).
// Summary: the light of a world image on a surface.

#include "lib/lighting_picture/{lighting_picture}.glsl"

const int LEVEL_SIDE = 32;
const int BLURRED_LEVELS = 5;
const float BLURRED_ROUGHNESS[5] = float[5](0.25, 0.4, 0.6, 0.8, 1.0);

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

vec3 sent_irradiance(vec3 normal) {  // over pi
  return frame.world.rgb * environment_level_at(BLURRED_LEVELS, mat3(frame.to_environment) * normal);
}

vec3 sent_reflection(vec3 direction, float roughness) {
  vec3 toward = mat3(frame.to_environment) * direction;
  if (roughness < BLURRED_ROUGHNESS[0]) {
    vec3 sharp = lighting_picture_at(toward);
    return frame.world.rgb * mix(sharp, environment_level_at(0, toward), roughness / BLURRED_ROUGHNESS[0]);
  }
  int level = 0;
  while (level < BLURRED_LEVELS - 2 && roughness > BLURRED_ROUGHNESS[level + 1]) level++;
  float share = (roughness - BLURRED_ROUGHNESS[level]) / (BLURRED_ROUGHNESS[level + 1] - BLURRED_ROUGHNESS[level]);
  vec3 finer = environment_level_at(level, toward), coarser = environment_level_at(level + 1, toward);
  return frame.world.rgb * mix(finer, coarser, clamp(share, 0.0, 1.0));
}
