// References: none needed.
// Summary: white light from all around, for shading that looks at no world.

vec3 sent_irradiance(vec3 normal) {  // over pi
  return vec3(1.0);
}

vec3 sent_reflection(vec3 direction, float roughness) {
  return vec3(1.0);
}
