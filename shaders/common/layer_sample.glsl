// References: Guennebaud, Barthe, Paulin 2006, section 6 (the two further depth comparisons of a layer).
// Summary: whether a fragment in space may be in the layer that is made. Depths are those of the splats where they are,
//          what hides them was moved back by its epsilon.

#define PROJECTION splats.projection
#define PARALLEL (splats.options.z > 0.5)
#define DEPTH_UNIT splats.options.w
#include "common/stored_depth.glsl"
#include "common/peeled.glsl"

bool is_in_layer(float depth, ivec2 at) {
  float stored = stored_depth(depth), opaque = texelFetch(visibility_depth, at, 0).r;
  return !is_peeled(stored, at) && (opaque == 1.0 || stored <= opaque);
}
