// References: Cook, Halstead, Planck, Ryu, "Stochastic Simplification of Aggregate Detail", 2007; lib/own_threshold.glsl.
// Summary: surfels of surfaces with holes are drawn whole or not at all, as often as they are opaque.

#part splat
#include "lib/own_threshold.glsl"

// Several splats overlap at each point of a surface, so each is drawn less often than the surface is opaque. They are no
// larger than it takes to leave no gaps, because whole splats reach beyond the rims of leaves.
void splat_holes_resize(inout Splat splat, int index) {
  bool is_merged = float(index) >= draw.first_merged;
  float size = is_merged ? MERGED_HOLE_SIZE : HOLE_SIZE;
  splat.axis_u *= size;
  splat.axis_v *= size;
  float overlaps = is_merged ? MERGED_OVERLAPS * splat.shortened * splat.shortened : OVERLAPS;
  float drawn = 1.0 - pow(1.0 - splat.opacity, 1.0 / overlaps);
  float surface = surface_number(index, int(instance.normal_matrix[3].x));
  splat.is_hidden = splat.is_hidden || drawn <= own_threshold(surface, ivec2(0), frame.cut_turned);
  splat.opacity = 1.0;
}
