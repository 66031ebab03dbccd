// References: Botsch et al. 2005, sections 3 and 4 (accumulation, normalised by the sum of weights in the next pass).
// Summary: adds weighted attributes to their sums; the depth test keeps visible splats. Hooks: `keep` discards, `color`
//          changes the colour.

#include "lib/instances/{instances}.glsl"
#include "depth_formats/{depth_format}.glsl"
#include "hosts/gbuffer.glsl"
#include "methods/{method}.glsl"

#parts
void main() {
  begin_fragment();
  float weight = kernel_weight(place_depth.xy) * color_weight.w;
  float depth = seen_depth();
  if (!(weight > 0.0 && depth >= view.near)) discard;
  #hook keep()
  write_depth(depth);
  vec3 color = color_weight.rgb;
  #hook color(color)
  add_to_sums(color, weight, depth);
}
