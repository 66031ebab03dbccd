// References: none needed.
// Summary: a splat's geometric normal on the visible side, and its stereographic projection, which is smooth for all
//          directions except the viewer's own: sums of these two numbers have the mean of normals that face the viewer.

// Minimum of 1 + z: only at the border of pictures far wider than 120 degrees do visible normals point further away.
const float LEAST_FACED = 0.05;

vec3 faced_normal(vec2 projected) {
  float square = dot(projected, projected);
  return vec3(2.0 * projected, 1.0 - square) / (1.0 + square);
}
