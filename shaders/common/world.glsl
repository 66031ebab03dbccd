// References: none needed.
// Summary: the radiance that reaches a surface from all around, and what is seen where nothing is drawn. An even world.

vec3 world_irradiance(vec3 normal) {  // over pi
  return shading.world.rgb;
}

vec3 world_reflection(vec3 direction, float roughness) {
  return shading.world.rgb;
}
