// References: rendering/scene/polygons.py, which writes this layout.
// Summary: fetches the corners of polygons from their texture, and finds the visible side of a triangle. Hook: `tell`
//          writes further varyings.

vec4 corner_texel(int corner, int number) {
  return texelFetch(polygon_corners, ivec2((corner % CORNERS_PER_ROW) * TEXELS_PER_CORNER + number, corner / CORNERS_PER_ROW), 0);
}

// In view space.
vec3 corner_position(int corner) {
  return (instance.model_view * vec4(corner_texel(corner, 0).xyz, 1.0)).xyz;
}

// Normal of the plane of a corner's triangle on its outward side, in view space, not normalised.
vec3 triangle_normal(int corner, out vec3 first) {
  int start = corner / 3 * 3;
  first = corner_position(start);
  return cross(corner_position(start + 1) - first, corner_position(start + 2) - first) * instance.orientation;
}

bool shows_back(vec3 normal, vec3 first) {
  return dot(normal, view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : -first) < 0.0;
}

#parts
// Writes the varyings of a corner. slot: of its material.
void hand_on_corner(int corner, float slot, vec3 eye) {
  #hook tell(corner, slot, eye)
}
