// References: features/polygons.glsl.
// Summary: for passes in which polygons hidden by splats are absent. Tails of a filter weigh no more than backs.

float splat_weight(MeanSurface mean) {
  return mean.weight / WEIGHT_SCALE;
}

bool is_elsewhere(float behind) {
  return false;
}
