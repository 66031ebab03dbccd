// References: features/polygons.glsl.
// Summary: where the hardware compares depths of splats and polygons apart from one another.

float splat_weight(MeanSurface mean) {
  return front_weight(mean.weight);
}

bool is_elsewhere(float behind) {
  return abs(behind) > frame.contact;
}
