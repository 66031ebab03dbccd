// References: none needed.
// Summary: plane of the visible polygon, for shadow comparisons and texture lookups.

#part polygons.vert
void polygon_plane_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  triangle_plane = outward / max(length(outward), 1e-30) * (is_back ? -1.0 : 1.0);
}

#part polygons.frag, writes_polygon_plane
void polygon_plane_add() {
  polygon_plane = vec4(triangle_plane, 0.0);
}
