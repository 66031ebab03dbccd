// References: none needed.
// Summary: the light of a uniform world on a surface.

vec3 sent_irradiance(vec3 normal) {  // over pi
  return frame.world.rgb;
}

vec3 sent_reflection(vec3 direction, float roughness) {
  return frame.world.rgb;
}
