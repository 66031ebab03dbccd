// References: Boubekeur, Alexa, "Phong Tessellation", 2008 (the surface that corner normals describe); Hanika, "Hacking
//             the Shadow Terminator", Ray Tracing Gems II, 2021 (points are lit as points of that surface).
// Summary: plane of the visible polygon, for shadow comparisons and texture lookups; and how high the smooth surface of
//          its shading normals lies above it. Its twin is `smooth_heights` in sampling/attributes/lifts.py.

#part polygons.vert
void polygon_plane_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  triangle_plane = outward / max(length(outward), 1e-30) * (is_back ? -1.0 : 1.0);
}

#part polygons.vert, writes_polygon_plane
vec3 outward_normal(int corner, float side) {
  return side * normalize(mat3(instance.normal_matrix) * corner_texel(corner, 1).xyz);
}

// How far the ends of an edge lie below one another's tangent planes, together.
float edge_bulge(vec3 edge, vec3 at_start, vec3 at_end) {
  return max(-dot(edge, at_start), 0.0) + max(dot(edge, at_end), 0.0);
}

void writes_polygon_plane_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  int start = corner / 3 * 3, own = corner - start;
  float side = is_back ? -1.0 : 1.0;
  vec3 a = first, b = corner_position(start + 1), c = corner_position(start + 2);
  vec3 at_a = outward_normal(start, side), at_b = outward_normal(start + 1, side), at_c = outward_normal(start + 2, side);
  triangle_bulge = vec3(edge_bulge(b - a, at_a, at_b), edge_bulge(c - b, at_b, at_c), edge_bulge(a - c, at_c, at_a));
  triangle_place = vec3(own == 0, own == 1, own == 2);
}

#part polygons.frag, writes_polygon_plane
void polygon_plane_add() {
  float lift = dot(triangle_place * triangle_place.yzx, triangle_bulge);
  polygon_plane = vec4(triangle_plane, lift);
}
