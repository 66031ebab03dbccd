// References: Greene, Kass, Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993.
// Summary: splats behind everything visible are not drawn.

#part screen_space.vert
#include "lib/culling.glsl"

void hiz_cull(Plane plane, vec2 middle, mat2 axes, vec2 half_axes, inout bool is_culled) {
  mat2 along = mat2(axes[0] * half_axes.x, axes[1] * half_axes.y);
  vec2 reach = FOOTPRINT_END * vec2(length(vec2(along[0].x, along[1].x)), length(vec2(along[0].y, along[1].y)));
  is_culled = is_behind_all(middle, reach, plane.depth - plane.reach);
}
