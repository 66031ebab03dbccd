// References: docs/evidence/numerics.md, Formats.
// Summary: sums of float16. Of weights up to 1 such a sum stops growing at 2048, of what they are multiplied by here at
//          32768, which float16 (up to 65504) holds; and the smallest it holds is then a 16th as small. Colours are scaled so
//          that the scene's brightest is at most 1.

const float WEIGHT_SCALE = 16.0;
// A mean normal shorter than this is what rounding left of normals that cancel; the surface then faces the viewer.
const float CANCELLED = 4e-3;
// Weaker weights count as this one, 64 of float16's smallest steps, so that no splat is lost that is alone. Where others
// are, it must stay far below their tails: at 9.8e-4 mip's silhouettes lost 27 dB.
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
