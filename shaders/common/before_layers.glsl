// References: Guennebaud, Barthe, Paulin 2006, section 6.
// Summary: puts what transparent layers add up to in the pixel before the opaque picture, of which they let through the
//          part that is given: premultiplied colour, normal and coverage, nearest depth, and what else is handed on.

#include "common/outputs.glsl"

void put_layers_before(inout vec4 color, inout vec4 normal, inout float nearest, inout Outputs outputs) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 before = texelFetch(layers, pixel, 0);
  float depth_before = texelFetch(layers_depth, pixel, 0).r;
  color += before;
  normal.w += before.w;
#ifdef NORMAL_COVERAGE_OUTPUT
  normal.xyz += texelFetch(layers_normal, pixel, 0).xyz;
#endif
#ifdef DIFFUSE_COLOR_LAYERS
  outputs.diffuse_color += texelFetch(layers_diffuse_color, pixel, 0).rgb;
#endif
#ifdef EMISSION_LAYERS
  outputs.emission += texelFetch(layers_emission, pixel, 0).rgb;
#endif
#ifdef SHADOW_OVERDRAW_LAYERS
  outputs.shadow_overdraw += texelFetch(layers_shadow_overdraw, pixel, 0);
#endif
  if (depth_before > 0.0) nearest = min(nearest, depth_before);
}
