// References: Botsch et al. 2005, section 4 (one lighting pass a frame, whatever the overdraw).
// Summary: normalises the sums of every sample in the pixel, lights it and averages (a box filter); the depth is the
//          nearest sample's, the normal the mean of the samples'. Hooks: `count` weights by what is in front, `cut`
//          removes samples.

#include "shading_models/{shading}.glsl"
#include "hosts/shaded_sample.glsl"
#include "lib/background/{background}.glsl"
#include "hosts/pixel.glsl"

#parts
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES;
  vec4 color_total = vec4(0.0);
  vec4 normal_total = vec4(0.0);
  Outputs outputs_total = NO_OUTPUTS;
  float nearest = FARTHEST;
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) {
      ivec2 texel = first + ivec2(x, y);
      float through = 1.0;
      bool is_first = true;
      #hook count(texel, through, is_first)
      for (int tap = 0; tap < TAPS; tap++) {
        float coverage = 0.0;
        MeanSurface mean = mean_surface(texel, tap);
        bool is_cut = false;
        #hook cut(mean, texel, tap, is_cut)
        if (is_cut) continue;
        if (mean.coverage > 0.0) {
          Shaded here = shaded_surfaces(mean, texel, tap);
          coverage = here.coverage;
          color_total += vec4(here.color, 1.0) * (coverage * through);
          normal_total += vec4(is_first ? here.normal : vec3(0.0), through) * coverage;
          if (is_first) nearest = min(nearest, mean.depth * view.world_length);
          outputs_total = added(outputs_total, here.outputs, coverage * through);
        }
        if (coverage < 1.0) color_total += world_background(texel) * ((1.0 - coverage) * through);
      }
    }
  }
  float share = 1.0 / float(SAMPLES * SAMPLES * TAPS);
  write_pixel(color_total * share, normal_total * share, nearest, added(NO_OUTPUTS, outputs_total, share));
}
