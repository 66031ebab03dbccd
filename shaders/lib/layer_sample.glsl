// References: Guennebaud, Barthe, Paulin 2006, section 6 (the two further depth comparisons of a layer).
// Summary: whether a fragment in space may be in the layer that is made. Depths are those of the splats where they are,
//          what hides them was moved back by its epsilon.

#include "depth_formats/{depth_format}.glsl"
#include "lib/peel_state.glsl"
#include "lib/layer_ties.glsl"

// steps: by which splats that tie are counted in; of visibility 0, so that attributes have all that is visible.
bool is_in_layer(float depth, float steps, ivec2 at) {
  float opaque = texelFetch(visibility_depth, at, 0).r;
  bool is_behind = !is_peeled(stored_depth(tied(depth, steps)), at);
  return is_behind && (opaque == 1.0 || stored_depth(tied(depth, -steps)) <= opaque);
}
