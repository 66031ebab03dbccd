// References: none needed.
// Summary: the sum of weights that a sample was divided by: 1/16 and less blue, 1/4 cyan, 1 green, 4 yellow, 16 and
//          more red.

#include "lib/heat.glsl"

float sum_of_weights;  // of the sample being shaded

vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  return heat(log2(sum_of_weights) / 8.0 + 0.5);
}
