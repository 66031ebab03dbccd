// References: docs/evidence/numerics.md, Formats.
// Summary: sums in float16. A sum of weights up to 1 would stop growing at 2048; with the factor used here it stops at
//          32768, within float16's range of 65504, and small weights are 16 times as precise. Colours are scaled so
//          that the scene's brightest is at most 1.

const float WEIGHT_SCALE = 16.0;
// A mean normal shorter than this is rounding error of normals that cancel; the surface then faces the viewer.
const float CANCELLED = 4e-3;
// Smaller weights are raised to this value, 64 of float16's smallest steps, so that no isolated splat is lost. It must
// stay far below the tails of other splats: at 9.8e-4, silhouettes of the Mip Filter lost 27 dB.
const float LEAST_WEIGHT = 3.8147e-6;

float stored_weight(float weight) {
  return max(weight * WEIGHT_SCALE, LEAST_WEIGHT);
}

vec3 stored_color(vec3 color) {
  return color * frame.color_scale;
}

vec3 summed_color(vec3 stored) {
  return stored * frame.color_unit;
}
