// References: Botsch, Kobbelt 2003, section 5 (the level without filtering).
// Summary: the attributes of the one splat that is nearest; shading divides by its weight.

#include "common/sums.glsl"
#include "methods/{method}.glsl"

void main() {
  if (!is_in_disc(place, tilt_depth.xy)) discard;
  add_to_sums(color_weight.rgb, color_weight.w, tilt_depth.z);
#ifdef IDENTITY_TARGET
  identity = vec2(number, tilt_depth.z);
#endif
}
