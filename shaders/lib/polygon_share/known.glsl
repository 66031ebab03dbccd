// References: features/polygons.glsl.
// Summary: where polygons that splats hide are not there. What is filtered has tails that weigh no more than backs.

float splat_weight(MeanSurface mean) {
  return mean.weight / WEIGHT_SCALE;
}

bool is_elsewhere(float behind) {
  return false;
}
