// References: Guennebaud et al. 2006, section 5.1 (polygons share the depth of the splats, with a tolerance).
// Summary: depth of polygons; moved back along the view ray by the distance that splats of the same surface may be
//          behind them, and at least by what the depth can resolve. The fragment shader is that of splats. Hook:
//          `moved` is called with the moved corner.

#include "lib/instances/{instances}.glsl"
#include "depth_formats/{depth_format}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/corner.glsl"

#parts
void main() {
  int vertex = begun_vertex();
  vec3 eye = corner_position(vertex), first;
  vec3 outward = triangle_normal(vertex, first);
  bool is_hidden = instance.hides_backs > 0.5 && shows_back(outward, first);
  place_depth = vec3(0.0, 0.0, -eye.z);
  float slot = corner_texel(vertex / 3 * 3, 0).w;
  hand_on_corner(vertex, slot, eye);
  vec4 moved = polygon_corner(eye, instance.overlap);
  #hook moved(vertex, slot, eye, first, outward, moved)
  gl_Position = is_hidden ? nowhere(first) : moved;
}
