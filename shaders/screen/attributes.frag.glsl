// References: as attributes.vert.glsl; adj(M) for straddling splats: Guennebaud et al. 2006, equation 5.
// Summary: asks the method for weight and depth, and adds what is not hidden at the sample's centre. Depth is compared
//          here with the visibility pass's, since a triangle in the picture has none.

#ifndef RIMS
#include "common/sums.glsl"
#endif
#include "screen/place.glsl"
#include "methods/{method}.glsl"
#ifdef TEXTURED
#include "common/splat_texture.glsl"
#endif

#ifdef LAYER
#define PROJECTION splats.projection
#define PARALLEL (splats.options.z > 0.5)
#define DEPTH_UNIT splats.options.w
#include "common/stored_depth.glsl"
#include "common/layer_ties.glsl"

// As common/peeled.glsl has it; what is in a layer was compared as depth along the view, and is so here.
bool is_in_nearer_layer(float depth) {
  float until = texelFetch(peeled, ivec2(gl_FragCoord.xy), 0).x;
  return until > 0.0 && (until == 1.0 || depth <= view_depth(until));
}
#endif

// The ellipse that was asked for; or of the triangle around it, all of which is drawn in any case, what lies within that
// many times the ellipse: its corners, where weights are as small as nothing, stay out.
#ifndef FOOTPRINT_END
#define FOOTPRINT_END 1.0
#endif

bool is_on_footprint() {
  vec2 d = gl_FragCoord.xy - plane_center_gh.xy - footprint_middle;
  vec2 at = d.x * footprint_map.xy + d.y * footprint_map.yz;
  return at.x >= -1.0 && at.x + 1.7320508 * abs(at.y) <= 2.0 && dot(at, at) <= FOOTPRINT_END * FOOTPRINT_END;
}

#ifdef STRADDLING
vec2 picture_point() {
  return splats.window.xy + gl_FragCoord.xy * splats.window.zw;
}

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

vec2 straddling_sample() {
  vec3 place = straddling_place(picture_point());
  float rho2 = dot(place.xy, place.xy);
  return vec2(rho2 <= 1.0 && place.z >= splats.options.y ? exp(-2.0 * rho2) : 0.0, place.z);
}
#endif

#ifdef TEXTURED
vec3 textured_color(Plane plane) {
  Place place = place_at(plane, gl_FragCoord.xy);
  // Beyond the plane's horizon only the splat's mean can be meant.
  vec2 q = place.k > 0.0 ? place.uv : vec2(LARGEST_PIXEL);
  mat2 change = place.scale * place_turn(plane, place);
#ifdef STRADDLING
  if (straddling > 0.5) {
    vec2 point = picture_point();
    vec3 in_space = straddling_place(point);
    q = in_space.xy;
    change = space_place_change(plane_center_gh.xyz, plane_depths.xyz, point, in_space.z);
  }
#endif
  return splat_texture_color(color_weight.rgb, texture_place, texture_along, texture_border, q, change);
}
#endif

void main() {
  Plane plane = Plane(plane_center_gh.xy, plane_ab.xy, plane_ab.zw, plane_center_gh.zw, plane_depths.xy, plane_depths.z,
                      plane_depths.w, plane_det_radius.w, plane_det_radius.xyz);
#ifdef STRADDLING
  bool straddles = straddling > 0.5;
  vec2 weight_depth = straddles ? straddling_sample() : splat_sample(plane, gl_FragCoord.xy);
#else
  const bool straddles = false;
  vec2 weight_depth = splat_sample(plane, gl_FragCoord.xy);
#endif
  float weight = weight_depth.x * color_weight.w;
  if (!(weight > 0.0 && is_on_footprint() && weight_depth.y >= splats.options.y)) discard;
#ifdef RIMS
  // Only whose the splat is, where nothing is visible.
  if (texelFetch(visibility_depth, ivec2(gl_FragCoord.xy), 0).r < 1.0) discard;
  identity = vec2(number, weight_depth.y);
#else
#ifdef REST
  vec4 seen = vec4(texelFetch(visibility_depth, ivec2(gl_FragCoord.xy), 0).r);
  seen.z = seen.x < 1.0 ? view_depth(seen.x) : 3e38;
#else
  vec4 seen = texelFetch(seen_range, ivec2(gl_FragCoord.xy), 0);
#endif
  float depth = weight_depth.y;
#ifdef LAYER
  // Where a filter reaches over its rim, a splat is in the layers that the rim itself is in.
  if (!straddles) depth = clamp(depth, plane.depth - length(plane.slope), plane.depth + length(plane.slope));
#endif
#ifdef LAYER
  if (tied(depth, -0.5) > seen.z) discard;
#else
  if (depth > seen.z) discard;
#endif
#ifdef LAYER
  if (is_in_nearer_layer(tied(depth, 0.5))) discard;
#endif
#if defined(HOLDOUT) && !defined(LAYER)
  // Before a hole is what lies before it itself; where a filter reaches over a rim, a plane seen flat runs far ahead.
  if (seen.w > 1e38) {
    if (!straddles && plane.depth - length(plane.slope) > seen.z) discard;
    seen.w = seen.z;
  }
#endif
#if defined(FILTERS_SILHOUETTES) && !defined(REST)
  // Where the filter reaches past a silhouette, what is seen behind it is another surface, which keeps the sample: its
  // depth, moved back by up to 2 epsilon, is more than that and a radius behind this splat's. Nor is a splat of the
  // surface that is seen if it lies that far behind it, though its plane, seen flat, runs before it beyond the rim.
  float apart = (1.0 + 4.0 * splats.options.x) * plane.radius;
  if (!straddles && (seen.w - depth > apart || plane.depth - length(plane.slope) - apart > seen.z)) discard;
#endif
#ifdef TEXTURED
  vec3 color = textured_color(plane);
#else
  vec3 color = color_weight.rgb;
#endif
  add_to_sums(color, weight, weight_depth.y);
#endif
}
