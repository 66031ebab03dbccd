// References: Guennebaud et al. 2006, section 5.1 (attributes are blended before shading).
// Summary: splats and polygon of a sample are one surface.

Shaded shaded_surfaces(MeanSurface mean, ivec2 texel, int tap) {
  return shaded_sample(mean, texel, tap);
}
