// References: none needed.
// Summary: the geometric normal of a splat on the side that is seen, and its stereographic projection, which is smooth over
//          all directions but the viewer's own: sums of two numbers have the mean of normals that face the viewer.

// Of 1 + z: only at the rim of pictures far wider than 120 degrees does a seen surface's normal point away more.
const float LEAST_FACED = 0.05;

vec3 faced_normal(vec2 projected) {
  float square = dot(projected, projected);
  return vec3(2.0 * projected, 1.0 - square) / (1.0 + square);
}
