// References: Botsch et al. 2005, section 4.
// Summary: shades every sample and keeps it, for methods whose silhouettes `resolve.frag.glsl` filters afterwards.

#include "shading/{shading}.glsl"

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 c = texelFetch(color_sum, texel, 0);
  shaded = vec4(0.0);
  surface = vec4(0.0);
  if (c.w > 0.0) {
    vec4 n = texelFetch(normal_sum, texel, 0) / c.w;
    vec2 place = shading.window.xy + gl_FragCoord.xy * shading.window.zw;
    vec3 position = vec3(shading.options.x > 0.5 ? place : place * n.w, -n.w);
    float size = length(n.xyz);
    vec3 normal = size > 1e-6 ? n.xyz / size : vec3(0.0, 0.0, 1.0);
#ifdef MATERIAL_TARGET
    vec3 material = texelFetch(material_sum, texel, 0).xyz / c.w;
#else
    vec3 material = shading.material.xyz;
#endif
    shaded = vec4(shade(position, normal, c.rgb / c.w, material), 1.0);
    surface = vec4(normal, n.w);
  }
}
