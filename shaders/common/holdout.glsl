// References: Blender manual, "Holdout".
// Summary: where an object that cuts a hole is seen first. It has depths and nothing else: there is a depth and nothing
//          to shade, or nothing but what lies deeper.

#define PROJECTION shading.projection
#define PARALLEL (shading.options.x > 0.5)
#define DEPTH_UNIT shading.options.z
#include "common/stored_depth.glsl"

const float SAME_DEPTH = 1e-4;

// look: which of the texel's hardware samples.
bool is_hole(ivec2 texel, int look, MeanSurface mean) {
  float seen = texelFetch(visibility_depth, texel, look).r;
  if (seen == 1.0) return false;
  float depth = view_depth(seen);
  return !(mean.coverage > 0.0) || mean.depth > depth + SAME_DEPTH * abs(depth);
}
