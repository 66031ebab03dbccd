// References: Botsch et al. 2005, sections 3 and 4 (accumulation, normalised by the sum of weights in the next pass).
// Summary: adds weighted colour, normal, depth and material to their sums; the depth test keeps what is visible.

#include "common/depth.glsl"
#include "common/sums.glsl"
#include "methods/{method}.glsl"

void main() {
  float weight = kernel_weight(place_depth.xy) * color_weight.w;
  if (!(weight > 0.0)) discard;
  write_depth(place_depth.z);
  add_to_sums(weight, place_depth.z);
}
