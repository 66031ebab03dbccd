// References: Botsch, Kobbelt 2003, section 3.1 (the size of a splat is that of its bounding sphere on the axis).
// Summary: for methods whose nearest splat wins: a triangle around each sprite, parallel to the picture, at the depth of
//          the splat's centre; that of a back behind the fronts in its place.

#define VERTEX_STAGE
#define PROJECTION splats.projection
#define PARALLEL (splats.options.z > 0.5)
#define DEPTH_UNIT splats.options.w
#ifdef IDENTITY_TARGET
#include "common/identity.glsl"
#endif
#include "common/nowhere.glsl"
#include "common/splat_attributes.glsl"
#ifdef WITH_MATERIALS
#include "common/splat_material.glsl"
#endif
#include "common/stored_depth.glsl"
#include "methods/{method}.glsl"

void main() {
  Splat splat = fetch_splat(gl_VertexID / 3);
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  float depth = -splat.position.z, scale = PARALLEL ? 1.0 : 1.0 / depth;
  vec2 tilt = sprite_tilt(splat.axis_u, splat.axis_v);
  place = disc_in_sprite(tilt, triangle_corner(gl_VertexID));
  tilt_depth = vec3(tilt, depth);
  color_weight = splat.color_weight;
  normal = splat.normal;
#ifdef IDENTITY_TARGET
  number = splat_number(splat.material);
#endif
#ifdef WITH_MATERIALS
  fetch_material(gl_VertexID / 3, splat.material);
#endif
  vec4 clip = splats.projection * vec4((splat.position.xy + radius * place) * scale, -1.0, 1.0);
  float behind = splat.color_weight.w < 1.0 ? BACK_EPSILON * splats.options.x * radius : 0.0;
  bool is_before = !(depth >= splats.options.y);
  float stored = min(2.0 * stored_depth(depth + behind) - 1.0, 1.0);
  gl_Position = splat.is_hidden || is_before ? NOWHERE : vec4(clip.xy / clip.w, stored, 1.0);
}
