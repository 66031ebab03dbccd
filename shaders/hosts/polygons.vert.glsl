// References: Guennebaud et al. 2006, section 5.1 (polygons are drawn into textures of their own).
// Summary: corners of polygons and their attributes, with the normal on the visible side. Hook: `plane` of the
//          triangle.

#include "lib/nowhere.glsl"
#include "hosts/corner.glsl"

#parts
void main() {
  vec3 eye = corner_position(gl_VertexID), first;
  vec3 outward = triangle_normal(gl_VertexID, first);
  bool is_back = shows_back(outward, first);
  vec4 place = corner_texel(gl_VertexID, 0);
  depth_at = -eye.z;
  corner_normal = normalize(mat3(draw.normal_matrix) * corner_texel(gl_VertexID, 1).xyz) * (is_back ? -1.0 : 1.0);
  corner_color = corner_texel(gl_VertexID, 2).rgb;
  hand_on_corner(gl_VertexID, place.w, eye);
  #hook plane(gl_VertexID, place.w, first, outward, is_back)
  gl_Position = is_back && draw.hides_backs > 0.5 ? nowhere(first) : view.projection * vec4(eye, 1.0);
}
