// References: Botsch et al. 2005, sections 3 and 4 (accumulation, normalised by the sum of weights in a later pass).
// Summary: what a splat adds to a sample's sums. Where sums are float16 (HALF_SUMS), depths and their weights have a
//          float32 target of their own, and colours are scaled so that the scene's brightest is at most 1. In a layer of
//          what is transparent, too; colours then count by their opacity, whose sum stands beside theirs.

#include "common/weight_scale.glsl"

#ifdef HALF_SUMS
// Weaker weights count as this one, 64 of float16's smallest steps, so that no splat is lost that is alone. Where others
// are, it must stay far below their tails: at 9.8e-4 mip's silhouettes lost 27 dB.
const float LEAST_WEIGHT = 3.8147e-6;
#endif

#ifdef REST
const float MOST_OPAQUE = 0.999;

// Of all that is left behind transparent layers: lit colours, and logarithms of what the splats let through.
void add_to_sums(vec3 color, float weight, float depth) {
  rest_sum = vec4(color, 1.0) * (weight * opacity);
  rest_weight = vec2(-log(1.0 - min(opacity, MOST_OPAQUE)), 1.0) * weight;
}
#else
void add_to_sums(vec3 color, float weight, float depth) {
#ifdef HALF_SUMS
  weight = max(weight * WEIGHT_SCALE, LEAST_WEIGHT);
#endif
#ifdef LAYER
  float shown = weight * opacity;
#else
  float shown = weight;
#endif
  color_sum = vec4(color * splats.sides.w, 1.0) * shown;
#ifdef DEPTH_SUM
  normal_sum = vec4(normal, 0.0) * weight;
  depth_sum = vec2(depth, 1.0) * weight;
#else
  normal_sum = vec4(normal, depth) * weight;
#endif
#ifdef OVERDRAW_TARGET
  overdraw_sum = 1.0;
#endif
#ifdef LIGHT_SET_TARGET
  light_set_sum = splats.light_set * weight;
#endif
#ifdef MATERIAL_TARGET
  material_sum = vec4(material, 1.0) * weight;
#endif
#ifdef EMISSION_TARGET
  emission_sum = vec4(emission, 1.0) * weight;
#endif
}
#endif
