// References: Guennebaud et al. 2006, section 5.1 (polygons share the depth of the splats, with a tolerance).
// Summary: depth only, of polygons; moved back along the view ray by what splats of the same surface may lie behind them,
//          and by no less than the depth can resolve. Its fragment shader is that of splats.

#define VERTEX_STAGE
#include "common/depth.glsl"
#ifdef IDENTITY_TARGET
#include "common/identity.glsl"
#endif
#include "common/nowhere.glsl"
#include "polygons/corner.glsl"

void main() {
  vec3 eye = corner_position(gl_VertexID), first;
  vec3 outward = triangle_normal(gl_VertexID, first);
  bool is_orthographic = splats.options.z > 0.5, is_hidden = splats.sides.y > 0.5 && shows_back(outward, first);
  place_depth = vec3(0.0, 0.0, -eye.z);
#ifdef IDENTITY_TARGET
  number = splat_number(corner_texel(gl_VertexID / 3 * 3, 0).w);
#endif
#ifdef SPLIT
  split_place = eye;
#endif
  float offset = splats.options.x;
#ifdef LINEAR_DEPTH
  across_offset = vec3(is_orthographic ? vec2(0.0) : eye.xy, offset);
#else
  vec4 unmoved = splats.projection * vec4(eye, 1.0);
  // As a share of the distance, and not more than all of it: an end may lie behind the eye.
  float share = max(min(offset / max(length(eye), 1e-30), 1.0), splats.sides.z);
  eye = is_orthographic ? eye - vec3(0.0, 0.0, max(offset, splats.sides.z)) : eye * (1.0 + share);
#endif
  vec4 moved = splats.projection * vec4(eye, 1.0);
#ifndef LINEAR_DEPTH
  // Moving brings nothing beyond the far plane.
  if (unmoved.w > 0.0) moved.z = min(moved.z, moved.w * max(unmoved.z / unmoved.w, 2.0 * FARTHEST_STORED - 1.0));
#endif
  gl_Position = is_hidden ? NOWHERE : moved;
}
