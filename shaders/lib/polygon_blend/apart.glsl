// References: Guennebaud et al. 2006, section 5.1 (shaded colours are blended).
// Summary: attributes are blended, and those of the splats and of the polygon are kept too (lib/polygon_light/apart.glsl).

MeanSurface splats_alone;
MeanSurface polygon_alone;

void keep_splats(MeanSurface mean) {
  splats_alone = mean;
}

void blend_with_polygon(inout MeanSurface mean, vec3 color, vec4 normal) {
  polygon_alone = mean;
  polygon_alone.color = color;
  polygon_alone.normal = normal.xyz;
  polygon_alone.depth = normal.w;
  polygon_alone.polygon = 1.0;
  splats_alone.sees = mean.sees;
  mean.color = mix(mean.color, color, mean.polygon);
  mean.normal = mix(mean.normal, normal.xyz, mean.polygon);
}
