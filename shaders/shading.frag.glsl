// References: Botsch et al. 2005, section 4 (one shading pass a frame, whatever the overdraw).
// Summary: normalises the sums of every sample in the pixel, lights it and averages (a box filter); the depth is
//          the nearest sample's, the normal the mean of the samples'. What transparent layers let through of it is added
//          to them.

#include "shading/{shading}.glsl"
#include "common/shaded_sample.glsl"
#if defined(HOLDOUT) && !defined(LAYER)
#include "common/holdout.glsl"
#endif
#include "common/world.glsl"
#ifdef LAYERS
#include "common/before_layers.glsl"
#include "common/peeled.glsl"
#endif
#include "common/pixel.glsl"

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES;
  vec4 color_total = vec4(0.0);
  vec4 normal_total = vec4(0.0);
  Outputs outputs_total = NO_OUTPUTS;
  float nearest = FARTHEST;
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) {
      ivec2 texel = first + ivec2(x, y);
#ifdef LAYERS
      float through = let_through(texel);
      bool is_first = is_first_surface(texel);
#else
      const float through = 1.0;
      const bool is_first = true;
#endif
      for (int look = 0; look < LOOKS; look++) {
        float coverage = 0.0;
        MeanSurface mean = mean_surface(texel, look);
#ifdef HOLDOUT
        if (is_hole(texel, look, mean)) continue;
#endif
        if (mean.coverage > 0.0) {
          ShadedSample here = shaded_sample(mean, texel, look);
          coverage = here.coverage;
          color_total += vec4(here.color, 1.0) * (coverage * through);
          normal_total += vec4(is_first ? here.normal : vec3(0.0), through) * coverage;
          if (is_first) nearest = min(nearest, here.depth * shading.material.w);
          outputs_total = added(outputs_total, here.outputs, coverage * through);
        }
        if (coverage < 1.0) color_total += world_background(texel) * ((1.0 - coverage) * through);
      }
    }
  }
  float share = 1.0 / float(SAMPLES * SAMPLES * LOOKS);
  write_pixel(color_total * share, normal_total * share, nearest, added(NO_OUTPUTS, outputs_total, share));
}
