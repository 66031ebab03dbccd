// References: Botsch et al. 2005, section 4 (normalise, then light once).
// Summary: a sample's sums as a lit surface; the includer has included a shading model.

#include "common/outputs.glsl"
#include "common/mean_surface.glsl"
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

// mean: where its coverage is above 0. look: which of the texel's hardware samples, 0 where it has one.
ShadedSample shaded_sample(MeanSurface mean, ivec2 texel, int look) {
  vec2 place = shading.window.xy + (vec2(texel) + 0.5) * shading.window.zw;
  vec3 position = vec3(shading.options.x > 0.5 ? place : place * mean.depth, -mean.depth);
  float size = length(mean.normal);
  vec3 normal = size > CANCELLED ? mean.normal / size : vec3(0.0, 0.0, 1.0);
#ifdef MATERIAL_TARGET
  vec3 material = mean.weight > 0.0 ? SUM_AT(material_sum, texel, look).xyz / mean.weight : vec3(0.0);
#ifdef POLYGONS
  material = mix(material, SUM_AT(polygon_material, texel, look).xyz / mean.sees, mean.polygon);
#endif
#else
  vec3 material = shading.material.xyz;
#endif
#ifdef SHADOWS
  shadow_turn = 0.125 + 0.25 * float((texel.x & 1) + 2 * (texel.y & 1));
  shadow_plane = vec3(0.0);
#ifdef POLYGONS
  if (mean.polygon > 0.5) shadow_plane = SUM_AT(polygon_plane, texel, look).xyz;
#endif
#endif
#ifdef OVERDRAW_TARGET
  overdraw = SUM_AT(overdraw_sum, texel, look).r;
#endif
#ifdef SUM_OF_WEIGHTS
  sum_of_weights = mean.weight / WEIGHT_SCALE;
#endif
#ifdef LIGHT_SET_TARGET
  light_set = texelFetch(light_set_sum, texel, 0);
  light_set /= max(dot(light_set, vec4(1.0)), 1e-30);
#ifdef POLYGONS
  int set = int(texelFetch(polygon_material, texel, 0).w);
  light_set = mix(light_set, vec4(equal(ivec4(0, 1, 2, 3), ivec4(set))), mean.polygon);
#endif
#endif
#ifdef SHADOW_SHARE
  light_arriving = light_unshadowed = vec3(0.0);
#endif
  vec3 radiance = shade(position, normal, mean.color, material);
  Outputs outputs = NO_OUTPUTS;
#ifdef METALS
  outputs.diffuse_color = mean.color * (1.0 - clamp(material.y, 0.0, 1.0));
#else
  outputs.diffuse_color = mean.color;
#endif
#ifdef EMISSION_TARGET
  vec4 e = SUM_AT(emission_sum, texel, look);
  // Its own weights: those of float16 sums are scaled.
  outputs.emission = e.w > 0.0 ? e.rgb / e.w : vec3(0.0);
#ifdef POLYGONS
  outputs.emission = mix(outputs.emission, SUM_AT(polygon_emission, texel, look).rgb / mean.sees, mean.polygon);
#endif
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
  float coverage = mean.coverage;
#ifdef EDGE_THRESHOLD
  if (mean.polygon == 0.0) coverage *= min(front_weight(mean.weight) / shading.edges.x, 1.0);
#endif
  return ShadedSample(radiance, normal, mean.depth, coverage, outputs);
}
