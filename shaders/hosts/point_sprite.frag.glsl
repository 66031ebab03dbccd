// References: Botsch, Kobbelt 2003, section 5 (the level without filtering).
// Summary: the attributes of the nearest splat alone; shading divides by its weight. Hooks: `keep` discards, `add`
//          fills further targets.

#include "lib/instances/{instances}.glsl"
#include "hosts/gbuffer.glsl"
#include "methods/{method}.glsl"

#parts
void main() {
  begin_fragment();
  if (!is_in_disc(place, tilt_depth.xy)) discard;
  #hook keep()
  add_to_sums(color_weight.rgb, color_weight.w, tilt_depth.z);
  #hook add()
}
