// References: Botsch et al. 2005, section 4.
// Summary: shades every sample and stores it premultiplied, for transparent layers and for methods whose silhouettes
//          `resolve.frag.glsl` filters later. Hooks: `cut` removes samples, `sign` sets the sign of the depth.

#include "shading_models/{shading}.glsl"
#include "hosts/shaded_sample.glsl"

#parts
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  shaded = vec4(0.0);
  surface = vec4(0.0);
  Outputs outputs = NO_OUTPUTS;
  MeanSurface mean = mean_surface(texel, 0);
  #hook cut(mean, texel)
  if (mean.coverage > 0.0) {
    Shaded here = shaded_surfaces(mean, texel, 0);
    shaded = vec4(here.color, 1.0) * here.coverage;
    surface = vec4(here.normal, mean.depth);
    #hook sign(mean)
    outputs = added(NO_OUTPUTS, here.outputs, here.coverage);
  }
  write_outputs(outputs);
}
