// References: none needed.
// Summary: the share of the world's light that reaches each sample, and its depth, 0 if it is empty. Hooks: `occlude`.

#include "hosts/mean_surface.glsl"
#include "lib/eye_position.glsl"

#parts
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  MeanSurface mean = mean_surface(texel, 0);
  occlusion = vec2(1.0, 0.0);
  if (mean.coverage > 0.0) {
    #hook occlude(occlusion, mean, texel)
  }
}
