// References: Guennebaud et al. 2006, section 5.1 (polygons share the depth of the splats, with a tolerance).
// Summary: depth of polygons; moved back along the view ray by the distance that splats of the same surface may be
//          behind them, and at least by what the depth can resolve. The fragment shader is that of splats. Hook:
//          `moved` is called with the moved corner.

#include "depth_formats/{depth_format}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/corner.glsl"

#parts
void main() {
  vec3 eye = corner_position(gl_VertexID), first;
  vec3 outward = triangle_normal(gl_VertexID, first);
  bool is_hidden = draw.hides_backs > 0.5 && shows_back(outward, first);
  place_depth = vec3(0.0, 0.0, -eye.z);
  float slot = corner_texel(gl_VertexID / 3 * 3, 0).w;
  hand_on_corner(gl_VertexID, slot, eye);
  vec4 moved = polygon_corner(eye, draw.epsilon);
  #hook moved(gl_VertexID, slot, eye, first, outward, moved)
  gl_Position = is_hidden ? nowhere(first) : moved;
}
