// References: Botsch et al. 2005, sections 3 and 4 (accumulation, normalised by the sum of weights in the next pass).
// Summary: adds weighted colour, normal, depth and material to their sums; the depth test keeps what is visible.

#include "common/depth.glsl"
#ifdef LAYER
#include "common/layer_sample.glsl"
#endif
#include "common/sums.glsl"
#include "methods/{method}.glsl"
#ifdef TEXTURED
#include "common/splat_texture.glsl"
#endif

void main() {
  float weight = kernel_weight(place_depth.xy) * color_weight.w;
  if (!(weight > 0.0)) discard;
#ifdef LAYER
  if (!is_in_layer(place_depth.z, 0.5, ivec2(gl_FragCoord.xy))) discard;
#endif
  write_depth(place_depth.z);
#ifdef TEXTURED
  vec2 point = splats.window.xy + gl_FragCoord.xy * splats.window.zw;
  mat2 change = space_place_change(texture_axis_u, texture_axis_v, point, place_depth.z);
  vec3 color = splat_texture_color(color_weight.rgb, texture_place, texture_along, texture_border, place_depth.xy, change);
#else
  vec3 color = color_weight.rgb;
#endif
  add_to_sums(color, weight, place_depth.z);
}
