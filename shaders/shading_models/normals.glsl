// References: none needed.
// Summary: the direction that the surface faces in the world, -1 to 1 as 0 to 1.

vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  return mat3(view.to_world) * normal * 0.5 + 0.5;
}
