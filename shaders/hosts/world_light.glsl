// References: lib/world_light.
// Summary: the world's light on a surface. Hooks: `diffuse`, `behind` and `reflected` change the incoming light,
//          `through` changes the light that arrives at another place.

#include "lib/world_light/{world_light}.glsl"

#parts
vec3 world_irradiance(vec3 normal) {  // over pi
  vec3 light = sent_irradiance(normal);
  #hook diffuse(light)
  return light;
}

vec3 world_behind(vec3 normal) {  // on the other side, over pi
  vec3 light = sent_irradiance(-normal);
  #hook behind(light)
  return light;
}

vec3 world_reflection(vec3 direction, float roughness) {
  vec3 light = sent_reflection(direction, roughness);
  #hook reflected(light, direction, roughness)
  return light;
}

// place: from the surface's own, view space.
vec3 world_through(vec3 place, vec3 direction, float roughness) {
  vec3 light = sent_reflection(direction, roughness);
  #hook through(light, place, direction, roughness)
  return light;
}
