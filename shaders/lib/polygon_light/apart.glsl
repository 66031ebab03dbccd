// References: Guennebaud et al. 2006, section 5.1 (the shaded colours are blended).
// Summary: the splats' mean and the polygon are lit apart, each where it is, and their colours are blended.

// Other samples may be looked up while one is lit, so what is apart is copied first.
Shaded shaded_surfaces(MeanSurface mean, ivec2 texel, int tap) {
  if (!(mean.polygon > 0.0 && mean.polygon < 1.0)) return shaded_sample(mean, texel, tap);
  MeanSurface of_splats = splats_alone, of_polygon = polygon_alone;
  Shaded splats = shaded_sample(of_splats, texel, tap), both = shaded_sample(of_polygon, texel, tap);
  both.mean = mean;
  both.color = mix(splats.color, both.color, mean.polygon);
  both.outputs = added(added(NO_OUTPUTS, splats.outputs, 1.0 - mean.polygon), both.outputs, mean.polygon);
  float size = length(mean.normal);
  if (size > CANCELLED) both.normal = mean.normal / size;
  return both;
}
