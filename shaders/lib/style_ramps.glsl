// References: shading_models/ramp.glsl.
// Summary: what a surface sends out whose styles have ramps. Hooks: `brighten` adds diffuse light.

#include "lib/style_mix.glsl"
#include "hosts/world_light.glsl"

// plain: what it sends out without a ramp. light: diffuse.
vec3 by_style(int number, vec3 plain, vec3 base, vec3 light) {
  vec4 weights = texelFetch(style_table, ivec2(1, number), 0);
  if (weights.w == 0.0) return plain;
  int last = textureSize(style_table, 0).x - FIRST_OF_RAMP - 1;
  float at = clamp(dot(light, weights.rgb), 0.0, 1.0) * float(last);
  int low = min(int(at), last - 1);
  vec3 below = texelFetch(style_table, ivec2(FIRST_OF_RAMP + low, number), 0).rgb;
  return base * mix(below, texelFetch(style_table, ivec2(FIRST_OF_RAMP + low + 1, number), 0).rgb, at - float(low));
}

#parts
vec3 restyled(vec3 moments, vec3 plain, vec3 base, vec3 position, vec3 normal) {
  StyleMix styles = style_mix(moments);
  vec3 light = world_irradiance(normal);
  #hook brighten(light, position, normal)
  return mix(by_style(styles.first, plain, base, light), by_style(styles.second, plain, base, light), styles.share);
}

#part lights
#include "lib/diffuse_lights.glsl"

void lights_brighten(inout vec3 light, vec3 position, vec3 normal) {
  light += diffuse_light(position, normal);
}
