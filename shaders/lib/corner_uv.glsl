// References: none needed.
// Summary: texture coordinates of polygons' corners, and 1 where a chart of them ends: at the opposite edge, at the
//          corner.

vec4 corner_uv_texel(int corner) {
  return texelFetch(polygon_uvs, ivec2(corner % CORNERS_PER_ROW, corner / CORNERS_PER_ROW), 0);
}

vec2 corner_uv(int corner) {
  return corner_uv_texel(corner).xy;
}
