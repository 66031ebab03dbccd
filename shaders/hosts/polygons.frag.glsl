// References: Guennebaud et al. 2006, section 5.1.
// Summary: the attributes of the nearest polygon. Hooks: `keep` discards, `color` changes the colour, `bend` the
//          normal, `add` fills targets.

#include "lib/instances/{instances}.glsl"
#include "depth_formats/{depth_format}.glsl"

#parts
void main() {
  begin_fragment();
  if (!(depth_at >= view.near)) discard;
  #hook keep()
  write_depth(depth_at);
  vec3 color = corner_color;
  #hook color(color)
  polygon_color = vec4(color, 1.0);
  vec3 normal = normalize(corner_normal);
  #hook bend(normal)
  polygon_normal = vec4(normal, depth_at);
  #hook add()
}
