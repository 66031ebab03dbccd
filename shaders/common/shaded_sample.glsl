// References: Botsch et al. 2005, section 4 (normalise, then light once).
// Summary: a sample's sums as a lit surface; the includer has included a shading model.

struct ShadedSample {
  vec3 color;
  vec3 normal;
  float depth;
};

// A mean normal shorter than this is what rounding left of normals that cancel; the surface then faces the viewer.
#ifdef HALF_SUMS
const float CANCELLED = 4e-3;
#else
const float CANCELLED = 1e-6;
#endif

// Only where the sum of weights is above 0.
ShadedSample shaded_sample(ivec2 texel) {
  vec4 c = texelFetch(color_sum, texel, 0);
  vec4 n = texelFetch(normal_sum, texel, 0) / c.w;
#ifdef HALF_SUMS
  vec2 depths = texelFetch(depth_sum, texel, 0).xy;
  n.w = depths.x / depths.y;
  c.rgb *= shading.options.w;
#endif
  vec2 place = shading.window.xy + (vec2(texel) + 0.5) * shading.window.zw;
  vec3 position = vec3(shading.options.x > 0.5 ? place : place * n.w, -n.w);
  float size = length(n.xyz);
  vec3 normal = size > CANCELLED ? n.xyz / size : vec3(0.0, 0.0, 1.0);
#ifdef MATERIAL_TARGET
  vec3 material = texelFetch(material_sum, texel, 0).xyz / c.w;
#else
  vec3 material = shading.material.xyz;
#endif
  vec3 radiance = shade(position, normal, c.rgb / c.w, material);
#ifdef EMISSION_TARGET
  vec4 e = texelFetch(emission_sum, texel, 0);
  radiance += e.rgb / e.w;  // its own weights: those of float16 sums are scaled
#endif
#ifdef EMISSION
  radiance += shading.emission.rgb;
#endif
  return ShadedSample(radiance, normal, n.w);
}
