// References: as visibility.vert.glsl.
// Summary: writes depth, except outside the ellipse and in front of the near plane (which only the offset moved into
//          view). Hooks: `keep` discards, `add` fills targets.

#include "lib/instances/{instances}.glsl"
#include "depth_formats/{depth_format}.glsl"

#parts
void main() {
  begin_fragment();
  if (!(dot(place_depth.xy, place_depth.xy) <= 1.0 && place_depth.z >= view.near)) discard;
  #hook keep()
  write_moved_depth();
  #hook add()
}
