// References: Botsch, Hornung, Zwicker, Kobbelt, "High-Quality Surface Splatting on Today's GPUs", 2005, section 3
//             (visibility splatting); the view-independent paper, section 5 (the offset along the view ray).
// Summary: every splat moved away from the eye by its own epsilon, so that what lies within epsilon blends; by no less
//          than the depth can resolve, or rounding would let a splat hide itself. The corners are moved, which is
//          right for splats of a small angle; where linear depth is planned, every fragment is.

#define VERTEX_STAGE
#include "common/depth.glsl"
#ifdef IDENTITY_TARGET
#include "common/identity.glsl"
#endif
#include "common/nowhere.glsl"
#include "common/sides.glsl"
#ifdef SPLIT
#include "common/split.glsl"
#endif
#include "common/stored_splat.glsl"
#include "methods/quad.glsl"

void main() {
  StoredSplat stored = stored_splat(gl_VertexID / 3);
  vec2 corner = triangle_corner(gl_VertexID);
  mat3 linear = mat3(splats.model_view);
  vec3 position = (splats.model_view * vec4(stored.position, 1.0)).xyz;
  vec3 axis_u = linear * stored.axis_u;
  vec3 axis_v = linear * stored.axis_v;
  vec3 eye = footprint_corner(position, axis_u, axis_v, corner);
  place_depth = vec3(corner, -eye.z);
#ifdef IDENTITY_TARGET
  number = splat_number(stored.material);
#endif
  bool is_orthographic = splats.options.z > 0.5;
  float offset = splats.options.x * sqrt(max(dot(axis_u, axis_u), dot(axis_v, axis_v)));
  bool is_back = outward_cosine(position, axis_u, axis_v, splats.sides.x, is_orthographic) < 0.0;
  if (is_back) offset *= BACK_EPSILON;
#ifdef LINEAR_DEPTH
  across_offset = vec3(is_orthographic ? vec2(0.0) : eye.xy, offset);
#else
  vec4 unmoved = splats.projection * vec4(eye, 1.0);
  offset = max(offset, splats.sides.z * (is_orthographic ? 1.0 : length(eye)));
  eye += offset * (is_orthographic ? vec3(0.0, 0.0, -1.0) : eye / max(length(eye), 1e-30));
#endif
  vec4 moved = splats.projection * vec4(eye, 1.0);
#ifndef LINEAR_DEPTH
  // Moving brings nothing beyond the far plane.
  moved.z = min(moved.z, moved.w * max(unmoved.z / unmoved.w, 2.0 * FARTHEST_STORED - 1.0));
#endif
  bool is_hidden = is_back && splats.sides.y > 0.5;
#ifdef SPLIT
  is_hidden = is_hidden || split_distance(position) < splats.identity.z;
#endif
#ifdef LAYER
  is_hidden = is_hidden || stored.color.a < LEAST_OPACITY;
#endif
#ifdef SCREEN_DOOR
  opacity_surface = vec2(stored.color.a, 2.0 * splats.identity.x + (is_back ? 1.0 : 0.0));
#endif
  gl_Position = is_hidden ? NOWHERE : moved;
}
