// References: none needed (the singular vectors of a 2 x 2 matrix).
// Summary: the two points of the unit circle that a linear map takes to the axes of its image ellipse.

// As columns, that of the longer axis first. lengths2: squared lengths. det: determinant of the map with columns a and
// b.
mat2 principal_places(vec2 a, vec2 b, float det, out vec2 lengths2) {
  float half_difference = 0.5 * (dot(a, a) - dot(b, b)), across = dot(a, b);
  float apart = length(vec2(half_difference, across)), longer = 0.5 * (dot(a, a) + dot(b, b)) + apart;
  lengths2 = vec2(longer, det * det / max(longer, 1e-37));
  vec2 along = half_difference > 0.0 ? vec2(half_difference + apart, across) : vec2(across, apart - half_difference);
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  return mat2(along, -along.y, along.x);
}
