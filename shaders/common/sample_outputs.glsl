// References: none needed.
// Summary: what a shaded sample was to hand on, of what is asked for; 0 where nothing was shaded.

#include "common/outputs.glsl"

Outputs sample_outputs(ivec2 texel) {
  Outputs values = NO_OUTPUTS;
#ifdef DIFFUSE_COLOR_SAMPLES
  values.diffuse_color = texelFetch(sample_diffuse_color, texel, 0).rgb;
#endif
#ifdef EMISSION_SAMPLES
  values.emission = texelFetch(sample_emission, texel, 0).rgb;
#endif
#ifdef SHADOW_OVERDRAW_SAMPLES
  values.shadow_overdraw = texelFetch(sample_shadow_overdraw, texel, 0);
#endif
  return values;
}
