// References: lib/sides.glsl.
// Summary: weight of splats relative to fronts: backs alone weigh less.

#include "lib/sides.glsl"

// Weights of backs sum to less; the rim of a front weighs 0.135, or a quarter of it in the mean of four samples.
const float LEAST_FRONT = 0.02;

float front_weight(float sum) {
  float weight = sum / WEIGHT_SCALE;
  return weight < LEAST_FRONT ? weight / BACK_WEIGHT : weight;
}
