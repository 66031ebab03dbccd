// References: Botsch et al. 2005, section 4.
// Summary: shades every sample and keeps it, for methods whose silhouettes `resolve.frag.glsl` filters afterwards, and
//          for what is transparent, premultiplied.

#include "shading/{shading}.glsl"
#include "common/shaded_sample.glsl"
#if defined(HOLDOUT) && !defined(LAYER)
#include "common/holdout.glsl"
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  shaded = vec4(0.0);
  surface = vec4(0.0);
  Outputs outputs = NO_OUTPUTS;
  MeanSurface mean = mean_surface(texel, 0);
#if defined(HOLDOUT) && !defined(LAYER)
  if (is_hole(texel, 0, mean)) mean.coverage = 0.0;
#endif
  if (mean.coverage > 0.0) {
    ShadedSample here = shaded_sample(mean, texel, 0);
    shaded = vec4(here.color, 1.0) * here.coverage;
    surface = vec4(here.normal, here.depth);
    outputs = added(NO_OUTPUTS, here.outputs, here.coverage);
  }
  write_outputs(outputs);
}
