// References: rendering/scene/polygons.py, which writes this layout.
// Summary: the corners of polygons, pulled from their texture, and the side of a triangle that is seen. Hook:
//          `tell`, what fragments are told beside.

vec4 corner_texel(int corner, int number) {
  return texelFetch(polygon_corners, ivec2((corner % CORNERS_PER_ROW) * TEXELS_PER_CORNER + number, corner / CORNERS_PER_ROW), 0);
}

// In view space.
vec3 corner_position(int corner) {
  return (draw.model_view * vec4(corner_texel(corner, 0).xyz, 1.0)).xyz;
}

// Normal of the plane of a corner's triangle on its outward side, view space, of no special length.
vec3 triangle_normal(int corner, out vec3 first) {
  int start = corner / 3 * 3;
  first = corner_position(start);
  return cross(corner_position(start + 1) - first, corner_position(start + 2) - first) * draw.orientation;
}

bool shows_back(vec3 normal, vec3 first) {
  return dot(normal, view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : -first) < 0.0;
}

#parts
// What fragments are told of a corner beside its place. slot: of its material.
void hand_on_corner(int corner, float slot, vec3 eye) {
  #hook tell(corner, slot, eye)
}
