// References: Blender manual, "Holdout".
// Summary: where an object that cuts a hole is seen first. It has depths and nothing else: there is a depth and nothing
//          to shade, or nothing but what lies deeper.

#include "depth_formats/{depth_format}.glsl"

const float SAME_DEPTH = 1e-4;

// tap: which of the texel's hardware samples.
bool is_hole(ivec2 texel, int tap, MeanSurface mean) {
  float seen = texelFetch(visibility_depth, texel, tap).r;
  if (seen == 1.0) return false;
  float depth = view_depth(seen);
  return !(mean.coverage > 0.0) || mean.depth > depth + SAME_DEPTH * abs(depth);
}
