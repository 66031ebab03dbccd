// References: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016
//             (section 3.4: the frame in which lobes are tabulated).
// Summary: rows: the view's direction along the surface, across it, the normal. Seen along the normal, where the lobe is
//          round, any direction serves, but it must lie in the surface: what rounding leaves of the view's direction may
//          point out of it.

mat3 tangent_frame(vec3 normal, vec3 to_viewer) {
  vec3 beside = abs(normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  vec3 along = to_viewer - normal * dot(to_viewer, normal) + 1e-6 * beside;
  along = normalize(along - normal * dot(along, normal));
  return transpose(mat3(along, cross(normal, along), normal));
}
