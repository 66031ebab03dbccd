// References: Botsch et al. 2005, section 4 (normalise, then light once).
// Summary: a sample is lit as one surface, with the mean of its normals.

vec3 lit(Shaded s, vec3 position) {
  return shade(position, s.normal, s.mean.color, s.material);
}
