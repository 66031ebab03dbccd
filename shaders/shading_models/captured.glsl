// References: none needed.
// Summary: the surfels' own colour under white light from all around, which ambient occlusion may block, and the diffuse
//          light of lamps on top.

#include "hosts/world_light.glsl"

#parts
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  vec3 light = world_irradiance(normal);
  #hook lit(light, position, normal)
  return base * light;
}

#part lights
#include "lib/diffuse_lights.glsl"

void lights_lit(inout vec3 sum, vec3 position, vec3 normal) {
  sum += diffuse_light(position, normal);
}
