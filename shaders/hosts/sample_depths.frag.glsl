// References: none needed.
// Summary: the depth of each sample, 0 if it is empty, in a single channel because it is read often.

#include "hosts/mean_surface.glsl"

#parts
void main() {
  MeanSurface mean = mean_surface(ivec2(gl_FragCoord.xy), 0);
  sample_depths = mean.coverage > 0.0 ? mean.depth : 0.0;
}
