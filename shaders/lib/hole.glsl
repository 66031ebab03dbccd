// References: Blender manual, "Holdout".
// Summary: whether a holdout is the first visible surface: there is a depth but nothing to shade, or only surfaces
//          farther away.

#include "depth_formats/{depth_format}.glsl"

const float SAME_DEPTH = 1e-4;

// tap: number of the texel's hardware sample.
bool is_hole(ivec2 texel, int tap, MeanSurface mean) {
  float seen = texelFetch(visibility_depth, texel, tap).r;
  if (seen == 1.0) return false;
  float depth = view_depth(seen);
  return !(mean.coverage > 0.0) || mean.depth > depth + SAME_DEPTH * abs(depth);
}
