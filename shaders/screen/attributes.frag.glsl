// References: as attributes.vert.glsl; adj(M) for straddling splats: Guennebaud et al. 2006, equation 5.
// Summary: asks the method for weight and depth, and adds what is not hidden at the sample's centre. Depth is compared
//          here with the visibility pass's, since a triangle in the picture has none.

#define PROJECTION splats.projection
#define PARALLEL (splats.options.z > 0.5)
#define DEPTH_UNIT splats.options.w
#include "common/stored_depth.glsl"
#include "common/sums.glsl"
#ifdef LAYER
#include "common/peeled.glsl"
#endif
#include "screen/place.glsl"
#include "methods/{method}.glsl"
#ifdef TEXTURED
#include "common/splat_texture.glsl"
#endif

#ifdef STRADDLING
// Place and depth of a splat that reaches the near plane, unfiltered.
vec3 straddling_place(vec2 point) {
  bool is_orthographic = splats.options.z > 0.5;
  vec3 forward = vec3(1.0, 1.0, -1.0);
  vec3 p = plane_ab.xyz * forward, s = plane_center_gh.xyz * forward, t = plane_depths.xyz * forward;
  vec3 direction = is_orthographic ? vec3(0.0, 0.0, 1.0) : vec3(point, 1.0);
  if (is_orthographic) p.xy -= point;
  float w = dot(cross(s, t), direction);
  vec2 uv = vec2(dot(cross(t, p), direction), dot(cross(p, s), direction)) / w;
  return vec3(uv, dot(cross(s, t), p) / w);
}

vec2 straddling_sample(vec2 point) {
  vec3 place = straddling_place(point);
  float rho2 = dot(place.xy, place.xy);
  return vec2(rho2 <= 1.0 && place.z >= splats.options.y ? exp(-2.0 * rho2) : 0.0, place.z);
}
#endif

#ifdef TEXTURED
vec3 textured_color(Plane plane, vec2 point) {
  vec2 q;
  mat2 change;
  Place place = place_at(plane, point);
  // Beyond the plane's horizon only the splat's mean can be meant.
  q = place.k > 0.0 ? place.uv : vec2(LARGEST_PIXEL);
  change = place_gradient(plane, place);
#ifdef STRADDLING
  if (straddling > 0.5) {
    vec3 in_space = straddling_place(point);
    q = in_space.xy;
    change = space_place_change(plane_center_gh.xyz, plane_depths.xyz, point, in_space.z);
  }
#endif
  return splat_texture_color(color_weight.rgb, texture_place, texture_along, texture_border, q, change);
}
#endif

void main() {
  vec2 point = picture_point();
  Plane plane = Plane(plane_center_gh.xy, plane_ab.xy, plane_ab.zw, plane_center_gh.zw, plane_depths.xy, plane_depths.z,
                      plane_depths.w, beside_radius.x, beside_radius.y);
#ifdef STRADDLING
  bool straddles = straddling > 0.5;
  vec2 weight_depth = straddles ? straddling_sample(point) : splat_sample(plane, point);
#else
  const bool straddles = false;
  vec2 weight_depth = splat_sample(plane, point);
#endif
  float weight = weight_depth.x * color_weight.w;
  if (!(weight > 0.0 && dot(on_footprint, on_footprint) <= 1.0 && weight_depth.y >= splats.options.y)) discard;
  float seen = texelFetch(seen_range, ivec2(gl_FragCoord.xy), 0).z;
  float depth = weight_depth.y + plane.beside;
  if (stored_depth(depth) > seen) discard;
#ifdef LAYER
  if (is_peeled(stored_depth(depth), ivec2(gl_FragCoord.xy) * VISIBILITY_SAMPLES + VISIBILITY_SAMPLES / 2)) discard;
#endif
#if VISIBILITY_SAMPLES > 1
  // Where the filter reaches past a silhouette, what is seen behind it is another surface, which keeps the sample: its
  // depth, moved back by up to 2 epsilon, is more than that and a radius behind this splat's.
  if (seen < 1.0 && !straddles && view_depth(seen) - depth > (1.0 + 4.0 * splats.options.x) * plane.radius) discard;
#endif
#ifdef TEXTURED
  vec3 color = textured_color(plane, point);
#else
  vec3 color = color_weight.rgb;
#endif
  add_to_sums(color, weight, weight_depth.y);
}
