// References: Botsch et al. 2005, section 6 (the result of diffuse lighting is modified by a 1D transfer function); Gooch et
//             al. 1998 (what it is used for).
// Summary: a ramp's colour at the luminance of all diffuse light, 0 to 1, times the surface's own. In full light a white
//          surface sends out 1.

#include "hosts/world_light.glsl"

vec3 ramp_at(float luminance) {
  int last = textureSize(color_ramp, 0).x - 1;
  float at = clamp(luminance, 0.0, 1.0) * float(last);
  int low = min(int(at), last - 1);
  return mix(texelFetch(color_ramp, ivec2(low, 0), 0).rgb, texelFetch(color_ramp, ivec2(low + 1, 0), 0).rgb, at - float(low));
}

#parts
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  vec3 light = world_irradiance(normal);
  #hook lit(light, position, normal)
  return base * ramp_at(dot(light, frame.ramp_luminance.rgb));
}

#part lights
#include "lib/diffuse_lights.glsl"

void lights_lit(inout vec3 sum, vec3 position, vec3 normal) {
  sum += diffuse_light(position, normal);
}
