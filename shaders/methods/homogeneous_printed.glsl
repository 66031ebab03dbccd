// References: Guennebaud, Barthe, Paulin 2006, as printed: equations 4 to 6 (the map from the picture to the splat), set up
//             once a splat (section 3.2), and equations 8 to 10 (its tangents).
// Summary: for comparison with `homogeneous.glsl`, which is repaired: a disc that faces the ray vanishes, and small
//          splats lose the depth of their planes. The twin of reference/methods/homogeneous_printed.py.

#include "lib/homogeneous.glsl"

#part vertex
// Equations 5 and 6: the adjoint of the map whose columns are the half-axes and the centre, scaled so that w is 1 / depth.
// The paper's w is b times that, and its fourth row adds a: the depth in the window. Here depths are compared along the
// view, so that b and a would be taken off again, and digits with them.
mat4x3 perspective_map(Splat splat) {
  vec3 forward = vec3(1.0, 1.0, -1.0);
  vec3 s = forward * splat.axis_u, t = forward * splat.axis_v, p = forward * splat.position, third = cross(s, t);
  return mat4x3(cross(t, p), cross(p, s), third, third) / dot(third, p);
}

// Of a parallel view, where the paper has none: w is 1, and the fourth row is the depth.
mat4x3 parallel_map(Splat splat) {
  vec2 s = splat.axis_u.xy, t = splat.axis_v.xy, p = splat.position.xy, slope = vec2(splat.axis_u.z, splat.axis_v.z);
  float area = s.x * t.y - s.y * t.x;
  vec3 u = vec3(t.y, -t.x, p.y * t.x - p.x * t.y) / area, v = vec3(-s.y, s.x, p.x * s.y - p.y * s.x) / area;
  return mat4x3(u, v, vec3(0.0, 0.0, 1.0), -vec3(0.0, 0.0, splat.position.z) - slope.x * u - slope.y * v);
}

// The paper's tangents, for discs only: across the ray and along it, about perpendicular in the picture. Those of a disc
// that faces the ray are 0 / 0.
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {
  vec3 normal_to_plane = normalize(cross(splat.axis_u, splat.axis_v));
  vec3 across = cross(is_orthographic ? vec3(0.0, 0.0, -1.0) : splat.position, normal_to_plane);
  splat.axis_u = plane.radius * normalize(across);
  splat.axis_v = plane.radius * normalize(cross(normal_to_plane, across));
  plane = lengthened(splat, is_orthographic);
  mat3x4 columns = transpose(is_orthographic ? parallel_map(splat) : perspective_map(splat));
  to_splat_x = columns[0] * view.window.z;
  to_splat_y = columns[1] * view.window.w;
  to_splat_origin = columns[0] * view.window.x + (columns[1] * view.window.y + columns[2]);
}
#part fragment
// Weight and depth: equation 4 by two multiplications and additions.
vec2 splat_sample(Plane plane, vec2 pixel) {
  vec4 uvw = to_splat_x * pixel.x + (to_splat_y * pixel.y + to_splat_origin);
  vec2 uv = uvw.xy / uvw.z;
  float rho2 = dot(uv, uv);
  return vec2(rho2 <= 1.0 && uvw.z > 0.0 ? exp(-2.0 * rho2) : 0.0, view.is_parallel > 0.5 ? uvw.w : 1.0 / uvw.z);
}
