// References: Botsch et al. 2005, section 4 (one shading pass a frame, whatever the overdraw).
// Summary: normalises the sums of every sample in the pixel, lights it and averages (a box filter); the depth is
//          the nearest sample's, the normal the mean of the samples'.

#include "shading/{shading}.glsl"
#include "common/shaded_sample.glsl"
#include "common/world.glsl"

const float EMPTY_DEPTH = 1e10;
const float FARTHEST = 3.4e38;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES;
  vec4 color_total = vec4(0.0);
  vec4 normal_total = vec4(0.0);
  float nearest = FARTHEST;
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) {
      ivec2 texel = first + ivec2(x, y);
      if (texelFetch(color_sum, texel, 0).w > 0.0) {
        ShadedSample here = shaded_sample(texel);
        color_total += vec4(here.color, 1.0);
        normal_total += vec4(here.normal, 1.0);
        nearest = min(nearest, here.depth * shading.material.w);
      }
      else {
        color_total += world_background(texel);
      }
    }
  }
  float share = 1.0 / float(SAMPLES * SAMPLES);
  combined = color_total * share;
  depth = nearest < FARTHEST ? nearest : EMPTY_DEPTH;
#ifdef NORMAL_OUTPUT
  normal_coverage = vec4(mat3(shading.view_to_world) * normal_total.xyz, normal_total.w) * share;
#endif
}
