// References: as attributes.vert.glsl; adj(M) for straddling splats: Guennebaud et al. 2006, equation 5.
// Summary: asks the method for weight and depth, and adds what is not hidden at the sample's centre. Depth is compared
//          here with the visibility pass's, since a rectangle in the picture has none.

#define PROJECTION splats.projection
#define PARALLEL (splats.options.z > 0.5)
#define DEPTH_UNIT splats.options.w
#include "common/stored_depth.glsl"
#include "common/sums.glsl"
#include "screen/place.glsl"
#include "methods/{method}.glsl"
#ifdef TEXTURED
#include "common/splat_texture.glsl"
#endif

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

#ifdef TEXTURED
vec3 textured_color(Plane plane, vec2 point) {
  vec2 q;
  mat2 change;
  if (straddling > 0.5) {
    vec3 place = straddling_place(point);
    q = place.xy;
    change = space_place_change(plane_center_gh.xyz, plane_depths.xyz, point, place.z);
  }
  else {
    Place place = place_at(plane, point);
    // Beyond the plane's horizon only the splat's mean can be meant.
    q = place.k > 0.0 ? place.uv : vec2(LARGEST_PIXEL);
    change = place_gradient(plane, place);
  }
  return splat_texture_color(color_weight.rgb, texture_place, texture_along, q, change);
}
#endif

void main() {
  vec2 point = picture_point();
  Plane plane = Plane(plane_center_gh.xy, plane_ab.xy, plane_ab.zw, plane_center_gh.zw, plane_depths.xy, plane_depths.z,
                      plane_gradient, plane_depths.w);
  vec2 weight_depth = straddling > 0.5 ? straddling_sample(point) : splat_sample(plane, point);
  float weight = weight_depth.x * color_weight.w;
  if (!(weight > 0.0 && weight_depth.y >= splats.options.y)) discard;
  ivec2 nearest = ivec2(gl_FragCoord.xy) * VISIBILITY_SAMPLES + VISIBILITY_SAMPLES / 2;
  float seen = texelFetch(visibility_depth, nearest, 0).r;
#if VISIBILITY_SAMPLES > 1
  // That sample lies beside the centre, and so does the splat's depth to compare; no farther than its ellipse reaches.
  vec2 beside = 0.5 * float(1 - VISIBILITY_SAMPLES % 2) / float(VISIBILITY_SAMPLES) * splats.window.zw;
  float reach = length(plane.slope);
  float depth = weight_depth.y + (straddling > 0.5 ? 0.0 : clamp(dot(plane.gradient, beside), -reach, reach));
#else
  float depth = weight_depth.y;
#endif
  if (stored_depth(depth) > seen) discard;
#if VISIBILITY_SAMPLES > 1
  // Where the filter reaches past a silhouette, what is seen behind it is another surface, which keeps the sample: its
  // depth, moved back by up to 2 epsilon, is more than that and a radius behind this splat's.
  if (seen < 1.0 && straddling < 0.5 && view_depth(seen) - depth > (1.0 + 4.0 * splats.options.x) * plane.radius) discard;
#endif
#ifdef TEXTURED
  vec3 color = textured_color(plane, point);
#else
  vec3 color = color_weight.rgb;
#endif
  add_to_sums(color, weight, weight_depth.y);
}
