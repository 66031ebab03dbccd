// References: Guennebaud et al. 2006, section 5.1 (polygons are drawn into textures of their own).
// Summary: corners of polygons and their attributes, with the normal on the visible side. Of the two sides of a card,
//          which are in the same place, the one that faces the viewer is seen. Hook: `plane` of the triangle.

#include "lib/nowhere.glsl"
#include "hosts/corner.glsl"

const float BACK_FARTHER = 1e-5;  // as a share of the distance

vec3 moved_back(vec3 eye) {
  return view.is_parallel > 0.5 ? eye * vec3(1.0, 1.0, 1.0 + BACK_FARTHER) : eye * (1.0 + BACK_FARTHER);
}

#parts
void main() {
  vec3 eye = corner_position(gl_VertexID), first;
  vec3 outward = triangle_normal(gl_VertexID, first);
  bool is_back = shows_back(outward, first);
  vec4 place = corner_texel(gl_VertexID, 0);
  vec3 seen = is_back ? moved_back(eye) : eye;
  depth_at = -seen.z;
  corner_normal = normalize(mat3(draw.normal_matrix) * corner_texel(gl_VertexID, 1).xyz) * (is_back ? -1.0 : 1.0);
  corner_color = corner_texel(gl_VertexID, 2).rgb;
  hand_on_corner(gl_VertexID, place.w, eye);
  #hook plane(gl_VertexID, place.w, first, outward, is_back)
  gl_Position = is_back && draw.hides_backs > 0.5 ? nowhere(first) : view.projection * vec4(seen, 1.0);
}
