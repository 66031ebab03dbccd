// References: none needed.
// Summary: texture coordinates of polygons' corners, and their change in a triangle's plane.

vec2 corner_uv(int corner) {
  return texelFetch(polygon_uvs, ivec2(corner % CORNERS_PER_ROW, corner / CORNERS_PER_ROW), 0).xy;
}

// Row of a material slot in the table of textures; -1 without a texture.
float texture_slot_of(float slot) {
  int row = min(int(slot), textureSize(texture_table, 0).y - 1);
  return texelFetch(texture_table, ivec2(0, row), 0).w > 0.0 ? float(row) : -1.0;
}

// Change of the texture coordinates along each axis of view space, in the triangle's plane. start: its first corner.
void uv_gradient(int start, vec3 first, out vec3 along_u, out vec3 along_v) {
  vec3 along = corner_position(start + 1) - first, beside = corner_position(start + 2) - first;
  vec2 uv = corner_uv(start), to_along = corner_uv(start + 1) - uv, to_beside = corner_uv(start + 2) - uv;
  vec3 plane = cross(along, beside);
  float square = max(dot(plane, plane), 1e-37);
  vec3 dual_along = cross(beside, plane) / square, dual_beside = cross(plane, along) / square;
  along_u = to_along.x * dual_along + to_beside.x * dual_beside;
  along_v = to_along.y * dual_along + to_beside.y * dual_beside;
}
