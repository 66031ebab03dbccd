// References: none needed.
// Summary: change of a triangle's texture coordinates along each axis of view space, in its plane.

// start: its first corner, at `first`. to_along, to_beside: difference of the second and third corner's coordinates.
void gradient_of(int start, vec3 first, vec2 to_along, vec2 to_beside, out vec3 along_u, out vec3 along_v) {
  vec3 along = corner_position(start + 1) - first, beside = corner_position(start + 2) - first;
  vec3 plane = cross(along, beside);
  float square = max(dot(plane, plane), 1e-37);
  vec3 dual_along = cross(beside, plane) / square, dual_beside = cross(plane, along) / square;
  along_u = to_along.x * dual_along + to_beside.x * dual_beside;
  along_v = to_along.y * dual_along + to_beside.y * dual_beside;
}
