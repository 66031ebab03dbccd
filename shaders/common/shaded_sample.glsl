// References: Botsch et al. 2005, section 4 (normalise, then light once).
// Summary: a sample's sums as a lit surface; the includer has included a shading model.

#include "common/outputs.glsl"
#include "common/sum_at.glsl"
#include "common/weight_scale.glsl"
#ifdef OVERDRAW_TARGET
#include "common/overdraw.glsl"
#endif

struct ShadedSample {
  vec3 color;
  vec3 normal;
  float depth;
  float coverage;  // below 1 only where an edge threshold is planned, or what is transparent
  Outputs outputs;
};

// A mean normal shorter than this is what rounding left of normals that cancel; the surface then faces the viewer.
#ifdef HALF_SUMS
const float CANCELLED = 4e-3;
#else
const float CANCELLED = 1e-6;
#endif

#ifdef EDGE_THRESHOLD
#include "common/sides.glsl"
// Weights of backs sum to less; the rim of a front weighs 0.135, or a quarter of it in the mean of four samples.
const float LEAST_FRONT = 0.02;
#endif

// Only where the sum of weights is above 0. look: which of the texel's hardware samples, 0 where it has one.
ShadedSample shaded_sample(ivec2 texel, int look) {
  vec4 c = SUM_AT(color_sum, texel, look);
#ifdef DEPTH_SUM
  vec2 depths = SUM_AT(depth_sum, texel, look).xy;
#endif
#ifdef LAYER
  float weights = depths.y;
#else
  float weights = c.w;
#endif
  vec4 n = SUM_AT(normal_sum, texel, look) / weights;
#ifdef DEPTH_SUM
  n.w = depths.x / depths.y;
#endif
#ifdef HALF_SUMS
  c.rgb *= shading.options.w;
#endif
  vec2 place = shading.window.xy + (vec2(texel) + 0.5) * shading.window.zw;
  vec3 position = vec3(shading.options.x > 0.5 ? place : place * n.w, -n.w);
  float size = length(n.xyz);
  vec3 normal = size > CANCELLED ? n.xyz / size : vec3(0.0, 0.0, 1.0);
#ifdef MATERIAL_TARGET
  vec3 material = SUM_AT(material_sum, texel, look).xyz / weights;
#else
  vec3 material = shading.material.xyz;
#endif
#ifdef SHADOWS
  shadow_turn = 0.125 + 0.25 * float((texel.x & 1) + 2 * (texel.y & 1));
#endif
#ifdef OVERDRAW_TARGET
  overdraw = SUM_AT(overdraw_sum, texel, look).r;
#endif
#ifdef SUM_OF_WEIGHTS
  sum_of_weights = weights / WEIGHT_SCALE;
#endif
#ifdef LIGHT_SET_TARGET
  light_set = texelFetch(light_set_sum, texel, 0);
  light_set /= dot(light_set, vec4(1.0));
#endif
#ifdef SHADOW_SHARE
  light_arriving = light_unshadowed = vec3(0.0);
#endif
  vec3 radiance = shade(position, normal, c.rgb / c.w, material);
  Outputs outputs = NO_OUTPUTS;
#ifdef METALS
  outputs.diffuse_color = c.rgb / c.w * (1.0 - clamp(material.y, 0.0, 1.0));
#else
  outputs.diffuse_color = c.rgb / c.w;
#endif
#ifdef EMISSION_TARGET
  vec4 e = SUM_AT(emission_sum, texel, look);
  outputs.emission = e.rgb / e.w;  // its own weights: those of float16 sums are scaled
#endif
#ifdef EMISSION
  outputs.emission = shading.emission.rgb;
#endif
  radiance += outputs.emission;
#ifdef SHADOW_SHARE
  outputs.shadow_overdraw.rgb = shadow_share();
#endif
#ifdef OVERDRAW_TARGET
  outputs.shadow_overdraw.a = overdraw;
#endif
#ifdef LINES
  radiance = mix(radiance, shading.line_color.rgb, texelFetch(lines, texel, 0).r);
#endif
#ifdef LAYER
  float coverage = min(c.w / weights, 1.0);
#else
  float coverage = 1.0;
#endif
#ifdef EDGE_THRESHOLD
  float weight = weights / WEIGHT_SCALE;
  if (weight < LEAST_FRONT) weight /= BACK_WEIGHT;
  coverage *= min(weight / shading.edges.x, 1.0);
#endif
  return ShadedSample(radiance, normal, n.w, coverage, outputs);
}
