// References: features/polygons.glsl.
// Summary: for passes in which the hardware compares depths of splats and polygons separately.

float splat_weight(MeanSurface mean) {
  return front_weight(mean.weight);
}

bool is_elsewhere(float behind) {
  return abs(behind) > frame.contact;
}
