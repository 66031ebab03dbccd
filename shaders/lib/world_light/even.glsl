// References: none needed.
// Summary: the radiance that is sent to a surface from all around, of an even world.

vec3 sent_irradiance(vec3 normal) {  // over pi
  return frame.world.rgb;
}

vec3 sent_reflection(vec3 direction, float roughness) {
  return frame.world.rgb;
}
