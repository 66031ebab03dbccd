// References: Guennebaud et al. 2006, section 5.1 (polygons are drawn into textures of their own).
// Summary: corners of polygons and their attributes, with the normal on the visible side. Of the two sides of a card,
//          which are in the same place, the one that faces the viewer is seen. Hook: `plane` of the triangle.

#include "lib/instances/{instances}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/corner.glsl"

const float BACK_FARTHER = 1e-5;  // as a share of the distance

vec3 moved_back(vec3 eye) {
  return view.is_parallel > 0.5 ? eye * vec3(1.0, 1.0, 1.0 + BACK_FARTHER) : eye * (1.0 + BACK_FARTHER);
}

#parts
void main() {
  int vertex = begun_vertex();
  vec3 eye = corner_position(vertex), first;
  vec3 outward = triangle_normal(vertex, first);
  bool is_back = shows_back(outward, first);
  vec4 place = corner_texel(vertex, 0);
  vec3 seen = is_back ? moved_back(eye) : eye;
  depth_at = -seen.z;
  corner_normal = normalize(mat3(instance.normal_matrix) * corner_texel(vertex, 1).xyz) * (is_back ? -1.0 : 1.0);
  corner_color = corner_texel(vertex, 2).rgb;
  hand_on_corner(vertex, place.w, eye);
  #hook plane(vertex, place.w, first, outward, is_back)
  gl_Position = is_back && instance.hides_backs > 0.5 ? nowhere(first) : view.projection * vec4(seen, 1.0);
}
