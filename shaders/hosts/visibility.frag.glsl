// References: as visibility.vert.glsl.
// Summary: depth; what lies outside the ellipse, or before the near plane (where only the offset brought it into view),
//          leaves none. Hooks: `keep` discards, `add` fills targets.

#include "depth_formats/{depth_format}.glsl"

#parts
void main() {
  if (!(dot(place_depth.xy, place_depth.xy) <= 1.0 && place_depth.z >= view.near)) discard;
  #hook keep()
  write_moved_depth();
  #hook add()
}
