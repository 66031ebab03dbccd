// References: Botsch et al. 2005, section 4.
// Summary: shades every sample and keeps it, for methods whose silhouettes `resolve.frag.glsl` filters afterwards, and
//          for what is transparent, premultiplied.

#include "shading/{shading}.glsl"
#include "common/shaded_sample.glsl"
#if defined(HOLDOUT) && !defined(LAYER)
#include "common/holdout.glsl"
#endif

// Sums of weights below this are of backs, and of the ends of filters. Their depth is kept with a sign.
const float FAINT = 0.004;

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
#ifndef LAYER
    if (mean.polygon == 0.0 && mean.weight < FAINT * WEIGHT_SCALE) surface.w = -here.depth;
#endif
    outputs = added(NO_OUTPUTS, here.outputs, here.coverage);
  }
  write_outputs(outputs);
}
