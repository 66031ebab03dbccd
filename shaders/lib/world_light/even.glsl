// References: none needed.
// Summary: the radiance that reaches a surface from all around, of an even world.

vec3 world_irradiance(vec3 normal) {  // over pi
  return frame.world.rgb;
}

vec3 world_reflection(vec3 direction, float roughness) {
  return frame.world.rgb;
}
