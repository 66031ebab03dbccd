// References: Guennebaud, Barthe, Paulin 2006, section 6 (the two further depth comparisons of a layer).
// Summary: whether a fragment in space may be in the current layer. Depths are those of the splats themselves, while
//          hiding depths were moved back by epsilon.

#include "depth_formats/{depth_format}.glsl"
#include "lib/peel_state.glsl"
#include "lib/layer_ties.glsl"

// steps: tolerance within which splats of equal depth are included; 0 for visibility, so that attributes include
// everything visible.
bool is_in_layer(float depth, float steps, ivec2 at) {
  float opaque = texelFetch(visibility_depth, at, 0).r;
  bool is_behind = !is_peeled(stored_depth(tied(depth, steps)), at);
  return is_behind && (opaque == 1.0 || stored_depth(tied(depth, -steps)) <= opaque);
}
