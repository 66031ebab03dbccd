// References: none needed.
// Summary: the surfels' own colour, unlit.

vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  return base;
}
