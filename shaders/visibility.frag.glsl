// References: as visibility.vert.glsl.
// Summary: depth only; what lies outside the ellipse, or before the near plane (where only the offset brought it
//          into view), leaves none.

#include "common/depth.glsl"

void main() {
  if (!(dot(place_depth.xy, place_depth.xy) <= 1.0 && place_depth.z >= splats.options.y)) discard;
#ifdef LINEAR_DEPTH
  float distance = length(vec3(across_offset.xy, place_depth.z));
  write_depth(place_depth.z * (1.0 + max(across_offset.z / distance, splats.sides.z)));
#endif
}
