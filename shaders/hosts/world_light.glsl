// References: lib/world_light.
// Summary: the world's light on a surface. Hooks: `diffuse` and `reflected` reduce the incoming light.

#include "lib/world_light/{world_light}.glsl"

#parts
vec3 world_irradiance(vec3 normal) {  // over pi
  vec3 light = sent_irradiance(normal);
  #hook diffuse(light)
  return light;
}

vec3 world_reflection(vec3 direction, float roughness) {
  vec3 light = sent_reflection(direction, roughness);
  #hook reflected(light, direction, roughness)
  return light;
}
