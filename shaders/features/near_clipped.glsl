// References: adj(M) for splats that straddle the near plane: Guennebaud et al. 2006, equation 5.
// Summary: a splat that reaches the near plane is drawn in space, where the hardware clips it, without a filter.

#part vertex
const float NEAR_CLIPPED_MARGIN = 1.02;

#include "lib/reaches_near.glsl"

#part screen_space.vert
void near_clipped_clip(Splat splat, inout bool in_space) {
  in_space = reaches_near(splat);
}

// The method may have lengthened it. The first three varyings then hold its centre and half-axes.
void near_clipped_clipped(Splat splat, inout bool in_space) {
  in_space = reaches_near(splat);
  near_clipped = in_space ? 1.0 : 0.0;
  if (!in_space) return;
  plane_ab = vec4(splat.position, 0.0);
  plane_center_gh = vec4(splat.axis_u, 0.0);
  plane_depths = vec4(splat.axis_v, 0.0);
  plane_det_radius = vec4(0.0);
}

void near_clipped_place(Splat splat, vec2 corner, bool in_space) {
  vec2 grown = corner * NEAR_CLIPPED_MARGIN;
  vec3 eye = splat.position + splat.axis_u * grown.x + splat.axis_v * grown.y;
  if (in_space && !splat.is_hidden) gl_Position = view.projection * vec4(eye, 1.0);
}

#part screen_space.frag
// Position and depth on the splat.
vec3 place_in_space(vec2 point) {
  bool is_orthographic = view.is_parallel > 0.5;
  vec3 forward = vec3(1.0, 1.0, -1.0);
  vec3 p = plane_ab.xyz * forward, s = plane_center_gh.xyz * forward, t = plane_depths.xyz * forward;
  vec3 direction = is_orthographic ? vec3(0.0, 0.0, 1.0) : vec3(point, 1.0);
  if (is_orthographic) p.xy -= point;
  float w = dot(cross(s, t), direction);
  vec2 uv = vec2(dot(cross(t, p), direction), dot(cross(p, s), direction)) / w;
  return vec3(uv, dot(cross(s, t), p) / w);
}

void near_clipped_weigh(inout Candidate c) {
  c.in_space = near_clipped > 0.5;
  if (!c.in_space) return;
  c.place = place_in_space(view.window.xy + gl_FragCoord.xy * view.window.zw);
  float rho2 = dot(c.place.xy, c.place.xy);
  c.weight = rho2 <= 1.0 && c.place.z >= view.near ? exp(-2.0 * rho2) : 0.0;
  c.depth = c.place.z;
}
