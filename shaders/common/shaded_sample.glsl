// References: Botsch et al. 2005, section 4 (normalise, then light once).
// Summary: a sample's sums as a lit surface; the includer has included a shading model.

struct ShadedSample {
  vec3 color;
  vec3 normal;
  float depth;
};

// Only where the sum of weights is above 0.
ShadedSample shaded_sample(ivec2 texel) {
  vec4 c = texelFetch(color_sum, texel, 0);
  vec4 n = texelFetch(normal_sum, texel, 0) / c.w;
  vec2 place = shading.window.xy + (vec2(texel) + 0.5) * shading.window.zw;
  vec3 position = vec3(shading.options.x > 0.5 ? place : place * n.w, -n.w);
  float size = length(n.xyz);
  vec3 normal = size > 1e-6 ? n.xyz / size : vec3(0.0, 0.0, 1.0);
#ifdef MATERIAL_TARGET
  vec3 material = texelFetch(material_sum, texel, 0).xyz / c.w;
#else
  vec3 material = shading.material.xyz;
#endif
  return ShadedSample(shade(position, normal, c.rgb / c.w, material), normal, n.w);
}
