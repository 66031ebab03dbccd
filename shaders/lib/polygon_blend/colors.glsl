// References: Guennebaud et al. 2006, section 5.1 (shaded colours are blended).
// Summary: splats are lit already: their colour is kept apart until the polygon is lit too.

vec3 splats_color;    // of the sample being shaded
float splats_share;
vec3 blended_normal;  // not normalised

void keep_splats(MeanSurface mean) {
  splats_color = mean.color;
  splats_share = 1.0;
  blended_normal = mean.normal;
}

// Leaves the polygon alone, if it shows at all.
void blend_with_polygon(inout MeanSurface mean, vec3 color, vec4 normal) {
  if (!(mean.polygon > 0.0)) return;
  splats_share = 1.0 - mean.polygon;
  blended_normal = mix(mean.normal, normal.xyz, mean.polygon);
  mean.color = color;
  mean.normal = normal.xyz;
  mean.polygon = 1.0;
}
