// References: as visibility.vert.glsl.
// Summary: depth only; what lies outside the ellipse, or before the near plane (where only the offset brought it
//          into view), leaves none.

#include "methods/{method}.glsl"

void main() {
  if (!(kernel_weight(place_depth.xy) > 0.0 && place_depth.z >= splats.options.y)) discard;
}
