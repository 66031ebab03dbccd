// References: none needed.
// Summary: the direction from a point in view space to the viewer.

vec3 to_viewer(vec3 position) {
  return view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : -normalize(position);
}
